// Search: absent boxes, two sets in one, doubles and filters around a Searcher.
#include "find/search.hpp"

#include <atomic>
#include <cstdint>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "algorithms/registry.hpp"
#include "core/filter_sink.hpp"
#include "core/input_check.hpp"
#include "core/message.hpp"
#include "core/pair_set.hpp"
#include "core/parallel.hpp"
#include "kernels/observed_tests.hpp"

namespace broadside::find {
namespace {

/// Passes on pairs between the first `left_count` boxes and the others, as places in these two sets.
struct PassBetween {
  bool operator()(Pair pair, Pair& to) const {
    to = {pair.first, BoxId{index(pair.second) - left_count}};
    return index(pair.first) < left_count && index(pair.second) >= left_count;
  }

  std::uint32_t left_count;
};

/// Passes on the pairs that are not ignored.
struct PassNotIgnored {
  bool operator()(Pair pair, Pair& to) const {
    to = pair;
    return !ignored->contains(pair);
  }

  const core::PairSet* ignored;
};

/// Passes on pairs of two different boxes below `boxes`; throws for any other pair.
class IdCheck final : public core::FilterSink {
 public:
  IdCheck(std::size_t boxes, PairSink& target) : FilterSink(target), boxes_(boxes) {}

  std::unique_ptr<FilterSink> onto(PairSink& target) const override {
    return std::make_unique<IdCheck>(boxes_, target);
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    for (const Pair pair : pairs) {
      if (index(pair.first) < index(pair.second) && index(pair.second) < boxes_) continue;
      throw std::logic_error(
          core::message({"a searcher wrote the pair (", index(pair.first), ", ", index(pair.second), ") of ",
                         boxes_, " boxes; expected two different ids below ", boxes_}));
    }
    target().put(pairs);
  }

  std::size_t boxes_;
};

template <int D>
class CheckedSearcher final : public Searcher<D> {
 public:
  explicit CheckedSearcher(std::unique_ptr<Searcher<D>> searcher) : searcher_(std::move(searcher)) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    return core::search_through(IdCheck(input.boxes.size(), pairs),
                                [&](PairSink& sink) { return searcher_->search(input, sink); });
  }

  std::string explanation() const override { return searcher_->explanation(); }

 private:
  std::unique_ptr<Searcher<D>> searcher_;
};

}  // namespace

template <int D>
std::unique_ptr<Searcher<D>> checked(std::unique_ptr<Searcher<D>> searcher) {
  return std::make_unique<CheckedSearcher<D>>(std::move(searcher));
}

template <int D>
Searchers<D> searchers_of(const Algorithm& algorithm, Settings settings) {
  const bool is_checked = algorithm.kind == AlgorithmKind::own && !algorithm::is_linked(algorithm.name);
  std::unique_ptr<Searcher<D>> first = algorithm::searcher<D>(algorithm, settings);
  if (is_checked) first = checked(std::move(first));
  auto make_another = [make = algorithm.in<D>().searcher, is_checked, settings = std::move(settings)] {
    std::unique_ptr<Searcher<D>> searcher = make(settings);
    return is_checked ? checked(std::move(searcher)) : std::move(searcher);
  };
  return {std::move(first), std::move(make_another), algorithm.tests_doubles};
}

template <int D, typename Real>
std::size_t Search<D, Real>::check_and_count_absent(std::span<const Box<D, Real>> boxes,
                                                    const Workers& workers, BadInput bad_input,
                                                    const char* which) {
  if (workers.threads == 1) return core::check_boxes(boxes, 0, bad_input, which);
  core::Parallel parallel;
  parallel.start(workers, boxes.size());
  std::atomic<std::size_t> absent = 0;
  parallel.for_ranges(boxes.size(), [&](core::Range range, std::size_t) {
    absent.fetch_add(core::check_boxes(boxes.first(range.end), range.begin, bad_input, which),
                     std::memory_order_relaxed);
  });
  return absent;
}

template <int D, typename Real>
Search<D, Real>::Search(Searchers<D> searchers)
    : searchers_(std::move(searchers)), doubles_(searchers_.tests_doubles) {}

template <int D, typename Real>
std::string Search<D, Real>::explanation() const {
  return is_filtered_ ? groups_->explanation(*searchers_.first) : searchers_.first->explanation();
}

template <int D, typename Real>
bool Search<D, Real>::round(std::span<const Box<D, Real>> boxes, const Workers& workers) {
  if constexpr (std::is_same_v<Real, float>)
    return false;
  else
    return doubles_.round(boxes, 0, workers);
}

template <int D, typename Real>
std::optional<Statistics> Search<D, Real>::find(std::span<const Box<D, Real>> boxes,
                                                const SearchOptions<D>& options, PairSink& pairs) {
  const core::PairSet* const ignored = core::PairSet::of(options.filters.ignored);
  if (ignored == nullptr) return find_within(boxes, options, pairs);
  return core::search_through(core::PassingSink(PassNotIgnored{ignored}, pairs),
                              [&](PairSink& sink) { return find_within(boxes, options, sink); });
}

template <int D, typename Real>
std::optional<Statistics> Search<D, Real>::find_within(std::span<const Box<D, Real>> boxes,
                                                       const SearchOptions<D>& options, PairSink& pairs) {
  const std::span<const Filter> filters = options.filters.filters;
  const std::size_t absent =
      options.absent ? *options.absent : check_and_count_absent(boxes, options.workers, BadInput::quarantine);
  if (absent == 0) return search_present(boxes, 0, options, BoxFilters(filters), pairs);
  present_.clear();
  ids_.clear();
  take_present(boxes);
  const std::size_t observed = kernels::is_observing ? kernels::observed_tests().size() : 0;
  return core::search_through(core::PassingSink(core::Rename{ids_, 0}, pairs), [&](PairSink& renamed) {
    const std::optional<Statistics> statistics =
        search_present(present_, 0, options, BoxFilters(filters, ids_), renamed);
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
    present_.reserve(left.size() + right.size());
    present_.insert(present_.end(), left.begin(), left.end());
    present_.insert(present_.end(), right.begin(), right.end());
    return find_across(present_, left.size(), options, pairs);
  }
  take_present(left);
  const std::size_t left_count = present_.size();
  take_present(right);
  if (left_count == 0 || left_count == present_.size()) return nothing_found();
  const BoxFilters filters(options.filters.filters, options.filters.right_filters, left_count, ids_);
  return core::search_through(
      core::PassingSink(core::Rename{ids_, left_count}, pairs),
      [&](PairSink& renamed) { return search_present(present_, left_count, options, filters, renamed); });
}

template <int D, typename Real>
std::optional<Statistics> Search<D, Real>::find_across(std::span<const Box<D, Real>> boxes,
                                                       std::size_t left_count,
                                                       const SearchOptions<D>& options, PairSink& pairs) {
  if (options.absent != 0)
    return find_between(boxes.first(left_count), boxes.subspan(left_count), options, pairs);
  if (left_count == 0 || left_count == boxes.size()) return nothing_found();
  const BoxFilters filters(options.filters.filters, options.filters.right_filters, left_count);
  return core::search_through(
      core::PassingSink(PassBetween{static_cast<std::uint32_t>(left_count)}, pairs),
      [&](PairSink& crossing) { return search_present(boxes, left_count, options, filters, crossing); });
}

/// Searches boxes that are all present.
template <int D, typename Real>
std::optional<Statistics> Search<D, Real>::search_present(std::span<const Box<D, Real>> boxes,
                                                          std::size_t left_count,
                                                          const SearchOptions<D>& options,
                                                          const BoxFilters& filters, PairSink& pairs) {
  const auto search_floats = [&](const SearchInput<D>& input, PairSink& sink) {
    return search_in_groups(input, filters, sink);
  };
  if constexpr (std::is_same_v<Real, float>) {
    return search_floats({boxes, left_count, nullptr, options.successor, options.workers}, pairs);
  } else {
    if (!options.are_rounded) doubles_.round(boxes, left_count, options.workers);
    return doubles_.search(boxes, left_count, options.successor, options.workers, options.is_exact, pairs,
                           search_floats);
  }
}

/// Searches boxes of floats that are all present, in groups if there are filters.
template <int D, typename Real>
std::optional<Statistics> Search<D, Real>::search_in_groups(const SearchInput<D>& input,
                                                            const BoxFilters& filters, PairSink& pairs) {
  const bool is_filtered = !filters.empty();
  if (is_filtered && !groups_) groups_ = std::make_unique<GroupedSearch<D>>();
  is_filtered_ = is_filtered;  // only now: explanation() relies on groups_
  Searcher<D>& searcher = *searchers_.first;
  if (!is_filtered) return searcher.search(input, pairs);
  return groups_->search(searcher, input, filters, pairs, searchers_.make_another);
}

/// Appends the present boxes to present_ and their places to ids_.
template <int D, typename Real>
void Search<D, Real>::take_present(std::span<const Box<D, Real>> boxes) {
  present_.reserve(present_.size() + boxes.size());
  ids_.reserve(ids_.size() + boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box<D, Real> box = boxes[i];  // a copy, since another thread may change the caller's
    if (!is_present(box)) continue;
    present_.push_back(box);
    ids_.push_back(BoxId(i));
  }
}

template std::unique_ptr<Searcher<2>> checked(std::unique_ptr<Searcher<2>>);
template std::unique_ptr<Searcher<3>> checked(std::unique_ptr<Searcher<3>>);
template Searchers<2> searchers_of<2>(const Algorithm&, Settings);
template Searchers<3> searchers_of<3>(const Algorithm&, Settings);
template class Search<2, float>;
template class Search<2, double>;
template class Search<3, float>;
template class Search<3, double>;

}  // namespace broadside::find
