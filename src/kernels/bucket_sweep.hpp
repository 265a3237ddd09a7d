// The kernels of a search in rows of buckets: where each box's candidates end, and the sweep over them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "broadside/pair.hpp"

#include "core/cell_axis.hpp"
#include "kernels/run.hpp"

namespace broadside::kernels {

/// Boxes in rows; in each row sorted by buckets of min[0], in any order within a bucket. Each row is followed
/// by read_ahead places without a box: min[0] and max[0] are NaN there.
template <int D>
struct BucketRows {
  Run<D> run;                        ///< the places of all rows; `slack` and `rows` are not used
  std::size_t rows;                  ///< at least 1
  core::CellAxis bucket_of;          ///< of min[0] and max[0]; the buckets of a row
  const std::uint32_t* bucket_ends;  ///< by row and bucket: the place after the bucket's last box
  bool has_masks;                    ///< whether two boxes may share a bit of `dedup_mask`
};

/// Sets candidate_ends, by place: a box's candidates are the boxes after it up to there, since later ones
/// begin after it ends. Returns how many candidates there are in all.
template <int D>
std::uint64_t find_candidate_ends(const BucketRows<D>& boxes, std::uint32_t* candidate_ends);

/// Reports the pairs of a box at the places [begin, end) and one of its candidates that overlap and share no
/// bit of `dedup_mask`; in the order of places. Returns the number of candidates.
template <int D>
std::uint64_t sweep(const BucketRows<D>& boxes, const std::uint32_t* candidate_ends, std::size_t begin,
                    std::size_t end, PairSink& pairs);

}  // namespace broadside::kernels
