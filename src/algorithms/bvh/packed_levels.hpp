// PackedLevels: the memory of a packed tree of bounds. A packer fills the places of its leaves; the levels
// above follow from them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "core/grow.hpp"
#include "core/large_array.hpp"
#include "core/moved_box.hpp"
#include "core/parallel.hpp"
#include "kernels/bvh_join.hpp"

namespace broadside::algorithm {

/// `size` rounded up to the places of whole leaves.
constexpr std::size_t whole_leaves(std::size_t size) {
  return (size + kernels::fan_out - 1) / kernels::fan_out * kernels::fan_out;
}

/// Between start() and build(), put() or leave() each place. Several threads may put boxes at once.
template <int D>
class PackedLevels {
 public:
  PackedLevels() = default;
  PackedLevels(const PackedLevels&) = delete;
  PackedLevels& operator=(const PackedLevels&) = delete;

  /// Starts over with `places` places, a multiple of `kernels::fan_out`. Allocates only to grow.
  void start(std::size_t places) {
    resize(0, places);
    grown(ids_, places);
    gaps_.clear();
    tree_.left_size = 0;
  }

  void put(std::size_t place, const Box<D>& box, BoxId id) {
    for (int axis = 0; axis < D; ++axis) {
      tree_.levels[0].min[axis][place] = box.min[axis];
      tree_.levels[0].max[axis][place] = box.max[axis];
    }
    ids_[place] = id;
  }

  /// Leaves the places [begin, end) empty.
  void leave(std::size_t begin, std::size_t end) { gaps_.push_back({begin, end}); }

  /// The places before `places` hold the left set.
  void set_left_size(std::size_t places) { tree_.left_size = places; }

  /// Sets the bounds over the leaves, level by level.
  void build(core::Parallel& parallel) {
    tree_.first_with_gap = tree_.levels[0].size / kernels::fan_out;
    for (const core::Range gap : gaps_) {
      fill(0, gap, absent_box<D>());
      if (gap.begin < gap.end)
        tree_.first_with_gap = std::min(tree_.first_with_gap, gap.begin / kernels::fan_out);
    }
    tree_.id = ids_.data();
    tree_.level_count = 1;
    do {
      const std::size_t level = tree_.level_count++;
      resize(level, whole_leaves(tree_.levels[level - 1].size) / kernels::fan_out);
      parallel.for_ranges(tree_.levels[level].size, [&](core::Range nodes, std::size_t) {
        kernels::set_bounds(tree_, level, {nodes.begin, nodes.end});
      });
      fill(level, gap_behind(level), absent_box<D>());
    } while (tree_.levels[tree_.level_count - 1].size > kernels::fan_out);
    for (const core::Range gap : gaps_) fill(0, gap, core::nan_box<D>());
    for (std::size_t level = 1; level < tree_.level_count; ++level)
      fill(level, gap_behind(level), core::nan_box<D>());
  }

  const kernels::PackedBvh<D>& tree() const noexcept { return tree_; }

  std::size_t bytes() const noexcept {
    std::size_t bytes = core::bytes_of(gaps_, ids_);
    for (const LevelMemory& level : memory_) bytes += core::bytes_of(level.min, level.max);
    return bytes;
  }

 private:
  struct LevelMemory {
    std::array<core::LargeArray<float>, D> min;
    std::array<core::LargeArray<float>, D> max;
  };

  /// At least `size` elements of `memory`, with unspecified values.
  template <typename Element>
  static Element* grown(core::LargeArray<Element>& memory, std::size_t size) {
    if (memory.size() < size) core::renew(memory, size);
    return memory.data();
  }

  core::Range gap_behind(std::size_t level) const {
    const std::size_t size = tree_.levels[level].size;
    return {size, whole_leaves(size)};
  }

  void fill(std::size_t level, core::Range gap, const Box<D>& box) {
    for (std::size_t place = gap.begin; place < gap.end; ++place) {
      for (int axis = 0; axis < D; ++axis) {
        tree_.levels[level].min[axis][place] = box.min[axis];
        tree_.levels[level].max[axis][place] = box.max[axis];
      }
      if (level == 0) ids_[place] = BoxId{0};
    }
  }

  /// Sets the size of a level. Its elements are then unspecified.
  void resize(std::size_t level, std::size_t size) {
    LevelMemory& memory = memory_[level];
    for (int axis = 0; axis < D; ++axis) {
      tree_.levels[level].min[axis] = grown(memory.min[axis], whole_leaves(size));
      tree_.levels[level].max[axis] = grown(memory.max[axis], whole_leaves(size));
    }
    tree_.levels[level].size = size;
  }

  std::vector<core::Range> gaps_;  // empty places
  std::array<LevelMemory, kernels::max_levels> memory_;
  core::LargeArray<BoxId> ids_;
  kernels::PackedBvh<D> tree_{};
};

}  // namespace broadside::algorithm
