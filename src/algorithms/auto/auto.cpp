// auto: looks at a sample of the boxes, and chooses the algorithm that suits them.
//
// The rules ask what the boxes are like, never a clock: the same boxes are always searched in the same way.
// Their thresholds, and where these come from, are in thresholds.hpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/debug/outline.hpp"
#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"

#include "algorithms/auto/overlap_estimate.hpp"
#include "algorithms/auto/segment_join.hpp"
#include "algorithms/auto/thresholds.hpp"
#include "algorithms/descriptions.hpp"
#include "core/dimensions.hpp"
#include "core/lean.hpp"
#include "core/number_text.hpp"
#include "core/parallel.hpp"
#include "core/sample.hpp"
#include "doubles/double_finder.hpp"
#include "doubles/double_follower.hpp"
#include "interface/follow_costs.hpp"
#include "interface/last_test.hpp"
#include "interface/margin_tracker.hpp"
#include "interface/yielding.hpp"

namespace broadside::algorithm {
namespace {

/// Why an algorithm is chosen; which one, chosen_algorithm says.
enum class Choice { few, one_axis, tree, dense, clusters, cells, few_in_one_place, one_place, shapes };

constexpr std::array<std::string_view, 9> chosen_algorithm = {
    "brute_force", "sweep_and_prune", "bvh", "bvh", "bvh", "grid", "brute_force", "sweep_and_prune", "grid"};

/// The algorithm of a choice. A build without it has the grid, which does well with most boxes: one row of
/// cells is a sweep.
const Algorithm& algorithm_of(Choice choice) {
  const Algorithm* const chosen = find_algorithm(chosen_algorithm[static_cast<std::size_t>(choice)]);
  return chosen != nullptr ? *chosen : *find_algorithm("grid");
}

template <int D>
class Auto final : public PairFinder<D>, public Outlined<D>, public core::LastTest<D> {
  using Limits = AutoThresholds<D>;

 public:
  Outlined<D>* outlined() noexcept override { return this; }
  core::LastTest<D>* last_test() noexcept override { return this; }

  std::string explanation() const override {
    if constexpr (core::is_lean) return {};
    std::string text = reason();
    if (has_handed_over_)
      text +=
          "; it gave up, since its tests were far more than boxes and pairs account for, and a segment tree "
          "found what was left";
    return text;
  }

 private:
  std::string reason() const {
    const auto rounded = [](double number) { return core::text_of(std::trunc(number * 10) / 10); };
    std::string text = algorithm_of(choice_).name;
    text += ", since ";
    const std::string boxes = std::to_string(count_) + " boxes";
    switch (choice_) {
      case Choice::few:
        return text + boxes + " are so few that comparing all of them costs less than any order";
      case Choice::one_axis:
        return text + "a sweep along one axis leaves few tests a box: " + rounded(tests_) + " in a sample";
      case Choice::tree:
        return text + boxes + " are too few for cells to pay";
      case Choice::dense:
        return text + "a box overlaps some " + rounded(overlaps_) + " others, which cells would only repeat";
      case Choice::clusters:
        return text + "boxes stand in clusters: " + rounded(clustering_) +
               " times as many are near each other as evenly spread ones would be";
      case Choice::cells:
        return text + boxes + " spread as evenly as these suit cells";
      case Choice::few_in_one_place:
      case Choice::one_place:
        return text + "a box overlaps some " + rounded(overlaps_) + " of " + boxes +
               ", so that nothing is gained by parting them";
      case Choice::shapes:
        return text + "the shapes of these " + boxes + " suit cells better than a tree's bounds";
    }
    return text;
  }

  void find_valid(std::span<const Box<D>> boxes, PairSink& pairs) override {
    has_handed_over_ = false;
    PairFinder<D>& finder = chosen_for(boxes);
    finder.last_test()->set_doubles(this->doubles());
    this->search_with(finder, boxes, pairs);
    const core::Yielding<D>* const search = finder.yielding();
    if (search == nullptr || !search->has_yielded()) return;
    has_handed_over_ = true;
    Statistics statistics = this->statistics().value_or(Statistics{});
    if (!segments_) segments_ = std::make_unique<SegmentJoin<D>>();
    core::LeftSink<D> left(*search, boxes, pairs);
    Checkpoint checkpoint(this->workers().checkpoint);
    const Statistics more = segments_->join(boxes, this->left_count(), this->doubles(), checkpoint, left);
    left.flush();
    statistics.tests += more.tests;
    statistics.references += more.references;
    this->count(statistics);
  }

  PairFinder<D>& chosen_for(std::span<const Box<D>> boxes) {
    count_ = boxes.size();
    choice_ = choose(boxes);
    auto& finder = finders_[static_cast<std::size_t>(choice_)];
    if (!finder) {
      const Algorithm& algorithm = algorithm_of(choice_);
      Spec spec{algorithm.name, {}};
      // A sweep in stripes cannot give up, so ask for one axis.
      if (algorithm.name == "sweep_and_prune") spec.values.emplace_back("axes", "1");
      finder = make_finder<D>(algorithm, spec);
      if (core::Yielding<D>* const search = finder->yielding()) search->let_yield(true);
    }
    return *finder;
  }

  Outline<D> lay_out(std::span<const Box<D>> boxes) override {
    if constexpr (core::is_lean) return {};
    PairFinder<D>& chosen = chosen_for(boxes);
    chosen.set_workers(this->workers());
    Outline<D> outline = broadside::outline(chosen, boxes);
    outline.caption.insert(0, algorithm_of(choice_).name + (outline.caption.empty() ? "" : ": "));
    return outline;
  }

  Choice choose(std::span<const Box<D>> boxes) {
    if (boxes.size() <= Limits::few_boxes) return Choice::few;
    if (boxes.size() <= Limits::boxes_for_cells) return choose_by_estimate(boxes);
    sample_.take(boxes, Limits::most_compared);
    const auto count = static_cast<double>(boxes.size());
    const int best = sample_.axes_by_overlap()[0];
    tests_ = count * sample_[best].overlap / 2;
    if (tests_ <= Limits::tests_of_a_good_axis) return Choice::one_axis;
    overlaps_ = count / 2;
    for (int axis = 0; axis < D; ++axis) overlaps_ *= sample_[axis].overlap;
    if (overlaps_ >= Limits::most_pairs * count / 2) return Choice::one_place;
    if (overlaps_ >= Limits::many_overlaps) return Choice::dense;
    std::array<float, D> reach;
    for (int axis = 0; axis < D; ++axis)
      reach[axis] = static_cast<float>(double{Limits::near} *
                                       (static_cast<double>(sample_[axis].high) - sample_[axis].low));
    estimate_.take(boxes, Limits::most_compared);
    clustering_ = estimate_.clustering(reach);
    return clustering_ >= Limits::clustered ? Choice::clusters : Choice::cells;
  }

  /// Chooses for up to boxes_for_cells boxes, of which sorting a sample would take a good part of the time.
  Choice choose_by_estimate(std::span<const Box<D>> boxes) {
    const std::size_t size = boxes.size();
    const auto half = static_cast<double>(size) / 2;
    estimate_.take(boxes, size < 2 * Limits::boxes_of_a_line ? 32 : 48);
    estimate_.compare();
    overlaps_ = half * estimate_.overlap_on_all();
    if (estimate_.overlap_on_all() >= Limits::most_pairs)
      return size <= Limits::few_boxes_in_one_place ? Choice::few_in_one_place : Choice::one_place;
    if (size < Limits::boxes_of_a_line) return Choice::tree;
    std::array<double, D> overlap = estimate_.overlap();
    std::ranges::sort(overlap);
    tests_ = half * overlap[0];
    if (overlap[1] >= Limits::in_line && tests_ <= Limits::tests_of_a_line) return Choice::one_axis;
    double expected = half;  // overlaps a box, were the axes independent: stacks of plates have far fewer
    for (const double part : overlap) expected *= part;
    const bool are_stacked = size >= Limits::stacked_boxes_for_a_tree && expected >= Limits::many_overlaps;
    if (are_stacked || !shapes_suit_cells(boxes, overlap[D - 1])) return Choice::tree;
    std::array<float, D> reach = estimate_.range();
    for (float& distance : reach) distance *= Limits::near;
    clustering_ = estimate_.clustering(reach);
    return clustering_ >= Limits::clustered ? Choice::clusters : Choice::shapes;
  }

  bool shapes_suit_cells(std::span<const Box<D>> boxes, double most_on_an_axis) const {
    const std::size_t size = boxes.size();
    if (overlaps_ >= Limits::most_overlaps_for_their_shape) return false;
    if (D == 3 && size >= Limits::flat_boxes_for_cells && most_on_an_axis >= Limits::flat) return true;
    if (size < Limits::most_uneven_boxes_for_cells) return false;
    const core::ExtentStats sides = core::extent_stats<D>(boxes);
    if (sides.unevenness >= Limits::most_uneven_boxes || (D == 3 && sides.unevenness <= Limits::of_one_size))
      return true;
    return (size >= Limits::long_boxes_for_cells && sides.longest_over_shortest >= Limits::long_boxes) ||
           (size >= Limits::uneven_boxes_for_cells && sides.unevenness >= Limits::uneven_boxes);
  }

  core::OverlapEstimate<D> estimate_;
  core::Sample<D> sample_;
  std::array<std::unique_ptr<PairFinder<D>>, chosen_algorithm.size()> finders_;
  std::unique_ptr<SegmentJoin<D>> segments_;  // null until a search is handed over
  Choice choice_ = Choice::few;
  std::size_t count_ = 0;
  bool has_handed_over_ = false;
  double tests_ = 0;
  double overlaps_ = 0;
  double clustering_ = 0;
};

template <int D>
std::unique_ptr<PairFinder<D>> make_auto(const Settings&) {
  return std::make_unique<Auto<D>>();
}

/// What follows boxes in an algorithm's structure. Boxes of doubles are followed by their floats.
template <int D, typename Real>
std::unique_ptr<PairTracker<D, Real>> make_follower(std::string_view spec) {
  if constexpr (std::is_same_v<Real, float>)
    return make_tracker<D>(spec);
  else
    return std::make_unique<DoubleFollower<D>>(make_tracker<D>(spec));
}

/// Those that this build has. The later ones take over where the first makes too many tests.
template <int D, typename Real>
std::vector<core::Follower<D, Real>> followers() {
  std::vector<core::Follower<D, Real>> followers = {
      {"grid", [] { return make_follower<D, Real>("grid:update=follow"); }, core::grid_following<D>},
      {"quadtree", [] { return make_follower<D, Real>("quadtree:update=follow"); },
       core::quadtree_following_for_auto},
      {"bvh", [] { return make_follower<D, Real>("bvh:update=follow"); }, core::bvh_following_for_auto},
  };
  std::erase_if(followers, [](const auto& follower) { return find_algorithm(follower.name) == nullptr; });
  return followers;
}

template <int D>
std::unique_ptr<PairTracker<D>> make_auto_tracker(const Settings& settings) {
  return core::adaptive_tracker<D, float>(core::update_of(settings), std::make_unique<Auto<D>>(),
                                          core::grid_finding<D>, followers<D, float>(),
                                          make_tracker<D>("brute_force"));
}

template <int D>
std::unique_ptr<PairTracker<D, double>> make_auto_double_tracker(const Settings& settings) {
  return core::adaptive_tracker<D, double>(
      core::update_of(settings), std::make_unique<core::DoubleFinder<D>>(std::make_unique<Auto<D>>()),
      core::grid_finding<D>, followers<D, double>());
}

}  // namespace

Algorithm automatic() {
  return {
      .name = "auto",
      .summary = core::unless_lean(
          "looks at a sample of the boxes and chooses among the others; where boxes move, in each frame"),
      .source = core::unless_lean("Broadside's measurements"),
      .tunables = {core::threads_tunable(), core::update_tunable()},
      .finder_2d = core::in_dimension<2>(make_auto<2>),
      .finder_3d = core::in_dimension<3>(make_auto<3>),
      .tracker_2d = core::in_dimension<2>(make_auto_tracker<2>),
      .tracker_3d = core::in_dimension<3>(make_auto_tracker<3>),
      .double_tracker_2d = core::is_lean ? nullptr : make_auto_double_tracker<2>,
      .double_tracker_3d = core::is_lean ? nullptr : make_auto_double_tracker<3>,
  };
}

}  // namespace broadside::algorithm
