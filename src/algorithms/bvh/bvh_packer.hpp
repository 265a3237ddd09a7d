// Packs boxes into a tree of bounds: sixteen boxes to a leaf, sixteen children to a node.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "algorithms/bvh/packed_levels.hpp"
#include "core/grow.hpp"
#include "core/large_array.hpp"
#include "core/parallel.hpp"
#include "core/radix_sort.hpp"
#include "core/sample.hpp"
#include "core/sorted_boxes.hpp"
#include "kernels/bvh_join.hpp"

namespace broadside::algorithm {

/// Builds trees and holds the last one built.
///
/// Boxes far larger than most would widen the bounds of every leaf they were in. They have leaves of their
/// own, by class of size, after the others. Each class begins with a new leaf, so up to fifteen places at its
/// end are empty.
template <int D>
class BvhPacker {
 public:
  BvhPacker() = default;
  BvhPacker(const BvhPacker&) = delete;
  BvhPacker& operator=(const BvhPacker&) = delete;

  /// Builds the tree over `boxes`: at least one, all present. A box's id is its place in the array. If
  /// `left_count` is not 0, the first `left_count` boxes have leaves of their own, before the others.
  /// Discards the last tree. The tree does not depend on the number of workers. Cost: a few passes over the
  /// boxes; allocates only to grow.
  void pack(std::span<const Box<D>> boxes, core::Parallel& parallel, std::size_t left_count = 0);

  /// The tree built last. A caller that changes its levels must keep the invariants of PackedBvh.
  const kernels::PackedBvh<D>& tree() const noexcept { return levels_.tree(); }

  /// The bytes held; about half are only needed while building.
  std::size_t bytes() const noexcept {
    std::size_t bytes = core::bytes_of(keys_, counts_, group_ends_, entries_, scratch_) + levels_.bytes();
    for (const Scratch& scratch : scratch_)
      bytes += core::bytes_of(scratch.buckets, scratch.order) + scratch.radix.bytes();
    return bytes;
  }

 private:
  using Entry = core::SortedBox<D>;

  /// A worker's memory for ordering boxes.
  struct Scratch {
    std::vector<std::uint16_t> buckets;
    std::vector<std::uint32_t> order;
    core::RadixSort radix;
  };

  void partition(std::span<const Box<D>> boxes, core::Parallel& parallel, std::size_t left);
  void choose_axes(std::size_t boxes);
  void sort_heavy_buckets(std::span<const std::uint32_t> ends, core::Parallel& parallel);
  float spacing(std::size_t count, int axis) const;
  void place_all(core::Parallel& parallel);
  void place_group(std::span<const Entry> entries, std::size_t place, std::size_t size_class,
                   core::Parallel& parallel);
  void place_slab(std::span<const Entry> slab, std::size_t place, std::size_t strip, Scratch& scratch);
  std::array<double, D> parts_of(std::size_t leaves, float size) const;
  template <typename EntryOf, typename Put>
  void order(std::size_t count, int axis, Scratch& scratch, EntryOf entry, Put put) const;

  core::Sample<D> sample_;
  std::array<int, D> axes_{};              // slabs are cut along the first one, and leaves along the last one
  std::array<float, D> typical_{};         // a typical box's extents, or more where boxes are sparse
  core::LargeArray<std::uint16_t> keys_;   // by box: its group and bucket
  std::vector<std::uint32_t> counts_;      // by range and bucket
  std::vector<std::uint32_t> group_ends_;  // where the boxes of each set and class end in entries_
  core::LargeArray<Entry> entries_;
  std::vector<Scratch> scratch_;  // by worker
  PackedLevels<D> levels_;
};

}  // namespace broadside::algorithm
