// Searcher: the interface of an algorithm that finds overlapping pairs from scratch, and the statistics of a
// search. Users call a Finder.
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

/// What one search or one update did, in the paper's units of cost; 0 if an algorithm does not count it.
struct Statistics {
  std::uint64_t tests = 0;       ///< pairs of boxes compared
  std::uint64_t references = 0;  ///< entries of boxes in cells, leaves or lists
  std::uint64_t cells = 0;       ///< cells or nodes of the structure
  std::uint64_t hits = 0;        ///< tests of boxes that overlap; the other tests are false positives
};

/// Takes over from a search that gives up.
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

/// The boxes to search, and how.
template <int D>
struct SearchInput {
  /// All are present (min <= max, no NaN); some may be infinite. They may be the caller's own array, and
  /// another thread may break the rules and write to it. Two reads of a box may then differ, but must not
  /// cause an access out of bounds.
  std::span<const Box<D>> boxes;

  /// If not 0, the boxes before this index are the left set and the others the right set, and only pairs
  /// across the sets count. Pairs within a set may be written, but are dropped.
  std::size_t left_count = 0;

  /// The same boxes as doubles, if these decide: write only pairs that overlap as doubles. They also overlap
  /// as floats, since rounding keeps the order of coordinates. Null if `boxes` decide, and for an algorithm
  /// without Algorithm::tests_doubles.
  const Box<D, double>* doubles = nullptr;

  /// Not null if the search may give up when it makes far more tests than its boxes and pairs account for. A
  /// search that gives up calls finish() at its end. Whether and where it gives up must depend on the boxes
  /// alone. A searcher can ignore it.
  Successor<D>* successor = nullptr;

  /// The threads to use: without the tunable `threads`, the calling thread alone. By `workers.checkpoint` the
  /// caller can cancel a long search: count tests with a Checkpoint, which calls it.
  const Workers& workers = default_workers;

  /// Whether a search may also refuse, before it writes a pair, boxes that its structure does not suit: it
  /// then calls finish(). Only `auto` asks for this, where it knows a better search.
  bool may_refuse = false;
};

/// The part of a Finder that you write for an algorithm of your own: it finds every overlapping pair of an
/// array of boxes.
///
/// Finder does the rest: it checks the boxes, drops absent ones, rounds doubles, applies filters and flushes
/// the sink. A searcher may keep memory between calls, but must find the same pairs as without it. Only one
/// thread at a time calls it.
template <int D>
class BROADSIDE_PUBLIC Searcher {
 public:
  Searcher() = default;
  Searcher(const Searcher&) = delete;
  Searcher& operator=(const Searcher&) = delete;
  virtual ~Searcher() = default;

  /// Writes each pair of overlapping boxes once, as indexes into `input.boxes`. The order of the pairs must
  /// depend on the boxes alone. Returns what the search did, or nothing if it does not count. Exceptions from
  /// the sink and the checkpoint must pass through.
  ///
  /// Finder throws std::logic_error for a pair with an id that is not below boxes.size() and for a pair of a
  /// box with itself. A missing, repeated or wrong pair makes a Finder, a Tracker or a World report wrong
  /// pairs, and does no other harm: ShadowTracker and WorldOptions::shadow find such faults.
  virtual std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) = 0;

  /// If the algorithm chooses among others: what it chose for the last search and why, in one sentence.
  [[nodiscard]] virtual std::string explanation() const { return {}; }
};

}  // namespace broadside
