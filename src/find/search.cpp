// Search: absent boxes, two sets in one, doubles and filters around a Searcher.
#include "find/search.hpp"

#include <algorithm>
#include <atomic>
#include <type_traits>
#include <utility>

#include "core/filter_sink.hpp"
#include "core/pair_set.hpp"
#include "core/parallel.hpp"
#include "kernels/observed_tests.hpp"

namespace broadside::find {
namespace {

/// Passes pairs on under other ids; between two sets, only pairs of a box of each. Within a set the ids
/// ascend with the places they stand for, so that its pairs stay ordered.
class RenamingSink final : public core::FilterSink {
 public:
  RenamingSink(std::span<const BoxId> ids, std::size_t left_count, PairSink& target)
      : FilterSink(target), ids_(ids), left_count_(left_count) {}

  std::unique_ptr<FilterSink> onto(PairSink& target) const override {
    return std::make_unique<RenamingSink>(ids_, left_count_, target);
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    pass_on(pairs, [this](Pair pair, Pair& to) {
      to = {ids_[index(pair.first)], ids_[index(pair.second)]};
      return left_count_ == 0 || (index(pair.first) < left_count_ && index(pair.second) >= left_count_);
    });
  }

  std::span<const BoxId> ids_;
  std::size_t left_count_;
};

/// Passes on pairs between the boxes before place `left_count` and the others, as places in those two sets.
class CrossingSink final : public core::FilterSink {
 public:
  CrossingSink(std::size_t left_count, PairSink& target)
      : FilterSink(target), left_count_(static_cast<std::uint32_t>(left_count)) {}

  std::unique_ptr<FilterSink> onto(PairSink& target) const override {
    return std::make_unique<CrossingSink>(left_count_, target);
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    pass_on(pairs, [this](Pair pair, Pair& to) {
      to = {pair.first, BoxId{index(pair.second) - left_count_}};
      return index(pair.first) < left_count_ && index(pair.second) >= left_count_;
    });
  }

  std::uint32_t left_count_;
};

/// Passes on the pairs that are not ignored.
class IgnoringSink final : public core::FilterSink {
 public:
  IgnoringSink(const core::PairSet& ignored, PairSink& target) : FilterSink(target), ignored_(&ignored) {}

  std::unique_ptr<FilterSink> onto(PairSink& target) const override {
    return std::make_unique<IgnoringSink>(*ignored_, target);
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    pass_on(pairs, [this](Pair pair, Pair& to) {
      to = pair;
      return !ignored_->contains(pair);
    });
  }

  const core::PairSet* ignored_;
};

/// A searcher behind filters.
template <int D>
class FilteredSearcher final : public Searcher<D> {
 public:
  FilteredSearcher(GroupedSearch<D>& groups, Searcher<D>& searcher, const BoxFilters& filters)
      : groups_(&groups), searcher_(&searcher), filters_(&filters) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    return groups_->search(*searcher_, input, *filters_, pairs);
  }

 private:
  GroupedSearch<D>* groups_;
  Searcher<D>* searcher_;
  const BoxFilters* filters_;
};

/// Calls search(sink) with a filter, and flushes the filter.
template <typename Sink, typename SearchInto>
std::optional<Statistics> through(Sink sink, const SearchInto& search) {
  const std::optional<Statistics> statistics = search(sink);
  sink.flush();
  return statistics;
}

template <int D, typename Real>
std::size_t count_absent(std::span<const Box<D, Real>> boxes, const Workers& workers) {
  core::Parallel parallel;
  parallel.start(workers, boxes.size());
  std::atomic<std::size_t> absent = 0;
  parallel.for_ranges(boxes.size(), [&](core::Range range, std::size_t) {
    std::size_t of_range = 0;
    for (std::size_t i = range.begin; i < range.end; ++i)
      of_range += static_cast<std::size_t>(!is_present(boxes[i]));
    absent.fetch_add(of_range, std::memory_order_relaxed);
  });
  return absent;
}

}  // namespace

template <int D, typename Real>
Search<D, Real>::Search(std::unique_ptr<Searcher<D>> searcher, bool tests_doubles)
    : searcher_(std::move(searcher)), doubles_(tests_doubles) {}

template <int D, typename Real>
std::string Search<D, Real>::explanation() const {
  return is_filtered_ ? groups_->explanation(*searcher_) : searcher_->explanation();
}

template <int D, typename Real>
std::optional<Statistics> Search<D, Real>::find(std::span<const Box<D, Real>> boxes,
                                                const SearchOptions<D>& options, PairSink& pairs) {
  const core::PairSet* const ignored = core::PairSet::of(options.filters.ignored);
  if (ignored == nullptr) return find_within(boxes, options, pairs);
  return through(IgnoringSink(*ignored, pairs),
                 [&](PairSink& sink) { return find_within(boxes, options, sink); });
}

template <int D, typename Real>
std::optional<Statistics> Search<D, Real>::find_within(std::span<const Box<D, Real>> boxes,
                                                       const SearchOptions<D>& options, PairSink& pairs) {
  const std::span<const Filter> filters = options.filters.filters;
  const std::size_t absent = options.absent ? *options.absent : count_absent(boxes, options.workers);
  if (absent == 0) return search_filtered(boxes, 0, options, BoxFilters(filters), pairs);
  present_.clear();
  ids_.clear();
  take_present(boxes);
  const std::size_t observed = kernels::is_observing ? kernels::observed_tests().size() : 0;
  return through(RenamingSink(ids_, 0, pairs), [&](PairSink& renamed) {
    const std::optional<Statistics> statistics =
        search_filtered(present_, 0, options, BoxFilters(filters, ids_), renamed);
    if constexpr (kernels::is_observing) kernels::rename_observed_tests(observed, ids_);
    return statistics;
  });
}

template <int D, typename Real>
std::optional<Statistics> Search<D, Real>::find_between(std::span<const Box<D, Real>> left,
                                                        std::span<const Box<D, Real>> right,
                                                        const SearchOptions<D>& options, PairSink& pairs) {
  present_.clear();
  ids_.clear();
  if (options.absent == 0) {
    core::reserve_large(present_, left.size() + right.size());
    present_.insert(present_.end(), left.begin(), left.end());
    present_.insert(present_.end(), right.begin(), right.end());
    return find_across(present_, left.size(), options, pairs);
  }
  take_present(left);
  const std::size_t left_count = present_.size();
  take_present(right);
  if (left_count == 0 || left_count == present_.size()) return nothing_found();
  const BoxFilters filters(options.filters.filters, options.filters.right_filters, left_count, ids_);
  return through(RenamingSink(ids_, left_count, pairs), [&](PairSink& renamed) {
    return search_filtered(present_, left_count, options, filters, renamed);
  });
}

template <int D, typename Real>
std::optional<Statistics> Search<D, Real>::find_across(std::span<const Box<D, Real>> boxes,
                                                       std::size_t left_count,
                                                       const SearchOptions<D>& options, PairSink& pairs) {
  if (options.absent != 0)
    return find_between(boxes.first(left_count), boxes.subspan(left_count), options, pairs);
  if (left_count == 0 || left_count == boxes.size()) return nothing_found();
  const BoxFilters filters(options.filters.filters, options.filters.right_filters, left_count);
  return through(CrossingSink(left_count, pairs), [&](PairSink& crossing) {
    return search_filtered(boxes, left_count, options, filters, crossing);
  });
}

/// Searches boxes that are all present, in groups if there are filters.
template <int D, typename Real>
std::optional<Statistics> Search<D, Real>::search_filtered(std::span<const Box<D, Real>> boxes,
                                                           std::size_t left_count,
                                                           const SearchOptions<D>& options,
                                                           const BoxFilters& filters, PairSink& pairs) {
  is_filtered_ = false;
  if (options.filters.filters.empty() && options.filters.right_filters.empty())
    return search_present(*searcher_, boxes, left_count, options, pairs);
  is_filtered_ = true;
  if (!groups_) groups_ = std::make_unique<GroupedSearch<D>>();
  FilteredSearcher<D> searcher(*groups_, *searcher_, filters);
  return search_present(searcher, boxes, left_count, options, pairs);
}

template <int D, typename Real>
std::optional<Statistics> Search<D, Real>::search_present(Searcher<D>& searcher,
                                                          std::span<const Box<D, Real>> boxes,
                                                          std::size_t left_count,
                                                          const SearchOptions<D>& options, PairSink& pairs) {
  if constexpr (std::is_same_v<Real, float>) {
    const SearchInput<D> input{boxes, left_count, nullptr, options.successor, options.workers};
    return searcher.search(input, pairs);
  } else {
    return doubles_.search(searcher, boxes, left_count, options.successor, options.workers, pairs);
  }
}

/// Appends the present ones of `boxes` to present_ and their places to ids_.
template <int D, typename Real>
void Search<D, Real>::take_present(std::span<const Box<D, Real>> boxes) {
  core::reserve_large(present_, present_.size() + boxes.size());
  ids_.reserve(ids_.size() + boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box<D, Real> box = boxes[i];  // a copy, since another thread may change the caller's
    if (!is_present(box)) continue;
    present_.push_back(box);
    ids_.push_back(BoxId(i));
  }
}

template class Search<2, float>;
template class Search<2, double>;
template class Search<3, float>;
template class Search<3, double>;

}  // namespace broadside::find
