// What moves from one frame to the next, for tests of followers and of what they keep.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/moved_box.hpp"
#include "tests/support/model.hpp"

namespace broadside::algorithm {

/// Boxes by id, those that are not there being absent, and frames in which some of them change. What comes
/// later may be twice as long as what was there first.
template <int D>
class MovedFrames {
 public:
  MovedFrames(std::size_t count, const BoxKind& kind) : kind_(kind), boxes(count, absent_box<D>()) {
    const BoxKind shorter{kind.places, kind.max_extent / 2, kind.infinite_one_in};
    for (Box<D>& box : boxes) {
      if (!rng.one_in(4)) box = random_box<D>(rng, shorter);
    }
  }

  /// Draws a frame in which one box in `some` comes, moves near or far, or goes.
  void step(std::size_t some) {
    moved.clear();
    moves.assign(boxes.size(), 0);
    for (std::size_t id = 0; id < boxes.size(); ++id) {
      if (!rng.one_in(some)) continue;
      Box<D> now = random_box<D>(rng, kind_);
      if (is_present(boxes[id]) && rng.one_in(3)) now = absent_box<D>();
      if (is_present(boxes[id]) && rng.one_in(3)) {
        now = boxes[id];
        now.max[0] += 1;
      }
      if (!is_present(now) && !is_present(boxes[id])) continue;
      const auto or_nan = [](const Box<D>& box) { return is_present(box) ? box : core::nan_box<D>(); };
      moved.push_back(moved_box(id, or_nan(boxes[id]), or_nan(now), rng.one_in(8)));
      moves[id] = 1;
    }
  }

  /// The boxes after the frame.
  std::vector<Box<D>> now() const {
    std::vector<Box<D>> now = boxes;
    for (const core::MovedBox<D>& box : moved)
      now[index(box.id)] = box.is_present ? box.now : absent_box<D>();
    return now;
  }

  /// Brings the list up to the frame.
  void apply() { boxes = now(); }

  /// The boxes with nan_box() for those that are absent, or that move and are left out.
  std::vector<Box<D>> others(bool with_moved) const {
    std::vector<Box<D>> others = boxes;
    for (std::size_t id = 0; id < others.size(); ++id) {
      if (!is_present(others[id]) || (!with_moved && moves[id] != 0)) others[id] = core::nan_box<D>();
    }
    return others;
  }

 private:
  BoxKind kind_;

 public:
  Rng rng{11};
  std::vector<Box<D>> boxes;
  std::vector<core::MovedBox<D>> moved;
  std::vector<std::uint8_t> moves;
};

}  // namespace broadside::algorithm
