// TileSearch: finds the pairs of as many boxes as fit in a core's cache.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "algorithms/grid/tile_cells.hpp"
#include "core/large_array.hpp"
#include "kernels/bucket_sweep.hpp"
#include "kernels/run.hpp"

namespace broadside::algorithm {

/// Sorts boxes into rows of buckets by counting, once for each row that they reach, and sweeps each row. A
/// pair is reported in the row that holds the greater of the two minima on every axis. Keeps its memory.
template <int D>
class TileSearch {
 public:
  /// Sorts at most TileCells<D>::max_boxes boxes. If `left_count` is not 0, the boxes before it are the left
  /// set. Returns how many tests a sweep makes. Nothing, and no boxes are sorted, if they are in more than
  /// four rows on average, or too uneven: if two of them are within a span of buckets more than
  /// `max_unevenness` times as often as two of evenly spread ones.
  std::optional<std::uint64_t> sort(std::span<const Box<D>> boxes, const TileCells<D>& cells,
                                    std::size_t left_count,
                                    double max_unevenness = std::numeric_limits<double>::infinity());

  /// Whether few of the tests would find a pair, in a sample of them.
  bool finds_few_pairs();

  /// The places of the boxes sorted last, to be swept together or in parts.
  std::size_t places() const noexcept { return rows_.run.size; }

  /// Reports the pairs of the boxes at the places [begin, end) and later ones. Returns the number of tests.
  /// `doubles` and `checkpoint` are as in a Run. Several threads may sweep at the same time.
  std::uint64_t sweep(std::size_t begin, std::size_t end, const Box<D, double>* doubles,
                      Checkpoint* checkpoint, PairSink& pairs) const;

  /// Entries of boxes in rows.
  std::size_t references() const noexcept { return references_; }

 private:
  /// A box in a row other than that of its minimum.
  struct FurtherRow {
    std::uint32_t box;
    std::uint16_t key;
    std::uint16_t dedup_mask;
  };

  template <bool HasRows>
  void count(std::span<const Box<D>> boxes, const TileCells<D>& cells);
  bool count_further(std::span<const Box<D>> boxes, const TileCells<D>& cells);
  double unevenness(std::size_t buckets) const;
  std::size_t place_rows(std::size_t rows, std::size_t buckets);
  template <bool HasMasks>
  void scatter(std::span<const Box<D>> boxes, const TileCells<D>& cells, std::size_t left_count);
  void end_rows();

  // By row and bucket: how many boxes, then where the next one goes, at last where they end.
  core::LargeArray<std::uint32_t> bucket_ends_;
  core::LargeArray<std::uint16_t> keys_;      // by box: its row and bucket
  core::LargeArray<std::uint32_t> reaching_;  // boxes that reach further rows
  std::vector<FurtherRow> further_;
  core::LargeArray<std::uint32_t> candidate_ends_;
  kernels::RunBuffer<D> run_;
  kernels::BucketRows<D> rows_{};
  std::size_t references_ = 0;
};

}  // namespace broadside::algorithm
