// PairFinder: boxes to pairs, from nothing, at each call. The interface of every algorithm.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadside/bad_input.hpp"
#include "broadside/box.hpp"
#include "broadside/executor.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"
#include "broadside/statistics.hpp"

namespace broadside {
namespace core {
template <int D>
class Yielding;
}  // namespace core

template <int D, typename Real = float>
class Outlined;

/// Finds every overlapping pair in an array of boxes, from nothing, at each call.
///
/// A finder keeps its scratch memory between calls, and nothing else that can be observed. To be called by
/// one thread at a time; it may itself use several, which shows in nothing but the time.
template <int D, typename Real = float>
class PairFinder {
 public:
  PairFinder() = default;
  PairFinder(const PairFinder&) = delete;
  PairFinder& operator=(const PairFinder&) = delete;
  virtual ~PairFinder() = default;

  /// Writes each pair of overlapping boxes to `pairs` once, as ids = places in `boxes`, and flushes it. The
  /// order is fixed by the algorithm and the boxes, whatever the workers. Absent boxes pair with nothing.
  ///
  /// Throws InvalidInput, naming index and values, before anything is written if a box has a NaN, or min >
  /// max without being absent, unless bad_input() says otherwise; and what the sink throws.
  /// Boxes that are no array are gathered first. With `filters`, pairs that they do not let count are not
  /// written; throws InvalidFrame if there are some and not one for each box.
  void find(BoxView<D, Real> boxes, PairSink& pairs, const PairFilters& filters = {});

  /// Writes each pair of a box of `left` and an overlapping one of `right` once, and flushes. A pair's first
  /// is a place in `left` and its second one in `right`, so the two may be equal. No pair within a set is
  /// ever written; the library's own algorithms do not even look for one. Throws as find() does.
  void find_between(BoxView<D, Real> left, BoxView<D, Real> right, PairSink& pairs,
                    const PairFilters& filters = {});

  /// The same for two sets that lie one behind the other: the first `left_count` <= boxes.size() boxes are
  /// the left set. Where none is absent this saves copying them.
  void find_between(std::span<const Box<D, Real>> boxes, std::size_t left_count, PairSink& pairs);

  /// What find() and find_between() do about invalid boxes: they throw, unless set_bad_input() says
  /// otherwise.
  BadInput bad_input() const noexcept { return bad_input_; }
  void set_bad_input(BadInput bad_input) noexcept { bad_input_ = bad_input; }

  /// The places of the last call's invalid boxes, ascending, where they are quarantined; those of a right set
  /// are counted on from the end of the left one. Valid until the next call.
  std::span<const BoxId> quarantined() const noexcept { return quarantined_; }

  /// What the last find() did; empty where the algorithm does not count.
  const std::optional<Statistics>& statistics() const noexcept { return statistics_; }

  /// Who does the work: one thread, unless the spec or set_workers() says otherwise. An algorithm without the
  /// tunable `threads` uses the calling thread alone.
  const Workers& workers() const noexcept { return workers_; }
  void set_workers(const Workers& workers) {
    workers_ = workers;
    workers_changed();
  }

  /// Where the algorithm is one that chooses: what it chose for the last find(), and why, in a sentence.
  /// Empty for others.
  virtual std::string explanation() const { return {}; }

  /// What it lays over boxes, to be drawn, where it lays something: see outline().
  virtual Outlined<D, Real>* outlined() noexcept { return nullptr; }

  /// For the library: this finder, if its searches can give up.
  virtual core::Yielding<D>* yielding() noexcept { return nullptr; }

 protected:
  /// For find_valid: what this search did.
  void count(const Statistics& statistics) { statistics_ = statistics; }

  /// For find_valid: lets another finder do this search, with the same workers. Its statistics are then this
  /// finder's.
  void search_with(PairFinder& other, std::span<const Box<D, Real>> boxes, PairSink& pairs);

  /// For find_valid: 0 if every overlapping pair is asked for. Else the boxes before this place are the left
  /// set and the others the right one, and pairs within a set need not be written: they will be dropped.
  std::size_t left_count() const noexcept { return left_count_; }

 private:
  /// What an algorithm writes. `boxes` are all present: min <= max, no NaN, perhaps infinite. Pairs are of
  /// places in `boxes`. No need to flush.
  virtual void find_valid(std::span<const Box<D, Real>> boxes, PairSink& pairs) = 0;

  /// Where a finder works through another one, it hands workers() on.
  virtual void workers_changed() {}

  /// Checks the boxes, and returns how many are absent or quarantined.
  std::size_t check(std::span<const Box<D, Real>> boxes) const;

  /// The boxes as an array: themselves, or gathered into `scratch`.
  static std::span<const Box<D, Real>> array_of(BoxView<D, Real> boxes, std::vector<Box<D, Real>>& scratch);

  /// Appends the places of the invalid ones of `boxes` to quarantined_, counted on from `first`.
  void list_invalid(std::span<const Box<D, Real>> boxes, std::size_t first);

  /// Appends the present ones of `boxes` to present_ and their places to ids_.
  void take_present(std::span<const Box<D, Real>> boxes);

  std::array<std::vector<Box<D, Real>>, 2> gathered_;  // boxes that were given as no array
  std::vector<Box<D, Real>> present_;  // the boxes without the absent ones; unused while one set has none
  std::vector<BoxId> ids_;             // and their places in the caller's array
  std::vector<BoxId> quarantined_;
  BadInput bad_input_ = BadInput::reject;
  std::size_t left_count_ = 0;
  std::optional<Statistics> statistics_;
  Workers workers_;
};

}  // namespace broadside
