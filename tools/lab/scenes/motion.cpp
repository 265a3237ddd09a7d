// Sets still boxes moving, within the bounds that they had at rest.
#include "lab/scenes/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "broadside/error.hpp"

#include "lab/scenes/random.hpp"

namespace broadside::lab {

/// A box's displacement on one axis since the first frame, and its limits.
struct AxisMotion {
  double offset = 0;
  double speed = 0;  // per frame
  double min;        // <= 0
  double max;        // >= 0

  void advance() {
    if (min == max) return;
    offset += speed;
    if (offset >= min && offset <= max) return;
    speed = -speed;
    offset = std::clamp(2 * (offset < min ? min : max) - offset, min, max);
  }

  void jump(Random& random, bool whole) {
    offset = whole ? min + std::floor((max - min + 1) * random.fraction()) : random.between(min, max);
  }
};

/// A moving box, relative to its place in the first frame.
template <int D, typename Real>
struct MovingBox {
  BoxId id;
  Box<D, Real> first;
  std::array<AxisMotion, D> ways;

  Box<D, Real> box() const {
    Box<D, Real> moved;
    for (int axis = 0; axis < D; ++axis) {
      moved.min[axis] = static_cast<Real>(first.min[axis] + ways[axis].offset);
      moved.max[axis] = static_cast<Real>(first.max[axis] + ways[axis].offset);
    }
    return moved;
  }
};

namespace {

void check_range(const char* name, double value, double max) {
  if (value >= 0 && value <= max) return;
  const std::string expected = max == 1 ? "a number from 0 to 1" : "a number of at least 0";
  throw InvalidSpec(std::string(name) + " is " + std::to_string(value) + "; expected " + expected);
}

template <int D, typename Real>
bool is_finite(const Box<D, Real>& box) {
  bool finite = is_present(box);
  for (int axis = 0; axis < D; ++axis) finite &= std::isfinite(box.min[axis]) && std::isfinite(box.max[axis]);
  return finite;
}

template <int D, typename Real>
double mean_extent(const Box<D, Real>& box) {
  double sum = 0;
  for (int axis = 0; axis < D; ++axis) sum += static_cast<double>(box.max[axis]) - box.min[axis];
  return sum / D;
}

/// A direction times a length, as integers that are not all 0.
template <int D>
void make_whole(std::array<double, D>& velocity) {
  const auto steepest =
      std::ranges::max_element(velocity, {}, [](double component) { return std::abs(component); });
  const double sign = *steepest < 0 ? -1 : 1;
  for (double& component : velocity) component = std::round(component);
  if (*steepest == 0) *steepest = sign;
}

template <int D, typename Real>
std::vector<MovingBox<D, Real>> draw_movers(std::span<const Box<D, Real>> boxes, const SceneRequest& request,
                                            bool whole_steps, Random& random) {
  Box<D, Real> bounds = absent_box<D, Real>();
  double mean = 0;
  std::vector<BoxId> finite;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!is_finite(boxes[i])) continue;
    bounds = merged(bounds, boxes[i]);
    mean += mean_extent(boxes[i]);
    finite.push_back(BoxId(i));
  }
  mean /= static_cast<double>(std::max<std::size_t>(finite.size(), 1));

  const auto wanted = std::llround(request.moving * static_cast<double>(boxes.size()));
  const std::size_t count = std::min(finite.size(), static_cast<std::size_t>(wanted));
  random.shuffle(finite, count);
  finite.resize(count);
  std::ranges::sort(finite);

  std::vector<MovingBox<D, Real>> movers;
  movers.reserve(count);
  for (const BoxId id : finite) {
    const Box<D, Real>& box = boxes[index(id)];
    const double extent = mean_extent(box);
    std::array<double, D> velocity = random.direction<D>();
    for (double& component : velocity) component *= request.drift * (extent > 0 ? extent : mean);
    if (whole_steps && request.drift > 0) make_whole<D>(velocity);
    MovingBox<D, Real> mover{id, box, {}};
    for (int axis = 0; axis < D; ++axis) {
      mover.ways[axis] = {.speed = velocity[axis],
                          .min = static_cast<double>(bounds.min[axis]) - box.min[axis],
                          .max = static_cast<double>(bounds.max[axis]) - box.max[axis]};
    }
    movers.push_back(mover);
  }
  return movers;
}

}  // namespace

template <int D, typename Real>
struct MovingBoxes<D, Real>::State {
  SceneRequest request;
  bool whole_steps;
  std::size_t boxes;
  Random random;
  std::vector<MovingBox<D, Real>> movers;
  std::vector<Box<D, Real>> last;
};

template <int D, typename Real>
MovingBoxes<D, Real>::MovingBoxes(std::span<const Box<D, Real>> boxes, const SceneRequest& request,
                                  bool whole_steps) {
  check_range("moving", request.moving, 1);
  check_range("teleport", request.teleport, 1);
  check_range("drift", request.drift, std::numeric_limits<double>::max());
  // A different stream from that of the boxes, so that their positions and directions are independent.
  state_ = std::make_unique<State>(
      State{request, whole_steps, boxes.size(), Random(request.seed ^ 0x6d6f74696f6e0000U), {}, {}});
  state_->movers = draw_movers<D, Real>(boxes, request, whole_steps, state_->random);
  state_->last.reserve(state_->movers.size());
  for (const MovingBox<D, Real>& mover : state_->movers) state_->last.push_back(mover.first);
}

template <int D, typename Real>
MovingBoxes<D, Real>::~MovingBoxes() = default;

template <int D, typename Real>
Step<D, Real> MovingBoxes<D, Real>::next() {
  State& state = *state_;
  Step<D, Real> step{state.boxes, {}, {}};
  step.changed.reserve(state.movers.size());
  step.boxes.reserve(state.movers.size());
  for (std::size_t i = 0; i < state.movers.size(); ++i) {
    const bool jumps = state.random.chance(state.request.teleport);
    for (AxisMotion& way : state.movers[i].ways) {
      if (jumps)
        way.jump(state.random, state.whole_steps);
      else
        way.advance();
    }
    const Box<D, Real> box = state.movers[i].box();
    if (box == state.last[i]) continue;
    state.last[i] = box;
    step.changed.push_back(state.movers[i].id);
    step.boxes.push_back(box);
  }
  return step;
}

template <int D, typename Real>
History<D, Real> set_moving(std::vector<Box<D, Real>> boxes, const SceneRequest& request, bool whole_steps) {
  MovingBoxes<D, Real> moving(boxes, request, whole_steps);
  History<D, Real> history{std::move(boxes), {}};
  history.steps.reserve(request.frames);
  for (std::size_t frame = 0; frame < request.frames; ++frame) history.steps.push_back(moving.next());
  return history;
}

template class MovingBoxes<2, float>;
template class MovingBoxes<3, float>;
template class MovingBoxes<2, double>;
template class MovingBoxes<3, double>;
template History<2, float> set_moving(std::vector<Box<2, float>>, const SceneRequest&, bool);
template History<3, float> set_moving(std::vector<Box<3, float>>, const SceneRequest&, bool);
template History<2, double> set_moving(std::vector<Box<2, double>>, const SceneRequest&, bool);
template History<3, double> set_moving(std::vector<Box<3, double>>, const SceneRequest&, bool);

}  // namespace broadside::lab
