// GroupedSearch: finds the pairs that filters accept, in groups of boxes that accept each other.
#include "find/grouped_search.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "broadside/algorithm.hpp"

#include "algorithms/registry.hpp"
#include "core/filter_sink.hpp"
#include "core/sample.hpp"
#include "kernels/observed_tests.hpp"

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

bool is_lonely(const Filter& filter) { return filter.group <= 0 && has_no_bits(filter); }

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
           (test == FilterTest::none || counts(filters[to.first], filters[to.second]));
  }

  bool counts(const Filter& a, const Filter& b) const {
    return accepts(a, b) && detail::bits_accept(a, b) == (test == FilterTest::by_bits);
  }

  std::span<const BoxId> ids;
  std::size_t left_count;
  FilterTest test;
  const BoxFilters& filters;
};

}  // namespace

template <int D>
std::optional<Statistics> GroupedSearch<D>::search(Searcher<D>& searcher, const SearchInput<D>& input,
                                                   const BoxFilters& filters, PairSink& pairs,
                                                   const typename GroupSearch<D>::MakeAnother& make_another) {
  searches_ = 1;
  has_compared_all_ = false;
  is_by_group_ =
      input.boxes.size() > max_ungrouped_boxes && by_group_.sort(input, filters, make_another != nullptr);
  if (is_by_group_) {
    const std::optional<Statistics> statistics = by_group_.search(searcher, input, pairs, make_another);
    searches_ = by_group_.searches();
    has_compared_all_ = !by_group_.explanation();
    return statistics;
  }
  if (!is_grouped(input, filters)) return search_all(searcher, input, filters, pairs);
  searches_ = plan_.searches().size();
  std::optional<Statistics> sum = Statistics{};
  Checkpoint checkpoint(input.workers.checkpoint);
  for (const PlannedSearch& planned : plan_.searches()) {
    const std::optional<Statistics> some = run(planned, searcher, input, filters, pairs);
    // Each search counts for a checkpoint of its own, which many small searches never reach.
    checkpoint.count(boxes_.size() + (some ? some->tests : 0));
    if (!some || !sum) {
      sum.reset();
      continue;
    }
    core::add(*sum, *some);
  }
  return sum;
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
  boxes_.clear();
  doubles_.clear();
  ids_.clear();
  gather(input, plan_.groups(planned));
  const std::size_t left_count = planned.middle == planned.end ? 0 : boxes_.size();
  gather(input, plan_.others(planned));
  const SearchInput<D> of_groups{.boxes = boxes_,
                                 .left_count = left_count,
                                 .doubles = input.doubles == nullptr ? nullptr : doubles_.data(),
                                 .successor = input.successor,
                                 .workers = input.workers};
  has_compared_all_ = compares_all(left_count);
  const std::size_t observed = kernels::is_observing ? kernels::observed_tests().size() : 0;
  return core::search_through(
      core::PassingSink(PassOfGroups{ids_, left_count, planned.test, filters}, pairs), [&](PairSink& sink) {
        const auto statistics = (has_compared_all_ ? *brute_force_ : searcher).search(of_groups, sink);
        if constexpr (kernels::is_observing) kernels::rename_observed_tests(observed, ids_);
        return statistics;
      });
}

template <int D>
void GroupedSearch<D>::gather(const SearchInput<D>& input, std::span<const std::uint32_t> groups) {
  for (const std::uint32_t group : groups) {
    for (const BoxId place : groups_.places(group)) {
      boxes_.push_back(input.boxes[place]);
      if (input.doubles != nullptr) doubles_.push_back(input.doubles[place]);
      ids_.push_back(place);
    }
  }
}

/// Whether to search the gathered boxes by brute force. If so, brute_force_ is set.
template <int D>
bool GroupedSearch<D>::compares_all(std::size_t left_count) {
  if (!are_few(boxes_.size(), left_count)) return false;
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
                     : is_by_group_ ? *by_group_.explanation()
                                    : searcher.explanation();
  if (!text.empty() && searches_ > 1)
    text += "; the last of " + std::to_string(searches_) +
            " searches, each of boxes whose filters accept each other";
  return text;
}

template class GroupedSearch<2>;
template class GroupedSearch<3>;

}  // namespace broadside::find
