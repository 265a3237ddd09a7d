// auto: looks at a sample of the boxes, and lets the algorithm search that suits them.
//
// The rules are from measurements over the generated scenes and the maps, with 16 to 1,000,000 boxes; how
// near they come is a line of every comparison. They ask for what boxes are like, never for a clock: the same
// boxes are always searched the same way.
#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/broad_phase.hpp"
#include "broadside/outline.hpp"

#include "algorithms/descriptions.hpp"
#include "auto_tracker.hpp"
#include "core/double_finder.hpp"
#include "core/parallel.hpp"
#include "core/sample.hpp"
#include "double_follower.hpp"

namespace broadside::own {
namespace {

/// Up to here comparing all costs less than any order.
template <int D>
constexpr std::size_t few_boxes = D == 2 ? 320 : 400;

/// Up to here a grid's cells cost more to lay out than they save over a tree.
constexpr std::size_t boxes_for_cells = 6000;

/// Up to so many tests a box, a sweep along one axis needs no help.
constexpr double tests_of_a_good_axis = 4;

/// From so many overlaps a box on, most of what a cell tests is a pair, and filing boxes in several cells
/// only repeats it.
template <int D>
constexpr double many_overlaps = D == 2 ? 6 : 200;

/// From so many times as many boxes near each other on all axes as the single axes would let expect, cells
/// that suit the clusters would be too many.
template <int D>
constexpr double clustered = D == 2 ? 2.2 : 3;

/// Boxes of a sample are near if they begin within this part of its range, on every axis.
constexpr double near = 1.0 / 16;

constexpr std::size_t most_compared = 96;

/// Below so many overlaps among the sampled boxes, how many there are is chance: one of them stands for n /
/// 9,000 tests a box.
constexpr double telling_overlaps = 8;

/// What is chosen, and what for.
enum class Choice { few, one_axis, tree, dense, clusters, cells };

constexpr std::array<std::string_view, 6> chosen_algorithm = {
    "brute_force", "sweep_and_prune", "bvh", "bvh", "bvh", "grid"};

template <int D>
class Auto final : public PairFinder<D>, public Outlined<D> {
 public:
  std::string explanation() const override {
    const auto rounded = [](double number) {
      const std::string text = std::to_string(number);
      return text.substr(0, text.find('.') + 2);
    };
    std::string text(chosen_algorithm[static_cast<std::size_t>(choice_)]);
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
    }
    return text;
  }

 private:
  void find_valid(std::span<const Box<D>> boxes, PairSink& pairs) override {
    this->search_with(chosen_for(boxes), boxes, pairs);
  }

  PairFinder<D>& chosen_for(std::span<const Box<D>> boxes) {
    count_ = boxes.size();
    choice_ = choose(boxes);
    auto& finder = finders_[static_cast<std::size_t>(choice_)];
    if (!finder) {
      const std::string name(chosen_algorithm[static_cast<std::size_t>(choice_)]);
      finder = make_finder<D>(*find_algorithm(name), Spec{name, {}});
    }
    return *finder;
  }

  Outline<D> lay_out(std::span<const Box<D>> boxes) override {
    Outline<D> outline = broadside::outline(chosen_for(boxes), boxes);
    const std::string_view name = chosen_algorithm[static_cast<std::size_t>(choice_)];
    outline.caption.insert(0, std::string(name) + (outline.caption.empty() ? "" : ": "));
    return outline;
  }

  Choice choose(std::span<const Box<D>> boxes) {
    if (boxes.size() <= few_boxes<D>) return Choice::few;
    if (boxes.size() <= boxes_for_cells) return Choice::tree;
    sample_.take(boxes, most_compared);
    const auto count = static_cast<double>(boxes.size());
    const int best = sample_.axes_by_overlap()[0];
    tests_ = tests_along(best, count);
    if (tests_ <= tests_of_a_good_axis) return Choice::one_axis;
    overlaps_ = count / 2;
    for (int axis = 0; axis < D; ++axis) overlaps_ *= sample_[axis].overlap;
    if (overlaps_ >= many_overlaps<D>) return Choice::dense;
    clustering_ = clustering(boxes);
    return clustering_ >= clustered<D> ? Choice::clusters : Choice::cells;
  }

  /// About how many tests a box a sweep of `count` boxes along the axis takes.
  double tests_along(int axis, double count) const {
    const core::AxisSample& sample = sample_[axis];
    const std::vector<float>& minima = sample.minima;
    const auto size = static_cast<double>(minima.size());
    const double measured = count * sample.overlap / 2;
    if (sample.overlap * size * (size - 1) / 2 >= telling_overlaps) return measured;
    // How many begin within a box's extent, by how close the sampled boxes near it stand to each other: so
    // clusters count for what they are.
    constexpr std::size_t apart = 4;
    double density = 0;  // of all boxes, those that begin in a unit of length
    for (std::size_t i = 0; i + apart < minima.size(); ++i) {
      const double distance = static_cast<double>(minima[i + apart]) - minima[i];
      if (!(distance > 0)) return measured;
      density += (apart - 1) / (distance * size * (size - apart));
    }
    return count * density * sample.mean_extent;
  }

  /// How many times as many pairs of boxes are near on all axes as the single axes would let expect: 1 where
  /// boxes are spread evenly.
  double clustering(std::span<const Box<D>> boxes) const {
    const std::size_t count = std::min(boxes.size(), most_compared);
    std::array<std::array<float, most_compared>, D> minima;
    std::array<float, D> reach;
    for (int axis = 0; axis < D; ++axis) {
      reach[axis] = static_cast<float>(near * (static_cast<double>(sample_[axis].high) - sample_[axis].low));
      for (std::size_t i = 0; i < count; ++i)
        minima[axis][i] = boxes[core::sampled_place(i, boxes.size())].min[axis];
    }
    std::array<std::uint32_t, D> on_axis{};
    std::uint32_t on_all = 0;
    for (std::size_t i = 1; i < count; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        std::uint32_t all = 1;
        for (int axis = 0; axis < D; ++axis) {
          const float difference = minima[axis][i] - minima[axis][j];
          const std::uint32_t is_near = static_cast<std::uint32_t>(difference <= reach[axis]) &
                                        static_cast<std::uint32_t>(-difference <= reach[axis]);
          on_axis[axis] += is_near;
          all &= is_near;
        }
        on_all += all;
      }
    }
    const double pairs = static_cast<double>(count * (count - 1)) / 2;
    double expected = pairs;
    for (int axis = 0; axis < D; ++axis) expected *= on_axis[axis] / pairs;
    // A few by chance say nothing.
    return on_all / std::max(expected, 4.0);
  }

  core::Sample<D> sample_;
  std::array<std::unique_ptr<PairFinder<D>>, chosen_algorithm.size()> finders_;
  Choice choice_ = Choice::few;
  std::size_t count_ = 0;
  double tests_ = 0;
  double overlaps_ = 0;
  double clustering_ = 0;
};

template <int D>
std::unique_ptr<PairFinder<D>> make(const Settings&) {
  return std::make_unique<Auto<D>>();
}

Way way_of(const Settings& settings) {
  const std::string& way = settings.text("way");
  if (way == "rebuild") return Way::rebuild;
  return way == "incremental" ? Way::incremental : Way::automatic;
}

template <int D>
std::unique_ptr<PairTracker<D>> make_tracking(const Settings& settings) {
  return std::make_unique<AutoTracker<D, float>>(
      std::make_unique<Auto<D>>(), make_tracker<D>(*find_algorithm("hierarchical_grid"), Spec{}),
      [](std::span<const Box<D>>) { return true; }, way_of(settings));
}

template <int D>
std::unique_ptr<PairTracker<D, double>> make_double_tracking(const Settings& settings) {
  return std::make_unique<AutoTracker<D, double>>(
      std::make_unique<core::DoubleFinder<D>>(std::make_unique<Auto<D>>()),
      std::make_unique<DoubleFollower<D>>(), floats_suffice<D>, way_of(settings));
}

}  // namespace

Algorithm automatic() {
  return {
      .name = "auto",
      .summary =
          "looks at a sample of the boxes and chooses among the others; where boxes move, from frame to "
          "frame",
      .source = "Broadside's measurements",
      .tunables = {core::threads_tunable(),
                   {.name = "way",
                    .summary = "in tracking: find all pairs anew in each frame, or follow what changed",
                    .standard = "auto",
                    .type = Tunable::Type::choice,
                    .choices = {"auto", "rebuild", "incremental"}}},
      .finder_2d = make<2>,
      .finder_3d = make<3>,
      .tracker_2d = make_tracking<2>,
      .tracker_3d = make_tracking<3>,
      .double_tracker_2d = make_double_tracking<2>,
      .double_tracker_3d = make_double_tracking<3>,
  };
}

}  // namespace broadside::own
