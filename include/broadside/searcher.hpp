// Searcher: the interface of an algorithm that finds overlapping pairs from nothing, and what a search
// reports about itself. A Finder is what users call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "broadside/box.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"
#include "broadside/pair.hpp"

namespace broadside {

/// What one search or one update did, in the paper's units of cost; 0 where an algorithm does not count it.
struct Statistics {
  std::uint64_t tests = 0;       ///< pairs of boxes compared
  std::uint64_t references = 0;  ///< entries of boxes in cells, leaves or lists
  std::uint64_t cells = 0;       ///< cells or nodes of the structure
  std::uint64_t hits = 0;  ///< of the tests, those of boxes that overlap; the others are false positives
};

/// Finishes a search that gave up.
template <int D>
class Successor {
 public:
  /// Whether the search that gave up has not written the pair of these two overlapping boxes.
  using IsMissing = std::function<bool(const Box<D>& a, BoxId a_id, const Box<D>& b, BoxId b_id)>;

  /// Writes every pair of the same input for which `is_missing` is true.
  virtual void finish(const IsMissing& is_missing) = 0;

 protected:
  Successor() = default;
  Successor(const Successor&) = default;
  Successor& operator=(const Successor&) = default;
  ~Successor() = default;
};

/// What a Searcher searches.
template <int D>
struct SearchInput {
  /// The boxes: all present (min <= max, no NaN), perhaps infinite. They may be the caller's own array, and
  /// another thread may break the rules and write to it. Two reads of a box may then differ, but must not
  /// cause an access out of bounds.
  std::span<const Box<D>> boxes;

  /// 0 if every overlapping pair is asked for. Otherwise, the boxes before this place are the left set and
  /// the others are the right set. Pairs within a set need not be written; they will be dropped.
  std::size_t left_count = 0;

  /// Not null if floats cannot tell whether two boxes overlap: then `boxes` are these boxes, rounded in the
  /// same order, and the pairs asked for are those that overlap in double. Only for an algorithm with
  /// Algorithm::tests_doubles.
  const Box<D, double>* doubles = nullptr;

  /// Not null if the search may give up where it makes far more tests than its boxes and pairs account for.
  /// It then calls finish() at its end. Whether it gives up, and where, must depend on the boxes alone. An
  /// algorithm that never gives up ignores it.
  Successor<D>* successor = nullptr;

  /// Threads and checkpoint. An algorithm that has no tunable `threads` uses the calling thread alone.
  const Workers& workers = default_workers;
};

/// Finds every overlapping pair among boxes of floats that are all present, from nothing, at each call.
///
/// Finder does the rest: it checks the boxes, drops absent ones, rounds doubles, applies filters and flushes
/// the sink. A searcher may keep scratch memory between calls, and nothing else that can be observed. It is
/// called by one thread at a time.
template <int D>
class BROADSIDE_PUBLIC Searcher {
 public:
  Searcher() = default;
  Searcher(const Searcher&) = delete;
  Searcher& operator=(const Searcher&) = delete;
  virtual ~Searcher() = default;

  /// Writes each pair of overlapping boxes once, as places in `input.boxes`, in an order that depends on the
  /// boxes alone. Returns what it did, or nothing if it does not count. Throws what the sink and the
  /// checkpoint throw.
  ///
  /// A pair with an id that is not below boxes.size(), or of a box with itself, is refused by
  /// std::logic_error. A pair that is missing, doubled or wrong makes a Finder, a Tracker or a World report
  /// wrong pairs, and nothing worse: ShadowTracker and WorldOptions::shadow find such faults.
  virtual std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) = 0;

  /// If the algorithm chooses among others: what it chose for the last search and why, in one sentence.
  [[nodiscard]] virtual std::string explanation() const { return {}; }
};

}  // namespace broadside
