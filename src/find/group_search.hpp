// GroupSearch: finds the pairs of boxes that accept only others of their own positive group.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/executor.hpp"
#include "broadside/pair.hpp"
#include "broadside/searcher.hpp"

#include "core/large_array.hpp"
#include "core/parallel.hpp"
#include "find/filter_groups.hpp"

namespace broadside::find {

/// Whether a box with this filter accepts no other box because of its bits.
constexpr bool has_no_bits(const Filter& filter) noexcept { return filter.mask == 0 || filter.category == 0; }

/// Whether comparing all pairs of so few boxes costs less than any structure. If `left_count` is not 0, these
/// are pairs of the first `left_count` boxes with the others.
bool are_few(std::size_t boxes, std::size_t left_count) noexcept;

/// Searches each group by itself, in the order of their numbers, so that no pair is found and then rejected.
/// Threads share the groups; all of them search a large one. Few boxes are compared, whichever the algorithm.
///
/// The boxes are copied group by group in one pass (a counting sort), since collecting each group's from all
/// over the caller's array would miss the cache for each box.
///
/// Keeps its memory. One thread at a time.
template <int D>
class GroupSearch {
 public:
  using MakeAnother = std::function<std::unique_ptr<Searcher<D>>()>;

  GroupSearch();
  ~GroupSearch();

  /// Returns whether boxes accept only others of their own positive group and, if so, sorts them by group for
  /// search(). `shares_groups`: whether search() can make a searcher for each thread.
  bool sort(const SearchInput<D>& input, const BoxFilters& filters, bool shares_groups);

  /// Writes each pair of overlapping boxes of the same group once, as places in `input.boxes`, and returns
  /// the sum of what the searches did, as GroupedSearch::search() does. `make_another` makes searchers like
  /// `searcher`.
  std::optional<Statistics> search(Searcher<D>& searcher, const SearchInput<D>& input, PairSink& pairs,
                                   const MakeAnother& make_another);

  /// The number of searches that the last search() made.
  std::size_t searches() const noexcept { return searches_; }

  /// As Searcher::explanation(), for the last of the searches; nothing if it compared few boxes.
  const std::optional<std::string>& explanation() const noexcept { return explanation_; }

 private:
  /// Boxes, and their places in the input.
  struct Copies {
    void renew(std::size_t count, bool has_doubles);

    core::LargeArray<Box<D>> boxes;
    core::LargeArray<Box<D, double>> doubles;  // empty if floats decide
    core::LargeArray<BoxId> ids;
  };
  struct Worker;

  /// The bucket of a positive group. Buckets are in the order of groups; each has 2^shift_ of them.
  std::size_t bucket_of(std::uint32_t group) const noexcept { return (group - first_group_) >> shift_; }

  void scatter(const SearchInput<D>& input);
  core::Range bucket(std::size_t number) const noexcept;
  std::optional<Statistics> search_bucket(std::size_t number, const SearchInput<D>& input,
                                          const Workers& workers, Worker& worker, PairSink& pairs);
  static Statistics compare(const SearchInput<D>& group, std::span<const BoxId> ids,
                            const Box<D, double>* doubles, Worker& worker, PairSink& pairs);

  core::Parallel parallel_;
  core::LargeArray<std::uint32_t> groups_;  // of the boxes; 0 if not positive
  bool is_one_group_ = false;               // whether all boxes are in it
  std::uint32_t first_group_ = 0;           // the lowest positive one
  int shift_ = 0;
  std::size_t buckets_ = 0;
  std::vector<std::uint32_t> counts_;              // by range and bucket
  Copies sorted_;                                  // by bucket
  core::LargeArray<std::uint32_t> sorted_groups_;  // of sorted_, if buckets have several groups
  std::vector<std::uint32_t> searches_of_;         // by bucket
  std::size_t searches_ = 0;
  std::optional<std::string> explanation_;
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace broadside::find
