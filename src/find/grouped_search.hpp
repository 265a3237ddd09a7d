// GroupedSearch: finds the pairs that filters accept, in groups of boxes that accept each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"
#include "broadside/searcher.hpp"

#include "core/large_array.hpp"
#include "find/filter_groups.hpp"
#include "find/filter_plan.hpp"
#include "find/group_search.hpp"

namespace broadside::find {

/// If boxes accept only others of their own positive group, as equal keys make them, GroupSearch takes over.
/// Otherwise, if filters reject few pairs, all pairs are found and then tested. A sample of the boxes tells
/// how many overlapping pairs the filters reject. If these are many, boxes are grouped by filter, and
/// FilterPlan decides which groups are searched together. Searches too small for any structure use brute
/// force, whichever algorithm was asked for.
///
/// All decisions depend on the boxes and the filters alone. Keeps its memory. One thread at a time.
template <int D>
class GroupedSearch {
 public:
  /// Writes each pair of overlapping boxes that accept each other once, as places in `input.boxes`; of two
  /// sets, pairs within a set may be written too. Returns the sum of what the searches did, or nothing if one
  /// of them did not count. A search that gives up calls the successor of `input`. The successor must end the
  /// whole search, since ids then refer to the boxes of one group. Exceptions pass through. `make_another`
  /// makes searchers like this one for other threads; if it is empty, threads do not share groups.
  std::optional<Statistics> search(Searcher<D>& searcher, const SearchInput<D>& input,
                                   const BoxFilters& filters, PairSink& pairs,
                                   const typename GroupSearch<D>::MakeAnother& make_another = {});

  /// The number of searches that the last search() made.
  std::size_t searches() const noexcept { return searches_; }

  /// As Searcher::explanation(); if there were several searches, for the last one.
  std::string explanation(const Searcher<D>& searcher) const;

 private:
  bool is_grouped(const SearchInput<D>& input, const BoxFilters& filters);
  bool sample(const SearchInput<D>& input, const BoxFilters& filters);
  std::optional<Statistics> search_all(Searcher<D>& searcher, const SearchInput<D>& input,
                                       const BoxFilters& filters, PairSink& pairs);
  std::optional<Statistics> run(const PlannedSearch& planned, Searcher<D>& searcher,
                                const SearchInput<D>& input, const BoxFilters& filters, PairSink& pairs);
  void gather(const SearchInput<D>& input, std::span<const std::uint32_t> groups);
  bool compares_all(std::size_t left_count);

  struct SampledBox {
    std::size_t place;
    Box<D> box;
    Filter filter;
  };

  GroupSearch<D> by_group_;
  bool is_by_group_ = false;  // whether by_group_ made the last search
  FilterGroups groups_;
  FilterPlan plan_;
  std::unique_ptr<Searcher<D>> brute_force_;  // null until it is needed, and in a build without it
  std::size_t searches_ = 0;
  bool has_compared_all_ = false;  // whether the last of several searches used brute force
  std::vector<SampledBox> sample_;
  std::vector<std::pair<std::size_t, std::size_t>> rejected_;  // places of sampled boxes
  std::vector<FilterPlan::GroupPair> rejected_groups_;
  double weight_ = 0;               // the number of pairs of boxes that a pair of the sample stands for
  core::LargeArray<Box<D>> boxes_;  // of one search
  core::LargeArray<Box<D, double>> doubles_;
  core::LargeArray<BoxId> ids_;
};

}  // namespace broadside::find
