// Search: a Searcher and what surrounds it, except input checks: absent boxes, doubles, filters.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"
#include "broadside/error.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"
#include "broadside/searcher.hpp"

#include "core/large_array.hpp"
#include "find/double_search.hpp"
#include "find/filter_groups.hpp"
#include "find/grouped_search.hpp"

namespace broadside::find {

/// Makes a user's searcher throw std::logic_error for a pair with an id out of range, since ids later index
/// arrays.
template <int D>
std::unique_ptr<Searcher<D>> checked(std::unique_ptr<Searcher<D>> searcher);

/// A searcher, and how to make further ones for other threads.
template <int D>
struct Searchers {
  std::unique_ptr<Searcher<D>> first;
  std::function<std::unique_ptr<Searcher<D>>()> make_another{};  ///< empty if there can be only one
  bool tests_doubles = false;                                    ///< as in Algorithm
};

/// Makes the searcher of an algorithm, checked if a user registered the algorithm. The library's algorithms
/// and the peers of the comparison are tested, so they need no check that would slow them down.
template <int D>
Searchers<D> searchers_of(const Algorithm& algorithm, Settings settings);

/// Options of one search.
template <int D>
struct SearchOptions {
  PairFilters filters{};
  const Workers& workers = default_workers;
  Successor<D>* successor = nullptr;  ///< as in SearchInput

  /// The number of boxes that are not present, if it is known.
  std::optional<std::size_t> absent{};

  bool are_rounded = false;  ///< whether Search::round() returned true for the boxes

  /// If false, pairs of boxes of doubles that overlap only when rounded to floats are written too.
  bool is_exact = true;
};

/// Finds pairs of boxes, some of which may be absent. Boxes that are not present form no pairs. There is one
/// filter for each box, or none. Flushes no sink of the caller. Keeps its memory.
template <int D, typename Real>
class Search {
 public:
  explicit Search(Searchers<D> searchers);

  /// Checks boxes as core::check_boxes() does, and returns how many are absent or quarantined. With several
  /// workers, each checks a range, and the exception of the first range with an invalid box is thrown.
  static std::size_t check_and_count_absent(std::span<const Box<D, Real>> boxes, const Workers& workers,
                                            BadInput bad_input, const char* which = "");

  /// Rounds boxes of doubles for find(), and checks them in the same pass. Returns false for floats, or if
  /// some boxes are not present.
  bool round(std::span<const Box<D, Real>> boxes, const Workers& workers);

  /// Every pair of one set.
  std::optional<Statistics> find(std::span<const Box<D, Real>> boxes, const SearchOptions<D>& options,
                                 PairSink& pairs);

  /// Every pair of a box of `left` and a box of `right`, as places in the two.
  std::optional<Statistics> find_between(std::span<const Box<D, Real>> left,
                                         std::span<const Box<D, Real>> right, const SearchOptions<D>& options,
                                         PairSink& pairs);

  /// The same for two sets in one array; without a copy if no box is absent.
  std::optional<Statistics> find_across(std::span<const Box<D, Real>> boxes, std::size_t left_count,
                                        const SearchOptions<D>& options, PairSink& pairs);

  /// As Searcher::explanation(); if there were several searches of groups, for the last one.
  std::string explanation() const;

 private:
  std::optional<Statistics> find_within(std::span<const Box<D, Real>> boxes, const SearchOptions<D>& options,
                                        PairSink& pairs);
  std::optional<Statistics> nothing_found() noexcept {
    is_filtered_ = false;
    return Statistics{};
  }
  std::optional<Statistics> search_present(std::span<const Box<D, Real>> boxes, std::size_t left_count,
                                           const SearchOptions<D>& options, const BoxFilters& filters,
                                           PairSink& pairs);
  std::optional<Statistics> search_in_groups(const SearchInput<D>& input, const BoxFilters& filters,
                                             PairSink& pairs);
  void take_present(std::span<const Box<D, Real>> boxes);

  Searchers<D> searchers_;
  DoubleSearch<D> doubles_;
  std::unique_ptr<GroupedSearch<D>> groups_;  // null until boxes have filters
  bool is_filtered_ = false;                  // whether boxes had filters in the last search
  core::LargeArray<Box<D, Real>> present_;    // the boxes without the absent ones; unused if there are none
  std::vector<BoxId> ids_;                    // their places in the caller's array
};

}  // namespace broadside::find
