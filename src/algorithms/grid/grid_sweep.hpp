// GridSweep: sweeps the cells of a grid, slab by slab. Orders the boxes of each cell and reports their pairs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"
#include "broadside/searcher.hpp"

#include "algorithms/grid/grid_layout.hpp"
#include "core/cell_axis.hpp"
#include "core/radix_sort.hpp"
#include "kernels/run.hpp"

namespace broadside::algorithm {

/// A box in a cell. Bit a of `dedup_mask` is set if it begins before the cell on axis a; other bits are as in
/// a Run.
template <int D>
struct CellEntry {
  Box<D> box;
  BoxId id;
  std::uint32_t dedup_mask;
};

/// The boxes of a grid, by the cell that holds their minimum. A box that reaches other slabs is also in the
/// first row of each. Cell c has `boxes[begin[c], begin[c + 1])`.
template <int D>
struct BoxesByCell {
  std::span<const CellEntry<D>> boxes;
  std::span<const std::uint64_t> begin;
  const Box<D, double>* doubles;  ///< as in a Run
  Checkpoint* checkpoint;         ///< likewise
};

/// The range of the swept axis to cut into buckets.
struct SweptRange {
  float low;
  float high;
};

/// Sweeps slabs; holds the memory this takes. A box is carried on from the cell it was inserted into to the
/// others that it reaches: along the row, and up to the next row.
template <int D>
class GridSweep {
 public:
  /// Reports the pairs of a slab's cells, each in the cell that holds the greater of the two minima on every
  /// gridded axis. Stops before a cell once the tests exceed both `max_tests` and what pairs account for.
  Statistics sweep(const GridLayout<D>& layout, const SweptRange& range, const BoxesByCell<D>& cells,
                   std::size_t slab, std::uint64_t max_tests, PairSink& pairs);

  /// The first cell that was not swept.
  std::size_t swept_to() const noexcept { return swept_to_; }

 private:
  /// Boxes carried to a cell.
  struct Carried {
    std::vector<CellEntry<D>> memory;
    std::size_t size = 0;

    void reserve(std::size_t count) {
      if (memory.size() < count) memory.resize(count + count / 2);
    }
    std::span<const CellEntry<D>> list() const { return {memory.data(), size}; }
  };

  /// The swept axis cut into buckets. The first and the last bucket take in what lies beyond.
  struct Buckets {
    core::CellAxis of;
    float slack;  // boxes of one bucket begin at most this far apart, except beyond the ends

    std::size_t count() const { return of.count(); }
  };

  /// A cell's boxes: inserted there, carried from the row before and, in 3D, carried along the row.
  using Lists = std::array<std::span<const CellEntry<D>>, D>;

  /// Reports the pairs of a cell and carries its boxes on to the cells whose borders they reach. False,
  /// without a report, if the cell alone would take more than `max_tests` and few of them would find a pair.
  bool sweep_cell(const Lists& lists, float column_border, float row_border, std::uint64_t max_tests,
                  PairSink& pairs);

  /// How many of a cell's `count` boxes reach a border; `count` itself if there are few.
  static std::size_t max_reaching(const Lists& lists, std::size_t count, int axis, float border);

  static Buckets cut(const SweptRange& range, std::size_t count);

  /// Counts a list's boxes by bucket and carries them on: up and, if Along, along the row.
  template <bool Along>
  void count_and_pass_on(std::span<const CellEntry<D>> list, const Buckets& buckets, float column_border,
                         float row_border, std::uint16_t* bucket_of);

  /// Sets run_ to the cell's boxes in the order of the sweep: by the counted buckets if these are even
  /// enough. Returns the run's slack.
  float order(const Lists& lists, std::size_t count, const Buckets& buckets);
  bool are_even(std::size_t count) const;
  void scatter(const Lists& lists);
  void sort(const Lists& lists, std::size_t count);

  std::array<int, D> axes_{};
  std::size_t swept_to_ = 0;
  SweptRange range_{};
  const Box<D, double>* doubles_ = nullptr;
  Checkpoint* checkpoint_ = nullptr;
  Statistics statistics_;
  Carried along_;                      // to this cell, from the one before it in the row
  Carried next_along_;                 // from this cell to the next
  Carried next_up_;                    // from this cell to the one in the next row
  std::vector<Carried> columns_;       // to each cell of a row, from the row before
  std::vector<std::uint32_t> starts_;  // by bucket: how many boxes; then where the next one goes
  std::vector<std::uint16_t> bucket_of_;
  core::RadixSort radix_;
  kernels::RunBuffer<D> run_;
};

}  // namespace broadside::algorithm
