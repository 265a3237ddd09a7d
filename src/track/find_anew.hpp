// FindAnew: finds all pairs of a frame and reports how they differ from those of the frame before.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "broadside/filter.hpp"
#include "broadside/follower.hpp"
#include "broadside/pair.hpp"
#include "broadside/searcher.hpp"

#include "core/grow.hpp"
#include "core/parallel.hpp"
#include "find/search.hpp"

namespace broadside::track {

/// The number of pairs that are tested in the time that a search takes per box.
inline constexpr std::size_t pairs_per_box = 8;

inline constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

/// Keeps the pairs of the last frame, without those that filters reject. It does not update them in frames
/// that are handled in another way, which would cost more than it saves; the next frame then also finds the
/// pairs of the frame before.
template <int D, typename Real>
class FindAnew {
 public:
  explicit FindAnew(find::Searchers<D> searchers) : search_(std::move(searchers)) {}

  /// Writes the events of a change. Throws LimitPassed if `max_pairs` is not no_limit and there are more
  /// pairs, or a search makes far more tests than the numbers of boxes and pairs justify.
  std::optional<Statistics> update(const Change<D, Real>& change, std::size_t max_pairs, PairSink& begun,
                                   PairSink& ended);

  /// Whether the pairs of the last frame are known.
  bool knows_pairs() const noexcept { return has_pairs_; }

  /// Takes the pairs of a frame that were found in another way.
  void take(std::vector<Pair>&& pairs) noexcept {
    pairs_ = std::move(pairs);
    has_pairs_ = true;
  }

  /// Writes the events of a change from `found`, all pairs that hold after it. knows_pairs() must be true.
  void report(const Change<D, Real>& change, std::span<const Pair> found, PairSink& begun, PairSink& ended);

  /// Gives this object's spare list to the caller if it has more capacity: its pages are in use already.
  void lend_memory(std::vector<Pair>& pairs) noexcept {
    if (found_.capacity() > pairs.capacity()) found_.swap(pairs);
    pairs.clear();
  }

  /// Writes all pairs. Throws LimitPassed if the search makes far more tests than justified.
  std::optional<Statistics> find_within_limits(std::span<const Box<D, Real>> boxes,
                                               std::span<const Filter> filters, const Workers& workers,
                                               PairSink& pairs);

  /// The number of pairs after an update().
  std::size_t pair_count() const noexcept { return pairs_.size(); }

  /// Call it if a frame is handled in another way. forget() also releases the memory.
  void skip() noexcept { has_pairs_ = false; }

  void forget() noexcept {
    core::give_back(pairs_, found_);
    has_pairs_ = false;
  }

  std::string explanation() const { return search_.explanation(); }
  std::size_t bytes() const noexcept { return core::bytes_of(pairs_, found_); }

 private:
  std::optional<Statistics> find(std::span<const Box<D, Real>> boxes, std::span<const Filter> filters,
                                 const Workers& workers, std::size_t max_pairs, std::vector<Pair>& pairs);

  find::Search<D, Real> search_;
  std::vector<Pair> pairs_;  // of the last frame, if has_pairs_
  std::vector<Pair> found_;
  core::Parallel parallel_;
  bool has_pairs_ = false;
};

}  // namespace broadside::track
