// The memory of a packed tree of bounds: its leaves' places, which are filled from outside, and the levels
// over them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "core/large_array.hpp"
#include "core/parallel.hpp"
#include "kernels/bvh_join.hpp"

namespace broadside::algorithm {

/// As many places as leaves that are to hold `size` boxes have.
constexpr std::size_t whole_leaves(std::size_t size) {
  return (size + kernels::fan_out - 1) / kernels::fan_out * kernels::fan_out;
}

/// Between start() and build() each place gets a box or is left. Several threads may put boxes at once.
template <int D>
class PackedLevels {
 public:
  PackedLevels() = default;
  PackedLevels(const PackedLevels&) = delete;
  PackedLevels& operator=(const PackedLevels&) = delete;

  /// Starts over with `places` places, a multiple of `fan_out`. No allocation beyond growth.
  void start(std::size_t places);

  void put(std::size_t place, const Box<D>& box, BoxId id) {
    for (int axis = 0; axis < D; ++axis) {
      tree_.levels[0].min[axis][place] = box.min[axis];
      tree_.levels[0].max[axis][place] = box.max[axis];
    }
    ids_[place] = id;
  }

  /// The places from `begin` to before `end` hold nothing.
  void leave(std::size_t begin, std::size_t end) { gaps_.push_back({begin, end}); }

  /// The places before `places` hold the left set.
  void set_left_size(std::size_t places) { tree_.left_size = places; }

  /// Sets the bounds over the leaves, level by level.
  void build(core::Parallel& parallel);

  const kernels::PackedBvh<D>& tree() const noexcept { return tree_; }
  std::span<BoxId> ids() noexcept { return {ids_.data(), tree_.levels[0].size}; }
  std::size_t bytes() const noexcept;

 private:
  /// Places from one to before another that hold nothing.
  struct Gap {
    std::size_t begin;
    std::size_t end;
  };

  struct LevelMemory {
    std::array<core::LargeArray<float>, D> min;
    std::array<core::LargeArray<float>, D> max;
  };

  Gap gap_behind(std::size_t level) const;
  void fill(std::size_t level, Gap gap, const Box<D>& box);
  void resize(std::size_t level, std::size_t size);

  std::vector<Gap> gaps_;
  std::array<LevelMemory, kernels::max_levels> memory_;
  core::LargeArray<BoxId> ids_;
  kernels::PackedBvh<D> tree_{};
};

}  // namespace broadside::algorithm
