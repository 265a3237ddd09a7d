// Random histories of boxes that come, move, jump and go.
#include "histories.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <span>
#include <utility>

#include "hard_inputs.hpp"
#include "law_case.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

/// How a random history goes. Chances are given as one in so many; a rest is a frame in which nothing
/// changes.
struct Course {
  std::size_t slots;
  std::size_t frames;
  std::size_t changes;        ///< most slots that change in a frame
  std::size_t resize_one_in;  ///< frames in which the array grows or shrinks
  std::size_t rest_one_in;
};

/// Makes boxes of one kind, near another box or anywhere.
template <int D>
struct BoxSource {
  std::function<Box<D>(Rng&)> anywhere;
  std::function<Box<D>(Rng&, const Box<D>&)> near;
};

/// Boxes with whole coordinates: touching and coinciding all the time.
template <int D>
BoxSource<D> whole_numbers() {
  return {.anywhere =
              [](Rng& rng) {
                Box<D> box;
                for (int axis = 0; axis < D; ++axis) {
                  box.min[axis] = static_cast<float>(rng.whole(-6, 6));
                  box.max[axis] = box.min[axis] + static_cast<float>(rng.whole(0, 3));
                }
                return box;
              },
          .near =
              [](Rng& rng, const Box<D>& from) {
                Box<D> box = from;
                const int axis = rng.whole(0, D - 1);
                const auto step = static_cast<float>(rng.whole(-1, 1));
                box.min[axis] += step;
                box.max[axis] += step;
                return box;
              }};
}

template <int D>
BoxSource<D> real_numbers() {
  return {.anywhere =
              [](Rng& rng) {
                Box<D> box;
                const float size = rng.one_in(20) ? 30.0f : 2.0f;
                for (int axis = 0; axis < D; ++axis) {
                  box.min[axis] = rng.between(-10, 10);
                  box.max[axis] = box.min[axis] + rng.between(0, size);
                }
                return box;
              },
          .near =
              [](Rng& rng, const Box<D>& from) {
                Box<D> box = from;
                for (int axis = 0; axis < D; ++axis) {
                  const float step = rng.between(-0.5f, 0.5f);
                  box.min[axis] += step;
                  box.max[axis] += step;
                }
                return box;
              }};
}

/// Boxes at the ends of what a float can hold.
template <int D>
BoxSource<D> special_values() {
  const auto anywhere = [](Rng& rng) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr float largest = std::numeric_limits<float>::max();
    static constexpr std::array<float, 9> values = {-infinity, -largest, -1,      -0.0f,   0.0f,
                                                    1,         2,        largest, infinity};
    Box<D> box;
    for (int axis = 0; axis < D; ++axis) {
      const float a = rng.one_of(std::span<const float>(values));
      const float b = rng.one_of(std::span<const float>(values));
      box.min[axis] = std::min(a, b);
      box.max[axis] = std::max(a, b);
    }
    return box;
  };
  return {.anywhere = anywhere, .near = [anywhere](Rng& rng, const Box<D>&) { return anywhere(rng); }};
}

template <int D>
lab::History<D> random_history(const BoxSource<D>& kind, const Course& course, std::uint64_t seed) {
  Rng rng(seed);
  lab::History<D> history;
  for (std::size_t i = 0; i < course.slots; ++i)
    history.boxes.push_back(rng.one_in(4) ? absent_box<D>() : kind.anywhere(rng));

  std::vector<Box<D>> boxes = history.boxes;
  for (std::size_t frame = 0; frame < course.frames; ++frame) {
    lab::Step<D> step{.size = boxes.size(), .changed = {}, .boxes = {}};
    if (course.resize_one_in > 0 && rng.one_in(course.resize_one_in))
      step.size = rng.one_in(4) ? 0 : rng.below(2 * course.slots);
    const std::size_t places = std::max(step.size, boxes.size());
    const bool rests = course.rest_one_in > 0 && rng.one_in(course.rest_one_in);
    const std::size_t changes = rests || places == 0 ? 0 : rng.below(course.changes + 1);
    std::vector<std::pair<BoxId, Box<D>>> changed;
    const auto is_changed = [&](std::size_t place) {
      return std::ranges::any_of(changed, [place](const auto& other) { return index(other.first) == place; });
    };
    const auto change = [&](std::size_t place, const Box<D>& box) {
      // A place listed twice must be harmless, and so must one beyond a shorter array's end.
      for (std::size_t times = rng.one_in(8) ? 2 : 1; times > 0; --times) {
        changed.emplace_back(BoxId(place), box);
      }
    };
    std::vector<Box<D>> next = boxes;
    next.resize(places, absent_box<D>());
    for (std::size_t i = 0; i < changes; ++i) {
      const std::size_t place = rng.below(places);
      // Changed once: a second change would make the list say two things of one place.
      if (is_changed(place)) continue;
      Box<D>& box = next[place];
      const std::size_t what = rng.below(8);
      if (is_absent(box) || what == 0)
        box = kind.anywhere(rng);  // comes, or jumps
      else if (what == 1)
        box = absent_box<D>();  // goes
      else if (what > 2)
        box = kind.near(rng, box);  // moves; or else is said to change and does not
      change(place, box);
    }
    next.resize(step.size);
    for (std::size_t place = boxes.size(); place < step.size; ++place) {
      if (is_changed(place)) continue;
      next[place] = kind.anywhere(rng);
      change(place, next[place]);
    }
    rng.shuffle(changed);
    for (const auto& [id, box] : changed) {
      step.changed.push_back(id);
      step.boxes.push_back(box);
    }
    boxes = std::move(next);
    history.steps.push_back(std::move(step));
  }
  return history;
}

/// Everything goes and comes back, again and again.
template <int D>
lab::History<D> flicker(const BoxSource<D>& kind, std::size_t count) {
  Rng rng(11);
  lab::History<D> history;
  std::vector<BoxId> all;
  for (std::size_t i = 0; i < count; ++i) {
    history.boxes.push_back(kind.anywhere(rng));
    all.push_back(BoxId(i));
  }
  for (int frame = 0; frame < 6; ++frame) {
    const std::vector<Box<D>> boxes =
        frame % 2 == 0 ? std::vector<Box<D>>(count, absent_box<D>()) : history.boxes;
    history.steps.push_back({.size = count, .changed = all, .boxes = boxes});
  }
  return history;
}

/// A first frame without a box, and one box more in each that follows; then none at once.
template <int D>
lab::History<D> arrivals(const BoxSource<D>& kind, std::size_t count) {
  Rng rng(13);
  lab::History<D> history;
  for (std::size_t i = 0; i < count; ++i)
    history.steps.push_back({.size = i + 1, .changed = {BoxId(i)}, .boxes = {kind.anywhere(rng)}});
  history.steps.push_back({.size = 0, .changed = {}, .boxes = {}});
  history.steps.push_back({.size = 1, .changed = {BoxId(0)}, .boxes = {kind.anywhere(rng)}});
  return history;
}

}  // namespace

template <int D>
std::vector<NamedHistory<D>> hard_histories(const Algorithm& algorithm) {
  const std::size_t frames = reduced(60, 1);
  std::vector<NamedHistory<D>> histories;
  const auto add = [&](const std::string& name, const BoxSource<D>& kind, const Course& course) {
    const std::uint64_t seeds = algorithm.kind == AlgorithmKind::peer ? 1 : 3;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed)
      histories.push_back({name + ", seed " + std::to_string(seed), random_history(kind, course, seed)});
  };
  std::vector<std::pair<std::string, BoxSource<D>>> kinds = {{"whole numbers", whole_numbers<D>()},
                                                             {"real numbers", real_numbers<D>()}};
  if (takes_any_floats(algorithm)) kinds.emplace_back("special values", special_values<D>());
  for (const auto& [name, kind] : kinds) {
    add(name + ", few changes", kind, {150, frames, 8, 0, 5});
    add(name + ", many changes", kind, {150, frames, 150, 0, 20});
    add(name + ", growing and shrinking", kind, {40, 2 * frames, 20, 3, 10});
    add(name + ", few boxes", kind, {3, 4 * frames, 3, 4, 10});
    histories.push_back({name + ", all going and coming", flicker(kind, 100)});
    histories.push_back({name + ", one more in each frame", arrivals(kind, 40)});
  }
  return histories;
}

template std::vector<NamedHistory<2>> hard_histories(const Algorithm&);
template std::vector<NamedHistory<3>> hard_histories(const Algorithm&);

}  // namespace broadside::laws
