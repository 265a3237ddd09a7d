// Random histories in which boxes are added, move, jump and are removed: everything that a history may
// contain.
#include <algorithm>
#include <limits>
#include <utility>

#include "lab/scenes/motion.hpp"
#include "lab/scenes/random.hpp"
#include "lab/scenes/registry.hpp"
#include "lab/scenes/scatter.hpp"

namespace broadside::lab {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float largest = std::numeric_limits<float>::max();
constexpr std::uint64_t longest = 5;

template <int D>
class ChurnMaker {
 public:
  explicit ChurnMaker(const Churn& churn)
      : churn_(churn), side_(integer_side<D>(churn.boxes, longest)), random_(churn.seed) {}

  History<D> make_churn() {
    for (std::size_t i = 0; i < churn_.boxes; ++i)
      boxes_.push_back(random_.chance(0.9) ? draw() : absent_box<D>());
    History<D> history{boxes_, {}};
    for (std::size_t frame = 0; frame < churn_.frames; ++frame) {
      history.steps.push_back(draw_step());
      lab::apply(history.steps.back(), boxes_);
    }
    return history;
  }

 private:
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(random_.below(count)); }

  Step<D> draw_step() {
    Step<D> step{draw_size(), {}, {}};
    const double rate = random_.chance(0.1) ? 0 : random_.chance(0.1) ? 1 : random_.between(0.02, 0.5);
    std::vector<BoxId> places(step.size);
    for (std::size_t i = 0; i < step.size; ++i) places[i] = BoxId(i);
    random_.shuffle(places, places.size());
    for (const BoxId place : places) {
      const bool is_new = index(place) >= boxes_.size();
      if (!random_.chance(is_new ? 0.9 : rate)) continue;
      step.changed.push_back(place);
      step.boxes.push_back(is_new ? draw() : draw_change(boxes_[index(place)]));
    }
    return step;
  }

  std::size_t draw_size() {
    const std::size_t size = boxes_.size();
    const std::size_t part = 1 + below(size / 4 + 1);
    if (random_.chance(0.1) && size < 2 * churn_.boxes + 2) return size + part;
    if (random_.chance(0.1) && size > churn_.boxes / 2) return size - std::min(size, part);
    return size;
  }

  Box<D> draw_change(const Box<D>& box) {
    if (is_absent(box)) return random_.chance(0.5) ? draw() : box;
    const double kind = random_.fraction();
    if (kind < 0.2) return absent_box<D>();
    if (kind < 0.4) return draw();
    if (kind < 0.5) return box;
    const bool jumps = kind < 0.6;
    Box<D> moved = box;
    for (int axis = 0; axis < D; ++axis) {
      const float way =
          jumps ? static_cast<float>(below(side_)) - 2 - box.min[axis] : static_cast<float>(below(3)) - 1;
      if (!(way > -largest && way < largest)) continue;
      moved.min[axis] += way;
      moved.max[axis] += way;
    }
    return moved;
  }

  Box<D> draw() {
    if (!boxes_.empty() && random_.chance(0.1)) {
      const Box<D>& other = boxes_[below(boxes_.size())];
      if (is_present(other)) return other;
    }
    Box<D> box;
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = static_cast<float>(below(side_)) - 2;
      box.max[axis] = box.min[axis] + static_cast<float>(below(longest + 1));
    }
    if (random_.chance(0.1)) box.max = box.min;
    if (churn_.infinite_boxes && random_.chance(0.05)) make_huge(box);
    for (int axis = 0; axis < D; ++axis) {
      if (box.min[axis] == 0 && random_.chance(0.5)) box.min[axis] = -0.0F;
      if (box.max[axis] == 0 && random_.chance(0.5)) box.max[axis] = -0.0F;
    }
    return box;
  }

  /// Sets some of the bounds to infinity, or to the largest float.
  void make_huge(Box<D>& box) {
    const float end = random_.chance(0.7) ? infinity : largest;
    for (int axis = 0; axis < D; ++axis) {
      if (random_.chance(0.5)) box.min[axis] = -end;
      if (random_.chance(0.5)) box.max[axis] = end;
    }
  }

  Churn churn_;
  std::size_t side_;  // of the world
  Random random_;
  std::vector<Box<D>> boxes_;  // the current ones
};

}  // namespace

template <int D>
History<D> random_history(const Churn& churn) {
  return ChurnMaker<D>(churn).make_churn();
}

template History<2> random_history(const Churn&);
template History<3> random_history(const Churn&);

namespace generated {
namespace {

template <int D>
History<D> make_churn(const Settings&, const SceneRequest& request) {
  return random_history<D>(
      {.boxes = request.boxes, .frames = request.frames, .seed = request.seed, .infinite_boxes = false});
}

}  // namespace

Scene churn() {
  return {
      .name = "churn",
      .summary = "boxes that come, move, jump and go, in places that are used again",
      .source = "Broadside",
      .history_2d = make_churn<2>,
      .history_3d = make_churn<3>,
      .integers = true,
  };
}

}  // namespace generated
}  // namespace broadside::lab
