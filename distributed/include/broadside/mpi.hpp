// Joins over the ranks of an MPI program: each rank passes its boxes and gets the pairs that it owns.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <mpi.h>

#include "broadside/box.hpp"
#include "broadside/box_view.hpp"
#include "broadside/export.hpp"
#include "broadside/large_pair.hpp"
#include "broadside/spec.hpp"

namespace broadside::mpi {

/// Thrown on the other ranks if one rank fails, for example for lack of memory. The text begins with the
/// failed rank.
class BROADSIDE_PUBLIC RankError : public std::runtime_error {
 public:
  RankError(int rank, const std::string& message) : std::runtime_error(message), rank_(rank) {}

  /// The first rank that failed.
  int rank() const noexcept { return rank_; }

 private:
  int rank_;
};

/// Options of a join; the same on each rank.
struct Options {
  std::string_view algorithm =
      default_algorithm;                 ///< spec of the algorithm with which each rank joins its part
  std::optional<std::size_t> threads{};  ///< per rank; empty: as the spec says

  /// Number of sampled boxes, over all ranks, for choosing the cuts; 0: 16,384, or 4,096 per rank if that is
  /// more.
  std::size_t sample = 0;

  /// Use 64-bit ids even if 32 bits suffice. They are always used above 2^32 boxes.
  bool has_large_ids = false;
};

/// Statistics of a rank for one find_pairs().
struct RankStatistics {
  std::uint64_t boxes = 0;       ///< passed on this rank, of both sets
  std::uint64_t part_boxes = 0;  ///< touching this rank's part of space
  std::uint64_t part_pairs = 0;  ///< found in this part
  std::uint64_t pairs = 0;       ///< delivered on this rank
  std::uint64_t box_bytes = 0;   ///< sent to other ranks for boxes, including the sample
  std::uint64_t pair_bytes = 0;  ///< sent to other ranks for pairs
  double work = 0;               ///< Partition::cost() of the part's boxes and pairs

  friend bool operator==(const RankStatistics&, const RankStatistics&) = default;
};

/// Statistics of all ranks.
struct Summary {
  RankStatistics all;                  ///< sums over the ranks
  double largest_over_mean_work = 1;   ///< largest work of a rank over the mean of all ranks
  double largest_over_mean_boxes = 1;  ///< the same ratio for part_boxes
  double largest_over_mean_pairs = 1;  ///< the same ratio for part_pairs
};

/// Combines the ranks' statistics. Collective; the result is the same on all ranks.
BROADSIDE_PUBLIC Summary summary(MPI_Comm comm, const RankStatistics& statistics);

/// Receives the pairs that a rank owns, in chunks and in order.
using PairCallback = std::function<void(std::span<const LargePair>)>;

namespace detail {

/// Finds pairs within one set or, if `right` is given, between two.
template <int D, typename Real>
BROADSIDE_PUBLIC RankStatistics find_pairs(MPI_Comm comm, const BoxView<D, Real>& boxes,
                                           const BoxView<D, Real>* right, const PairCallback& pairs,
                                           const Options& options);

}  // namespace detail

/// Finds every pair of overlapping boxes of all ranks. Collective.
///
/// A box's id is its index in `boxes` plus the number of boxes of all lower ranks. Each pair is passed to
/// `pairs` once, with first < second, on the rank that passed the first box; the pairs of a rank are sorted.
/// The concatenated pairs of all ranks are therefore the same for any number of ranks.
///
/// Boxes are closed and may be absent, as in broadside::find_pairs(). A rank may pass between 0 and 2^32 - 1
/// boxes, and its part of space may hold as many.
///
/// Errors other than MPI's own are thrown on all ranks or on none: InvalidInput with the rank and the box's
/// index on that rank; InvalidSpec, also if options, dimension or type differ between ranks; InvalidFrame for
/// too many boxes. If a rank throws anything else, such as std::bad_alloc, the other ranks throw RankError.
/// No rank delivers pairs before all ranks have theirs. If `pairs` throws, other ranks have delivered their
/// own.
///
/// Cost: boxes are sent to the ranks whose parts of space they touch, and pairs to their owners. Memory: that
/// of a search in the part, with copies of its boxes, plus twice the pairs.
///
/// A rank may search with several threads, which do not call MPI: initialise MPI by MPI_Init_thread() with
/// MPI_THREAD_FUNNELED. With MPI_THREAD_MULTIPLE, several threads may call this function at the same time for
/// different communicators.
template <BoxRange Boxes>
RankStatistics find_pairs(MPI_Comm comm, const Boxes& boxes, const PairCallback& pairs,
                          const Options& options = {}) {
  using View = broadside::detail::ViewOf<Boxes>;
  return detail::find_pairs(comm, View(boxes), static_cast<const View*>(nullptr), pairs, options);
}

/// As above, for every pair of a box of `left` and an overlapping box of `right`, of all ranks: first is an
/// id in the left set and second an id in the right set, and the rank that passed the left box gets the pair.
template <BoxRange Left, std::convertible_to<broadside::detail::ViewOf<Left>> Right>
RankStatistics find_pairs(MPI_Comm comm, const Left& left, const Right& right, const PairCallback& pairs,
                          const Options& options = {}) {
  using View = broadside::detail::ViewOf<Left>;
  const View right_view(right);
  return detail::find_pairs(comm, View(left), &right_view, pairs, options);
}

/// The same pairs in a vector: those that this rank owns.
template <BoxRange Boxes>
std::vector<LargePair> find_pairs(MPI_Comm comm, const Boxes& boxes, const Options& options = {}) {
  std::vector<LargePair> found;
  find_pairs(
      comm, boxes,
      [&](std::span<const LargePair> pairs) { found.insert(found.end(), pairs.begin(), pairs.end()); },
      options);
  return found;
}

template <BoxRange Left, std::convertible_to<broadside::detail::ViewOf<Left>> Right>
std::vector<LargePair> find_pairs(MPI_Comm comm, const Left& left, const Right& right,
                                  const Options& options = {}) {
  std::vector<LargePair> found;
  find_pairs(
      comm, left, right,
      [&](std::span<const LargePair> pairs) { found.insert(found.end(), pairs.begin(), pairs.end()); },
      options);
  return found;
}

}  // namespace broadside::mpi
