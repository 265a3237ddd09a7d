// Joins by the ranks of an MPI program: each hands in its boxes and gets the pairs that it owns.
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

/// Thrown on the other ranks if something fails on one, such as for lack of memory. The text begins with the
/// rank that failed.
class BROADSIDE_PUBLIC RankError : public std::runtime_error {
 public:
  RankError(int rank, const std::string& message) : std::runtime_error(message), rank_(rank) {}

  /// The first rank on which it happened.
  int rank() const noexcept { return rank_; }

 private:
  int rank_;
};

/// How ranks search; the same on each.
struct Options {
  std::string_view algorithm = default_algorithm;  ///< the spec by which each rank joins its part
  std::optional<std::size_t> threads{};            ///< of each rank; empty: as the spec says

  /// How many boxes of all ranks the cuts are made from; 0: 16,384, or 4,096 a rank where that is more.
  std::size_t sample = 0;

  /// Whether ids are sent as 64 bits although 32 would do. Above 2^32 boxes they always are.
  bool has_large_ids = false;
};

/// What a rank did in one find_pairs().
struct RankStatistics {
  std::uint64_t boxes = 0;       ///< handed in on this rank, of both sets
  std::uint64_t part_boxes = 0;  ///< that touch this rank's part of space
  std::uint64_t part_pairs = 0;  ///< found there
  std::uint64_t pairs = 0;       ///< delivered on this rank
  std::uint64_t box_bytes = 0;   ///< sent to other ranks for boxes, the sample among them
  std::uint64_t pair_bytes = 0;  ///< sent to other ranks for pairs
  double work = 0;               ///< Partition::cost() of the part's boxes and pairs

  friend bool operator==(const RankStatistics&, const RankStatistics&) = default;
};

/// What all ranks did.
struct Summary {
  RankStatistics all;                  ///< sums over the ranks
  double largest_over_mean_work = 1;   ///< the work of the rank with the most over the mean of all ranks
  double largest_over_mean_boxes = 1;  ///< likewise part_boxes
  double largest_over_mean_pairs = 1;  ///< and part_pairs
};

/// Adds up the ranks' statistics. Collective; the same on all ranks.
BROADSIDE_PUBLIC Summary summary(MPI_Comm comm, const RankStatistics& statistics);

/// Takes the pairs that a rank owns, a chunk at a time, in order.
using PairCallback = std::function<void(std::span<const LargePair>)>;

namespace detail {

/// Finds pairs within one set or, where `right` is given, between two.
template <int D, typename Real>
BROADSIDE_PUBLIC RankStatistics find_pairs(MPI_Comm comm, const BoxView<D, Real>& boxes,
                                           const BoxView<D, Real>* right, const PairCallback& pairs,
                                           const Options& options);

}  // namespace detail

/// Finds every pair of overlapping boxes of all ranks. Collective.
///
/// A box's id is its index in `boxes` plus the number of boxes of all ranks before. Each pair is handed to
/// `pairs` once, with first < second, on the rank that handed in the first box; the pairs of a rank are
/// sorted. So the pairs of all ranks in turn are the same, in the same order, for any number of ranks.
///
/// Boxes are closed and may be absent, as in broadside::find_pairs(). A rank may have none, and up to
/// 2^32 - 1; in a rank's part of space there may be as many.
///
/// Throws on all ranks or on none, but for what MPI itself makes of its errors: InvalidInput naming rank and
/// box, with the box's index on that rank; InvalidSpec, also where options, dimension or type differ between
/// ranks; InvalidFrame for too many boxes. If anything else is thrown on a rank, such as std::bad_alloc, that
/// rank throws it on and the others RankError. No pair is handed on before all ranks have theirs; where
/// `pairs` throws, other ranks have handed on their own.
///
/// Cost: boxes are sent to the ranks whose part of space they touch, and pairs to their owners. Memory: that
/// of a search in the part, with copies of its boxes, and of the pairs, twice.
///
/// A rank may search by several threads, which do not call MPI: initialise it by MPI_Init_thread() with
/// MPI_THREAD_FUNNELED. With MPI_THREAD_MULTIPLE, several threads may call this at the same time for
/// different communicators.
template <BoxRange Boxes>
RankStatistics find_pairs(MPI_Comm comm, const Boxes& boxes, const PairCallback& pairs,
                          const Options& options = {}) {
  using View = broadside::detail::ViewOf<Boxes>;
  return detail::find_pairs(comm, View(boxes), static_cast<const View*>(nullptr), pairs, options);
}

/// Likewise finds every pair of a box of `left` and an overlapping one of `right`, of all ranks: first is an
/// id in the left set and second one in the right, and the rank that handed in the left box gets the pair.
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
