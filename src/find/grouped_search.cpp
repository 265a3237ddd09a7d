// GroupedSearch: finds the pairs that filters accept, in groups of boxes that accept each other.
#include "find/grouped_search.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

#include "broadside/algorithm.hpp"

#include "algorithms/registry.hpp"
#include "core/filter_sink.hpp"
#include "core/sample.hpp"
#include "kernels/observed_tests.hpp"
#include "kernels/sweep.hpp"

namespace broadside::find {
namespace {

/// Up to this number of boxes, there are too few pairs for filters to matter.
constexpr std::size_t max_ungrouped_boxes = 128;

constexpr std::size_t max_sample = 1024;

/// Boxes are grouped if filters reject at least this number of overlapping pairs per box. A sample of sqrt(n)
/// of n boxes then has about this number in all, enough to rule out chance.
constexpr double rejected_per_box = 8;

/// Boxes are also grouped if at least one in this number accepts no other box.
constexpr std::size_t boxes_per_lonely_box = 8;

/// Several searches must promise to cost this many times less than one. PlanCosts does not know that a box
/// with many overlaps costs more in each search.
constexpr double min_gain = 2;

/// Up to this number of pairs of boxes per box, comparing them all costs less than any structure.
constexpr std::size_t compared_per_box = 128;

/// A group with more than 1 / large_groups_per_share of a thread's share of all boxes, and at least two
/// threads' minimum, is searched by all threads.
constexpr std::size_t large_groups_per_share = 4;

bool has_no_bits(const Filter& filter) { return filter.mask == 0 || filter.category == 0; }

bool is_lonely(const Filter& filter) { return filter.group <= 0 && has_no_bits(filter); }

/// Whether comparing all boxes, of one set if `left_count` is 0, costs less than any structure.
bool are_few(std::uint64_t boxes, std::uint64_t left_count) {
  const std::uint64_t compared =
      left_count == 0 ? boxes * (boxes - 1) / 2 : left_count * (boxes - left_count);
  return compared <= compared_per_box * boxes;
}

/// Passes on the pairs that filters accept. `Filters` is indexed by the place of a box.
template <typename Filters>
struct PassAccepted {
  bool operator()(Pair pair, Pair& to) const {
    to = pair;
    return accepts(filters[pair.first], filters[pair.second]);
  }

  Filters filters;
};

/// Passes on the pairs of one search that its test accepts, with the boxes' ids.
struct PassOfGroups {
  bool operator()(Pair pair, Pair& to) const {
    const BoxId a = ids[index(pair.first)];
    const BoxId b = ids[index(pair.second)];
    to = a < b ? Pair{a, b} : Pair{b, a};
    return (left_count == 0 || (index(pair.first) < left_count && index(pair.second) >= left_count)) &&
           (test == FilterTest::none || counts((*filters)[to.first], (*filters)[to.second]));
  }

  bool counts(const Filter& a, const Filter& b) const {
    return accepts(a, b) && detail::bits_accept(a, b) == (test == FilterTest::by_bits);
  }

  std::span<const BoxId> ids;
  std::size_t left_count;
  FilterTest test;
  const BoxFilters* filters;  // null if there is no test
};

}  // namespace

template <int D>
void GroupedSearch<D>::Gathered::clear() noexcept {
  boxes.clear();
  doubles.clear();
  ids.clear();
}

template <int D>
void GroupedSearch<D>::Gathered::add(const SearchInput<D>& input, BoxId place) {
  boxes.push_back(input.boxes[place]);
  if (input.doubles != nullptr) doubles.push_back(input.doubles[place]);
  ids.push_back(place);
}

template <int D>
std::optional<Statistics> GroupedSearch<D>::Gathered::search(Searcher<D>& searcher,
                                                             const SearchInput<D>& input,
                                                             std::size_t left_count, const Workers& workers,
                                                             PairSink& pairs, FilterTest test,
                                                             const BoxFilters* filters) {
  const std::size_t observed = kernels::is_observing ? kernels::observed_tests().size() : 0;
  const SearchInput<D> of_these{.boxes = boxes,
                                .left_count = left_count,
                                .doubles = input.doubles == nullptr ? nullptr : doubles.data(),
                                .successor = input.successor,
                                .workers = workers};
  return core::search_through(core::PassingSink(PassOfGroups{ids, left_count, test, filters}, pairs),
                              [&](PairSink& sink) {
                                const auto statistics = searcher.search(of_these, sink);
                                if constexpr (kernels::is_observing)
                                  kernels::rename_observed_tests(observed, ids);
                                return statistics;
                              });
}

/// What one thread needs to search one group after the other.
template <int D>
struct GroupedSearch<D>::Worker {
  std::unique_ptr<Searcher<D>> searcher;  // null until it is needed
  Gathered gathered;
  kernels::RunBuffer<D> run;       // of few boxes: all, or the right set
  kernels::RunBuffer<D> left_run;  // the left set
};

template <int D>
GroupedSearch<D>::GroupedSearch() = default;
template <int D>
GroupedSearch<D>::~GroupedSearch() = default;

template <int D>
std::optional<Statistics> GroupedSearch<D>::search(Searcher<D>& searcher, const SearchInput<D>& input,
                                                   const BoxFilters& filters, PairSink& pairs,
                                                   const MakeAnother& make_another) {
  searches_ = 1;
  has_compared_all_ = false;
  has_sorted_ = sort_by_group(input, filters, make_another != nullptr);
  if (has_sorted_) return search_each_group(searcher, input, pairs, make_another);
  if (!is_grouped(input, filters)) return search_all(searcher, input, filters, pairs);
  searches_ = plan_.searches().size();
  std::optional<Statistics> sum = Statistics{};
  Checkpoint checkpoint(input.workers.checkpoint);
  for (const PlannedSearch& planned : plan_.searches()) {
    const std::optional<Statistics> some = run(planned, searcher, input, filters, pairs);
    // Each search counts for a checkpoint of its own, which many small searches never reach.
    checkpoint.count(gathered_.boxes.size() + (some ? some->tests : 0));
    if (!some || !sum) {
      sum.reset();
      continue;
    }
    core::add(*sum, *some);
  }
  return sum;
}

/// Sorts the boxes by group, if boxes accept only others of their positive group. Sets sorted_ and
/// sorted_groups_. `has_others`: whether each thread can have a searcher.
template <int D>
bool GroupedSearch<D>::sort_by_group(const SearchInput<D>& input, const BoxFilters& filters,
                                     bool has_others) {
  const auto accepts_group_alone = [](const Filter& filter) {
    return has_no_bits(filter) && !filter.is_static;
  };
  const std::size_t boxes = input.boxes.size();
  if (boxes <= max_ungrouped_boxes || !accepts_group_alone(filters[0])) return false;
  parallel_.start(has_others ? input.workers : Workers{.checkpoint = input.workers.checkpoint}, boxes);
  const std::span<core::KeyedPlace> places = order_.places(boxes);
  std::atomic<bool> do_all = true;
  const auto take_groups = [&](const auto& by_place) {
    parallel_.for_ranges(boxes, [&](core::Range range, std::size_t) {
      bool do_these = true;
      for (std::size_t i = range.begin; i < range.end; ++i) {
        const Filter& filter = by_place[i];
        do_these &= accepts_group_alone(filter);
        places[i] = {static_cast<std::uint32_t>(std::max(filter.group, 0)), static_cast<std::uint32_t>(i)};
      }
      if (!do_these) do_all.store(false, std::memory_order_relaxed);
    });
  };
  if (filters.array() != nullptr)
    take_groups(filters.array());
  else
    take_groups(filters);
  if (!do_all) return false;
  sorted_ = order_.sort(parallel_);
  sorted_groups_.clear();
  for (std::size_t begin = 0; begin < boxes;) {
    const std::uint32_t group = sorted_[begin].key;
    std::size_t end = begin + 1;
    while (end < boxes && sorted_[end].key == group) ++end;
    const bool has_pairs = input.left_count == 0 ? end - begin > 1
                                                 : sorted_[begin].place < input.left_count &&
                                                       sorted_[end - 1].place >= input.left_count;
    if (group != 0 && has_pairs) sorted_groups_.push_back({begin, end});
    begin = end;
  }
  return true;
}

/// Searches each of sorted_groups_ by itself. Threads share the groups; all of them search a large one.
template <int D>
std::optional<Statistics> GroupedSearch<D>::search_each_group(Searcher<D>& searcher,
                                                              const SearchInput<D>& input, PairSink& pairs,
                                                              const MakeAnother& make_another) {
  const std::size_t groups = sorted_groups_.size();
  const std::size_t boxes = input.boxes.size();
  searches_ = groups;
  if (groups == 1 && sorted_groups_[0].size() == boxes) return searcher.search(input, pairs);
  const std::size_t workers = parallel_.workers();
  while (workers_.size() < workers) workers_.push_back(std::make_unique<Worker>());
  const auto is_large = [&](std::size_t group) {
    const std::size_t size = sorted_groups_[group].size();
    return workers > 1 && size > boxes / (large_groups_per_share * workers) &&
           size >= 2 * input.workers.boxes_per_thread;
  };
  std::atomic<bool> do_count = true;
  const auto search = [&](std::size_t group, std::size_t number, const Workers& threads, PairSink& sink) {
    Worker& worker = *workers_[number];
    if (number > 0 && !worker.searcher) worker.searcher = make_another();
    Searcher<D>& its_searcher = number > 0 ? *worker.searcher : searcher;
    const auto statistics = search_group(sorted_groups_[group], its_searcher, input, threads, worker, sink);
    if (!statistics) do_count.store(false, std::memory_order_relaxed);
    return statistics.value_or(Statistics{});
  };
  const Workers one_thread = parallel_.within_part();
  const Workers& threads = workers > 1 ? one_thread : input.workers;
  Statistics sum;
  for (std::size_t group = 0; group < groups;) {
    std::size_t end = group;
    while (end < groups && !is_large(end)) ++end;
    core::add(sum,
              parallel_.search(end - group, pairs, [&](core::Range some, std::size_t number, PairSink& sink) {
                Statistics of_these;
                for (std::size_t i = some.begin; i < some.end; ++i)
                  core::add(of_these, search(group + i, number, threads, sink));
                return of_these;
              }));
    if (end < groups) core::add(sum, search(end++, 0, input.workers, pairs));
    group = end;
  }
  return do_count ? std::optional(sum) : std::nullopt;
}

/// Searches one of sorted_groups_. Few boxes are compared, whichever the algorithm.
template <int D>
std::optional<Statistics> GroupedSearch<D>::search_group(core::Range group, Searcher<D>& searcher,
                                                         const SearchInput<D>& input, const Workers& workers,
                                                         Worker& worker, PairSink& pairs) {
  const std::span<const core::KeyedPlace> places = sorted_.subspan(group.begin, group.size());
  const auto left_end = std::partition_point(
      places.begin(), places.end(), [&](core::KeyedPlace at) { return at.place < input.left_count; });
  const auto left_count = static_cast<std::size_t>(left_end - places.begin());
  const bool is_last = group.end == sorted_groups_.back().end;
  if (are_few(places.size(), left_count)) {
    if (is_last) has_compared_all_ = true;
    const auto run_of = [&](std::span<const core::KeyedPlace> some, kernels::RunBuffer<D>& run) {
      run.clear();
      run.reserve(some.size());
      for (const core::KeyedPlace at : some) run.append(input.boxes[at.place], BoxId{at.place});
      return run.view(input.doubles);
    };
    const kernels::Run<D> run = run_of(places.subspan(left_count), worker.run);
    const std::uint64_t tests =
        left_count == 0 ? kernels::compare_all(run, pairs)
                        : kernels::compare_all(run_of(places.first(left_count), worker.left_run), run, pairs);
    return Statistics{.tests = tests, .references = places.size()};
  }
  worker.gathered.clear();
  for (const core::KeyedPlace at : places) worker.gathered.add(input, BoxId{at.place});
  const auto statistics = worker.gathered.search(searcher, input, left_count, workers, pairs);
  if (is_last) explanation_ = searcher.explanation();
  return statistics;
}

/// Decides whether to search by groups and, if so, plans it.
template <int D>
bool GroupedSearch<D>::is_grouped(const SearchInput<D>& input, const BoxFilters& filters) {
  const std::size_t boxes = input.boxes.size();
  if (boxes <= max_ungrouped_boxes || !sample(input, filters)) return false;
  if (!groups_.build(filters, boxes, input.left_count)) return false;
  rejected_groups_.clear();
  for (const auto& [a, b] : rejected_)
    rejected_groups_.emplace_back(groups_.group_of(a), groups_.group_of(b));
  const double rejected = static_cast<double>(rejected_.size()) * weight_;
  const double cost_of_all = static_cast<double>(boxes) * PlanCosts::box + PlanCosts::search + rejected;
  return plan_.make(groups_.groups(), input.left_count != 0, rejected_groups_, weight_) &&
         plan_.cost() < cost_of_all / (plan_.searches().size() > 1 ? min_gain : 1);
}

/// Compares a sample of the n boxes with each other, in at most n / 2 tests. Sets rejected_ and weight_, and
/// returns whether grouping may pay.
template <int D>
bool GroupedSearch<D>::sample(const SearchInput<D>& input, const BoxFilters& filters) {
  const std::size_t boxes = input.boxes.size();
  const auto root = static_cast<std::size_t>(std::sqrt(static_cast<double>(boxes)));
  const std::size_t count = std::min(root, max_sample);
  weight_ = static_cast<double>(boxes) * static_cast<double>(boxes) / static_cast<double>(count * count);
  sample_.clear();
  rejected_.clear();
  std::size_t lonely = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = core::sampled_place(i, boxes);
    const SampledBox next{place, input.boxes[place], filters[place]};
    for (const SampledBox& other : sample_) {
      if (input.left_count != 0 && (other.place < input.left_count) == (place < input.left_count)) continue;
      if (!accepts(other.filter, next.filter) && overlap(other.box, next.box))
        rejected_.emplace_back(other.place, place);
    }
    sample_.push_back(next);
    lonely += static_cast<std::size_t>(is_lonely(next.filter));
  }
  return static_cast<double>(rejected_.size()) * weight_ >= rejected_per_box * static_cast<double>(boxes) ||
         lonely * boxes_per_lonely_box >= count;
}

template <int D>
std::optional<Statistics> GroupedSearch<D>::search_all(Searcher<D>& searcher, const SearchInput<D>& input,
                                                       const BoxFilters& filters, PairSink& pairs) {
  const auto search_accepted = [&](auto accepted) {
    return core::search_through(core::PassingSink(accepted, pairs),
                                [&](PairSink& sink) { return searcher.search(input, sink); });
  };
  return filters.array() != nullptr ? search_accepted(PassAccepted<const Filter*>{filters.array()})
                                    : search_accepted(PassAccepted<BoxFilters>{filters});
}

template <int D>
std::optional<Statistics> GroupedSearch<D>::run(const PlannedSearch& planned, Searcher<D>& searcher,
                                                const SearchInput<D>& input, const BoxFilters& filters,
                                                PairSink& pairs) {
  gathered_.clear();
  gather(input, plan_.groups(planned));
  const std::size_t left_count = planned.middle == planned.end ? 0 : gathered_.boxes.size();
  gather(input, plan_.others(planned));
  has_compared_all_ = compares_all(left_count);
  return gathered_.search(has_compared_all_ ? *brute_force_ : searcher, input, left_count, input.workers,
                          pairs, planned.test, &filters);
}

template <int D>
void GroupedSearch<D>::gather(const SearchInput<D>& input, std::span<const std::uint32_t> groups) {
  for (const std::uint32_t group : groups) {
    for (const BoxId place : groups_.places(group)) gathered_.add(input, place);
  }
}

/// Whether to search the gathered boxes by brute force. If so, brute_force_ is set.
template <int D>
bool GroupedSearch<D>::compares_all(std::size_t left_count) {
  if (!are_few(gathered_.boxes.size(), left_count)) return false;
  if (!brute_force_) {
    if (const Algorithm* const algorithm = find_algorithm("brute_force"))
      brute_force_ =
          algorithm::searcher<D>(*algorithm, algorithm::settings_of(*algorithm, {algorithm->name}));
  }
  return brute_force_ != nullptr;
}

template <int D>
std::string GroupedSearch<D>::explanation(const Searcher<D>& searcher) const {
  std::string text = has_compared_all_
                         ? "brute_force, since comparing so few pairs of boxes costs less than any structure"
                     : has_sorted_ && searches_ != 1 ? explanation_
                                                     : searcher.explanation();
  if (!text.empty() && searches_ > 1)
    text += "; the last of " + std::to_string(searches_) +
            " searches, each of boxes whose filters accept each other";
  return text;
}

template class GroupedSearch<2>;
template class GroupedSearch<3>;

}  // namespace broadside::find
