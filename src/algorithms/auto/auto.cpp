// auto: chooses the algorithm that suits the boxes: by their number, by how the grid would sort them, by a
// sample.
//
// The rules depend on the boxes alone, never on a clock: the same boxes are always searched in the same way.
// auto_thresholds.hpp has their thresholds, and says where these come from.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "broadside/algorithm.hpp"
#include "broadside/debug/outline.hpp"

#include "algorithms/auto/auto_thresholds.hpp"
#include "algorithms/auto/clustering.hpp"
#include "algorithms/auto/segment_join.hpp"
#include "algorithms/follow_costs.hpp"
#include "algorithms/registry.hpp"
#include "core/filter_sink.hpp"
#include "core/number_text.hpp"
#include "core/sample.hpp"
#include "core/tunables.hpp"

namespace broadside::algorithm {
namespace {

/// The reason for a choice. chosen_algorithm has the algorithm for each.
enum class AutoReason {
  few,
  tile,
  uneven_tile,
  one_axis,
  intervals,
  one_place,
  dense,
  uneven_sets,
  clusters,
  cells
};

constexpr std::array<std::string_view, 10> chosen_algorithm = {
    "brute_force", "grid", "bvh", "sweep_and_prune", "sweep_and_prune", "sweep_and_prune", "bvh",
    "bvh",         "bvh",  "grid"};

/// The algorithm of a choice. A build without it uses the grid, which does well with most boxes: a grid of
/// one cell is a sweep.
const Algorithm& algorithm_of(AutoReason choice) {
  const Algorithm* const chosen = find_algorithm(chosen_algorithm[static_cast<std::size_t>(choice)]);
  return chosen != nullptr ? *chosen : *find_algorithm("grid");
}

/// The settings of a choice: the defaults, except that a sweep uses one axis, since a sweep in stripes cannot
/// give up.
Settings settings_of(const Algorithm& algorithm) {
  if (algorithm.name == "sweep_and_prune")
    return {SweepAndPruneOptions{.is_striped = false}, algorithm.tunables};
  return {Spec{algorithm.name, {}}, algorithm.tunables};
}

/// Finishes a search that gave up, with a segment tree.
template <int D>
class SegmentSuccessor final : public Successor<D> {
 public:
  using IsMissing = typename Successor<D>::IsMissing;

  /// Makes `join` when it is first needed. Later searches use its memory again.
  SegmentSuccessor(const SearchInput<D>& input, PairSink& pairs, std::unique_ptr<SegmentJoin<D>>& join)
      : input_(input), pairs_(pairs), join_(join) {}

  void finish(const IsMissing& is_missing) override {
    if (!join_) join_ = std::make_unique<SegmentJoin<D>>();
    Checkpoint checkpoint(input_.workers.checkpoint);
    work_ = core::search_through(
        core::PassingSink(PassMissing{is_missing, input_.boxes}, pairs_), [&](PairSink& missing) {
          return join_->join(input_.boxes, input_.left_count, input_.doubles, checkpoint, missing);
        });
  }

  /// What finish() did; empty if the search did not give up.
  const std::optional<Statistics>& work() const noexcept { return work_; }

 private:
  /// Passes on the pairs that the search did not write before it gave up.
  struct PassMissing {
    bool operator()(Pair pair, Pair& to) const {
      to = pair;
      return is_missing(boxes[index(pair.first)], pair.first, boxes[index(pair.second)], pair.second);
    }

    const IsMissing& is_missing;
    std::span<const Box<D>> boxes;
  };

  const SearchInput<D>& input_;
  PairSink& pairs_;
  std::unique_ptr<SegmentJoin<D>>& join_;
  std::optional<Statistics> work_;
};

/// Notes that a search has refused its boxes, which it does before it writes a pair. What takes over begins
/// when that search has returned.
template <int D>
class Refusal final : public Successor<D> {
 public:
  void finish(const typename Successor<D>::IsMissing&) override { is_refused_ = true; }
  bool is_refused() const noexcept { return is_refused_; }

 private:
  bool is_refused_ = false;
};

/// Chooses among searchers, and keeps those it has used.
template <int D>
class AutoSearcher final : public Searcher<D> {
  using Limits = AutoThresholds<D>;

 public:
  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    choose(input);
    has_handed_over_ = false;
    if (choice_ == AutoReason::few) {
      Refusal<D> refusal;
      const std::optional<Statistics> statistics = search_with_choice(input, refusal, true, pairs);
      if (!refusal.is_refused()) return statistics;
      choice_ = AutoReason::tile;
    }
    if (choice_ == AutoReason::tile) {
      Refusal<D> refusal;
      const std::optional<Statistics> statistics = search_with_choice(input, refusal, true, pairs);
      if (!refusal.is_refused()) return statistics;
      if (input.boxes.size() <= Limits::boxes_of_a_tile)
        take_sample(input.boxes);  // else it is taken already
      choice_ = tests_on_best_axis(input.boxes) <= Limits::tests_of_an_uneven_tiles_axis
                    ? AutoReason::one_axis
                    : AutoReason::uneven_tile;
    }
    SegmentSuccessor<D> successor(input, pairs, segments_);
    std::optional<Statistics> statistics = search_with_choice(input, successor, false, pairs);
    has_handed_over_ = successor.work().has_value();
    if (has_handed_over_) {
      statistics->tests += successor.work()->tests;
      statistics->references += successor.work()->references;
    }
    return statistics;
  }

  std::string explanation() const override {
    std::string text = reason();
    if (has_handed_over_)
      text +=
          "; it gave up, since its tests were far more than boxes and pairs account for, and a segment tree "
          "found the remaining pairs";
    return text;
  }

  Outline<D> lay_out(std::span<const Box<D>> boxes, const Workers& workers) {
    PairCounter none;
    search({boxes, 0, nullptr, nullptr, workers}, none);  // a tile shows only then whether it is refused
    const Algorithm& algorithm = algorithm_of(choice_);
    Outline<D> outline;
    if (const MakeOutline<D>& make = algorithm.in<D>().outline)
      outline = make(boxes, workers, settings_of(algorithm));
    outline.caption.insert(0, algorithm.name + (outline.caption.empty() ? "" : ": "));
    return outline;
  }

 private:
  std::string reason() const {
    const auto rounded = [](double number) { return core::text_of(std::trunc(number * 10) / 10); };
    std::string text = algorithm_of(choice_).name;
    text += ", since ";
    const std::string boxes = std::to_string(count_) + " boxes";
    switch (choice_) {
      case AutoReason::few:
        return text + boxes + " are so few that comparing all of them costs less than sorting them";
      case AutoReason::uneven_tile:
        return text + boxes + " are too uneven for cells of one size";
      case AutoReason::one_axis:
        return text + "a sweep along one axis leaves few tests per box: " + rounded(tests_) + " in a sample";
      case AutoReason::intervals:
        return text + boxes + " differ on one axis alone: a sweep along it tests little but pairs";
      case AutoReason::tile:
        return text + boxes + " fit in a core's cache, where sorting them into cells costs least";
      case AutoReason::dense:
        return text + "a box overlaps some " + rounded(overlaps_) + " others, which cells would only repeat";
      case AutoReason::uneven_sets:
        return text + "one set has only " + std::to_string(smaller_set_) + " of " + boxes +
               ": a tree passes over others that are far from these";
      case AutoReason::clusters:
        return text + "boxes form clusters: " + rounded(clustering_) +
               " times as many are near each other as evenly spread ones would be";
      case AutoReason::cells:
        return text + boxes + " spread as evenly as these suit cells";
      case AutoReason::one_place:
        return text + "a box overlaps some " + rounded(overlaps_) + " of " + boxes +
               ", so that separating them gains nothing";
    }
    return text;
  }

  std::optional<Statistics> search_with_choice(const SearchInput<D>& input, Successor<D>& successor,
                                               bool may_refuse, PairSink& pairs) {
    auto& chosen = searchers_[static_cast<std::size_t>(choice_)];
    if (!chosen) {
      const Algorithm& algorithm = algorithm_of(choice_);
      chosen = algorithm.in<D>().searcher(settings_of(algorithm));
    }
    return chosen->search(
        {input.boxes, input.left_count, input.doubles, &successor, input.workers, may_refuse}, pairs);
  }

  void choose(const SearchInput<D>& input) {
    count_ = input.boxes.size();
    smaller_set_ = std::min(input.left_count, count_ - input.left_count);
    choice_ = choice_for(input.boxes);
  }

  void take_sample(std::span<const Box<D>> boxes) {
    shift_ = core::sample_shift(boxes, Limits::hashed_boxes);
    sample_.take(boxes, Limits::sampled_boxes, shift_);
  }

  /// Sets tests_, by the sample.
  double tests_on_best_axis(std::span<const Box<D>> boxes) {
    const int best = sample_.axes_by_overlap()[0];
    tests_ = static_cast<double>(boxes.size()) * sample_[best].overlap / 2;
    return tests_;
  }

  AutoReason choice_for(std::span<const Box<D>> boxes) {
    if (boxes.size() <= Limits::few_boxes) return AutoReason::few;
    if (boxes.size() <= Limits::boxes_of_a_tile) return AutoReason::tile;
    take_sample(boxes);
    const auto count = static_cast<double>(boxes.size());
    if (tests_on_best_axis(boxes) <= Limits::tests_of_a_good_axis) return AutoReason::one_axis;
    overlaps_ = count / 2;
    for (int axis = 0; axis < D; ++axis) overlaps_ *= sample_[axis].overlap;
    if (overlaps_ >= tests_) return AutoReason::intervals;  // all boxes overlap on the other axes
    if (overlaps_ >= Limits::dense_pair_share * count / 2) return AutoReason::one_place;
    const bool is_tile = boxes.size() <= Limits::boxes_of_an_even_tile;
    if (overlaps_ >= (is_tile ? Limits::many_overlaps_in_a_tile : Limits::many_overlaps))
      return AutoReason::dense;
    if (smaller_set_ > 0 && static_cast<double>(smaller_set_) <= Limits::share_of_a_small_set * count)
      return AutoReason::uneven_sets;
    if (is_tile) return AutoReason::tile;
    std::array<float, D> reach;
    for (int axis = 0; axis < D; ++axis)
      reach[axis] = static_cast<float>(double{Limits::near} *
                                       (static_cast<double>(sample_[axis].high) - sample_[axis].low));
    clustering_ = clustering<D>(boxes, reach, shift_);
    return clustering_ >= Limits::clustered ? AutoReason::clusters : AutoReason::cells;
  }

  core::Sample<D> sample_;
  std::uint32_t shift_ = 0;                                                      // of the sample
  std::array<std::unique_ptr<Searcher<D>>, chosen_algorithm.size()> searchers_;  // null until chosen
  std::unique_ptr<SegmentJoin<D>> segments_;  // null until a search is handed over
  AutoReason choice_ = AutoReason::few;
  std::size_t count_ = 0;
  std::size_t smaller_set_ = 0;  // of a search between two sets
  bool has_handed_over_ = false;
  double tests_ = 0;
  double overlaps_ = 0;
  double clustering_ = 0;
};

/// An algorithm's follower with default settings, at the given costs.
template <int D>
FollowerChoice<D> follower_of(std::string_view name, const FollowCosts& costs, std::size_t max_boxes = 0) {
  const auto make = [name](const Settings&) -> std::unique_ptr<Follower<D>> {
    const Algorithm& algorithm = *find_algorithm(name);
    return algorithm.in<D>().followers[0].make(settings_of(algorithm));
  };
  return {std::string(name), make, costs, max_boxes};
}

/// The trees take over where the grid's cells make too many tests. A build may lack some of these algorithms.
template <int D>
detail::Vector<FollowerChoice<D>> automatic_followers() {
  detail::Vector<FollowerChoice<D>> followers = {
      follower_of<D>("brute_force", brute_force_following, boxes_for_brute_force),
      follower_of<D>("grid", grid_following<D>), follower_of<D>("quadtree", quadtree_following_for_auto),
      follower_of<D>("bvh", bvh_following_for_auto)};
  std::erase_if(followers, [](const auto& follower) { return !is_linked(follower.name); });
  return followers;
}

template <int D>
Strategies<D> automatic_strategies() {
  return {.searcher = make_strategy<AutoSearcher<D>>,
          .followers = automatic_followers<D>(),
          .find_costs = grid_finding<D>,
          .outline = core::outline_by(&AutoSearcher<D>::lay_out)};
}

}  // namespace

Algorithm automatic() {
  return {
      .name = "auto",
      .summary =
          "chooses among the others by the boxes' number and a sample; where boxes move, in each frame",
      .source = "Broadside's measurements",
      .tunables = {core::threads_tunable(), core::update_tunable()},
      .in_2d = core::in_dimension<2, automatic_strategies<2>>(),
      .in_3d = core::in_dimension<3, automatic_strategies<3>>(),
      .tests_doubles = true,
      .gives_candidates = true,
  };
}

}  // namespace broadside::algorithm
