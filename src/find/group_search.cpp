// GroupSearch: finds the pairs of boxes that accept only others of their own positive group.
#include "find/group_search.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <numeric>

#include "core/filter_sink.hpp"
#include "core/prefix_sum.hpp"
#include "core/radix_sort.hpp"
#include "kernels/observed_tests.hpp"
#include "kernels/sweep.hpp"

namespace broadside::find {
namespace {

/// Up to this number of pairs of boxes per box, comparing them all costs less than any structure.
constexpr std::size_t compared_per_box = 128;

/// A bucket with more than 1 / large_buckets_per_share of a thread's share of all boxes, and at least two
/// threads' minimum, is searched by all threads.
constexpr std::size_t large_buckets_per_share = 4;

/// The groups of a range of boxes.
struct GroupExtent {
  std::uint32_t before_first = ~std::uint32_t{0};  // the lowest positive group - 1
  std::uint32_t last = 0;
  bool is_suitable = true;  // whether boxes accept only others of their own positive group
  bool has_lonely = false;  // whether a box is in no positive group
};

/// Whether these are few numbers, all different.
bool are_few_and_differ(std::span<const std::uint32_t> numbers) {
  constexpr std::size_t few = 8;
  if (numbers.size() > few) return false;
  for (auto at = numbers.begin(); at != numbers.end(); ++at) {
    if (std::find(numbers.begin(), at, *at) != at) return false;
  }
  return true;
}

}  // namespace

bool are_few(std::size_t boxes, std::size_t left_count) noexcept {
  const std::uint64_t all = boxes;
  const std::uint64_t compared = left_count == 0 ? all * (all - 1) / 2 : left_count * (all - left_count);
  return compared <= compared_per_box * all;
}

/// What one thread needs to search one bucket after the other.
template <int D>
struct GroupSearch<D>::Worker {
  std::unique_ptr<Searcher<D>> own_searcher;  // null until it is needed
  Searcher<D>* searcher = nullptr;            // its own or, in the calling thread, the given one
  kernels::RunBuffer<D> run;                  // of few boxes: all, or the right set
  kernels::RunBuffer<D> left_run;             // the left set
  core::RadixSort order;                      // of a bucket of several groups
  Copies copies;                              // one of these groups
};

template <int D>
void GroupSearch<D>::Copies::renew(std::size_t count, bool has_doubles) {
  core::renew(boxes, count);
  core::renew(doubles, has_doubles ? count : 0);
  core::renew(ids, count);
}

template <int D>
GroupSearch<D>::GroupSearch() = default;
template <int D>
GroupSearch<D>::~GroupSearch() = default;

template <int D>
bool GroupSearch<D>::sort(const SearchInput<D>& input, const BoxFilters& filters, bool shares_groups) {
  const auto accepts_group_alone = [](const Filter& filter) {
    return has_no_bits(filter) && !filter.is_static;
  };
  const std::size_t boxes = input.boxes.size();
  if (boxes == 0 || !accepts_group_alone(filters[0])) return false;
  parallel_.start(shares_groups ? input.workers : Workers{.checkpoint = input.workers.checkpoint}, boxes);
  core::renew(groups_, boxes);
  std::vector<GroupExtent> extents(parallel_.range_count());
  const auto take = [&](const auto& by_place) {
    parallel_.for_numbered_ranges(boxes, [&](std::size_t number, core::Range range, std::size_t) {
      GroupExtent extent;
      for (std::size_t i = range.begin; i < range.end; ++i) {
        const Filter filter = by_place[i];  // a copy, since another thread may change the caller's
        const auto group = static_cast<std::uint32_t>(std::max(filter.group, 0));
        groups_[i] = group;
        extent.before_first = std::min(extent.before_first, group - 1);
        extent.last = std::max(extent.last, group);
        extent.is_suitable &= accepts_group_alone(filter);
        extent.has_lonely |= group == 0;
      }
      extents[number] = extent;
    });
  };
  if (filters.array() != nullptr)
    take(filters.array());
  else
    take(filters);
  GroupExtent all;
  for (const GroupExtent& extent : extents) {
    all.before_first = std::min(all.before_first, extent.before_first);
    all.last = std::max(all.last, extent.last);
    all.is_suitable &= extent.is_suitable;
    all.has_lonely |= extent.has_lonely;
  }
  if (!all.is_suitable) return false;
  first_group_ = all.before_first + 1;
  is_one_group_ = first_group_ == all.last && !all.has_lonely;
  buckets_ = 0;
  if (is_one_group_ || all.last == 0) return true;
  // More would take longer to count than boxes to sort.
  const std::size_t max_buckets = std::max<std::size_t>(boxes / parallel_.range_count(), 1);
  for (shift_ = 0; bucket_of(all.last) >= max_buckets;) ++shift_;
  buckets_ = bucket_of(all.last) + 1;
  scatter(input);
  return true;
}

/// Copies boxes of positive groups to sorted_, bucket by bucket.
template <int D>
void GroupSearch<D>::scatter(const SearchInput<D>& input) {
  const std::size_t boxes = input.boxes.size();
  counts_.assign(parallel_.range_count() * buckets_, 0);
  const auto for_each = [&](const auto& body) {
    parallel_.for_numbered_ranges(boxes, [&](std::size_t number, core::Range range, std::size_t) {
      std::uint32_t* const counts = &counts_[number * buckets_];
      for (std::size_t i = range.begin; i < range.end; ++i) {
        if (groups_[i] != 0) body(i, counts[bucket_of(groups_[i])]++);
      }
    });
  };
  for_each([](std::size_t, std::uint32_t) {});
  const std::size_t count = core::prefix_sum(std::span(counts_), buckets_);
  sorted_.renew(count, input.doubles != nullptr);
  core::renew(sorted_groups_, shift_ > 0 ? count : 0);
  for_each([&](std::size_t i, std::uint32_t to) {
    sorted_.boxes[to] = input.boxes[i];
    sorted_.ids[to] = BoxId(i);
    if (input.doubles != nullptr) sorted_.doubles[to] = input.doubles[i];
    if (shift_ > 0) sorted_groups_[to] = groups_[i];
  });
}

/// The range of a bucket in sorted_.
template <int D>
core::Range GroupSearch<D>::bucket(std::size_t number) const noexcept {
  // What scatter() has left of the last range's counts is where buckets end.
  const std::uint32_t* const ends = &counts_[counts_.size() - buckets_];
  return {number == 0 ? 0 : ends[number - 1], ends[number]};
}

template <int D>
std::optional<Statistics> GroupSearch<D>::search(Searcher<D>& searcher, const SearchInput<D>& input,
                                                 PairSink& pairs, const MakeAnother& make_another) {
  if (is_one_group_) {
    searches_ = 1;
    const auto statistics = searcher.search(input, pairs);
    explanation_ = searcher.explanation();
    return statistics;
  }
  searches_of_.assign(buckets_, 0);
  explanation_.reset();
  const std::size_t workers = parallel_.workers();
  while (workers_.size() < workers) workers_.push_back(std::make_unique<Worker>());
  const auto is_large = [&](std::size_t number) {
    const std::size_t size = bucket(number).size();
    return workers > 1 && size > sorted_.ids.size() / (large_buckets_per_share * workers) &&
           size >= 2 * input.workers.boxes_per_thread;
  };
  std::atomic<bool> do_count = true;
  const auto search_one = [&](std::size_t number, std::size_t thread, const Workers& its_workers,
                              PairSink& sink) {
    if (bucket(number).size() < 2) return Statistics{};
    Worker& worker = *workers_[thread];
    if (thread > 0 && !worker.own_searcher) worker.own_searcher = make_another();
    worker.searcher = thread > 0 ? worker.own_searcher.get() : &searcher;
    const auto statistics = search_bucket(number, input, its_workers, worker, sink);
    if (!statistics) do_count.store(false, std::memory_order_relaxed);
    return statistics.value_or(Statistics{});
  };
  const Workers one_thread = parallel_.within_part();
  const Workers& of_a_part = workers > 1 ? one_thread : input.workers;
  Statistics all;
  for (std::size_t begin = 0; begin < buckets_;) {
    std::size_t end = begin;
    while (end < buckets_ && !is_large(end)) ++end;
    const auto search_some = [&](core::Range some, std::size_t thread, PairSink& sink) {
      Statistics of_these;
      for (std::size_t number = begin + some.begin; number < begin + some.end; ++number)
        core::add(of_these, search_one(number, thread, of_a_part, sink));
      return of_these;
    };
    core::add(all, parallel_.search(end - begin, pairs, search_some));
    if (end < buckets_) core::add(all, search_one(end++, 0, input.workers, pairs));
    begin = end;
  }
  searches_ = std::accumulate(searches_of_.begin(), searches_of_.end(), std::size_t{0});
  return do_count ? std::optional(all) : std::nullopt;
}

template <int D>
std::optional<Statistics> GroupSearch<D>::search_bucket(std::size_t number, const SearchInput<D>& input,
                                                        const Workers& workers, Worker& worker,
                                                        PairSink& pairs) {
  const core::Range range = bucket(number);
  searches_of_[number] = 0;
  std::optional<Statistics> all = Statistics{};
  const auto search_one = [&](const Copies& copies, core::Range group, bool is_last) {
    const std::span<const BoxId> ids = std::span(copies.ids).subspan(group.begin, group.size());
    const SearchInput<D> of_group{
        .boxes = std::span(copies.boxes).subspan(group.begin, group.size()),
        // Ids ascend, so boxes of the left set come first.
        .left_count = static_cast<std::size_t>(std::lower_bound(ids.begin(), ids.end(), input.left_count) -
                                               ids.begin()),
        .doubles = input.doubles == nullptr ? nullptr : &copies.doubles[group.begin],
        .successor = input.successor,
        .workers = workers};
    const bool has_pairs =
        input.left_count == 0 ? ids.size() > 1 : of_group.left_count > 0 && of_group.left_count < ids.size();
    if (!has_pairs) return;
    ++searches_of_[number];
    if (are_few(ids.size(), of_group.left_count)) {
      if (all) core::add(*all, compare(of_group, ids, input.doubles, worker, pairs));
      return;
    }
    const std::size_t observed = kernels::is_observing ? kernels::observed_tests().size() : 0;
    const auto some = core::search_through(
        core::PassingSink(core::Rename{ids, of_group.left_count}, pairs), [&](PairSink& renamed) {
          const auto statistics = worker.searcher->search(of_group, renamed);
          if constexpr (kernels::is_observing) kernels::rename_observed_tests(observed, ids);
          return statistics;
        });
    if (is_last) explanation_ = worker.searcher->explanation();
    if (some && all)
      core::add(*all, *some);
    else
      all.reset();
  };
  const bool is_last = number + 1 == buckets_;
  if (shift_ == 0) {
    search_one(sorted_, range, is_last);
    return all;
  }
  // If there are about as many groups as boxes, few buckets have two boxes of one group.
  if (are_few_and_differ(std::span(sorted_groups_).subspan(range.begin, range.size()))) return all;
  const std::span<core::KeyedPlace> places = worker.order.places(range.size());
  for (std::size_t i = 0; i < range.size(); ++i)
    places[i] = {sorted_groups_[range.begin + i], static_cast<std::uint32_t>(range.begin + i)};
  const std::span<const core::KeyedPlace> order = worker.order.sort();
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() && order[end].key == order[begin].key) ++end;
    const std::size_t count = end - begin;
    if (count > 1) {
      worker.copies.renew(count, input.doubles != nullptr);
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t from = order[begin + i].place;
        worker.copies.boxes[i] = sorted_.boxes[from];
        worker.copies.ids[i] = sorted_.ids[from];
        if (input.doubles != nullptr) worker.copies.doubles[i] = sorted_.doubles[from];
      }
      search_one(worker.copies, {0, count}, is_last && end == order.size());
    }
    begin = end;
  }
  return all;
}

/// Compares the few boxes of one group, or of the two sides of it. `doubles` are those of all boxes.
template <int D>
Statistics GroupSearch<D>::compare(const SearchInput<D>& group, std::span<const BoxId> ids,
                                   const Box<D, double>* doubles, Worker& worker, PairSink& pairs) {
  const auto run_of = [&](std::size_t begin, std::size_t end, kernels::RunBuffer<D>& run) {
    run.clear();
    run.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) run.append(group.boxes[i], ids[i]);
    return run.view(doubles);
  };
  const kernels::Run<D> run = run_of(group.left_count, ids.size(), worker.run);
  const std::uint64_t tests =
      group.left_count == 0 ? kernels::compare_all(run, pairs)
                            : kernels::compare_all(run_of(0, group.left_count, worker.left_run), run, pairs);
  return {.tests = tests, .references = ids.size()};
}

template class GroupSearch<2>;
template class GroupSearch<3>;

}  // namespace broadside::find
