// Sweep and prune: sorts boxes along one axis and compares each with those that begin before it ends,
// optionally in stripes of a second axis.
//
// Section IV of the paper. The axis is the one on which a sample of the boxes overlaps least. Where that
// leaves many candidates, a second axis is cut into stripes that hold equally many boxes, and each stripe is
// swept by itself (P. Terdiman, "Box pruning revisited"). A box is in every stripe it touches; a pair is
// reported in the stripe that holds the greater of its two minima.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/debug/outline.hpp"
#include "broadside/error.hpp"

#include "algorithms/follow_costs.hpp"
#include "algorithms/followers.hpp"
#include "algorithms/outline_text.hpp"
#include "algorithms/registry.hpp"
#include "algorithms/sweep_bounds.hpp"
#include "core/large_array.hpp"
#include "core/parallel.hpp"
#include "core/prefix_sum.hpp"
#include "core/sample.hpp"
#include "core/sorted_boxes.hpp"
#include "core/tunables.hpp"
#include "kernels/sweep.hpp"

namespace broadside::algorithm {
namespace {

/// The cost of inserting a box into one more stripe, in tests of two boxes.
constexpr double stripe_reference_cost = 64;

constexpr std::size_t max_stripes = 256;

/// Boxes that one thread sweeps at a time, where there are no stripes.
constexpr std::size_t swept_at_once = 64;

template <int D>
class SweepAndPruneSearcher final : public Searcher<D> {
 public:
  explicit SweepAndPruneSearcher(const Settings& settings) : axis_(axis_of(settings)) {
    if (!settings.is_auto("axes")) axes_ = static_cast<int>(settings.text("axes")[0] - '0');
    if (axis_ >= D) throw InvalidSpec("sweep_and_prune: axis is 'z'; expected x, y or auto in 2D");
  }

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    parallel_.start(input.workers, input.boxes.size());
    runs_.resize(std::max(runs_.size(), parallel_.workers()));
    const std::array<int, D> axes = choose_axes(input.boxes);
    const std::span<const core::SortedBox<D>> sorted = sorted_.sort(input.boxes, axes, parallel_);
    return borders_.empty() ? sweep_all(input, sorted, pairs) : sweep_stripes(input, sorted, pairs);
  }

  Outline<D> lay_out(std::span<const Box<D>> boxes, const Workers&) {
    const std::array<int, D> axes = choose_axes(boxes);
    Outline<D> outline;
    outline.swept_axis = axes[0];
    outline.kind = borders_.empty() ? "sweep" : "stripes";
    const std::string swept = "swept along " + axis_name(axes[0]);
    outline.caption = borders_.empty() ? "one sweep along " + axis_name(axes[0])
                                       : counted(borders_.size() + 1, "stripe") + " of " +
                                             axis_name(axes[1]) + ", each " + swept;
    Box<D> stripe;
    stripe.min.fill(-std::numeric_limits<float>::infinity());
    stripe.max.fill(std::numeric_limits<float>::infinity());
    outline.levels.resize(1);
    for (std::size_t i = 0; i <= borders_.size(); ++i) {
      if (i > 0) stripe.min[axes[1]] = borders_[i - 1];
      stripe.max[axes[1]] = i < borders_.size() ? borders_[i] : std::numeric_limits<float>::infinity();
      outline.levels[0].push_back(stripe);
    }
    return outline;
  }

 private:
  /// Chooses the order of the axes (swept, striped, the rest) and the stripes.
  std::array<int, D> choose_axes(std::span<const Box<D>> boxes) {
    sample_.take(boxes);
    const std::array<int, D> axes = sample_.axes_from(axis_);
    borders_.clear();
    choose_stripes(boxes.size(), sample_[axes[0]], sample_[axes[1]]);
    return axes;
  }

  /// Sets the borders between stripes, none if one axis is enough.
  void choose_stripes(std::size_t boxes, const core::AxisSample& swept, const core::AxisSample& striped) {
    // With S stripes that have borders where boxes begin, a box touches 1 + (S - 1) / 2 * overlap of them.
    // The tests of a stripe's sweep grow with the square of its boxes.
    const auto cost = [&](std::size_t stripes) {
      const auto count = static_cast<double>(boxes);
      const double references = count * (1 + static_cast<double>(stripes - 1) * striped.overlap / 2);
      return stripe_reference_cost * references +
             references * references * swept.overlap / 2 / static_cast<double>(stripes);
    };
    std::size_t best = axes_ == 2 ? 2 : 1;
    for (std::size_t stripes = 2 * best; axes_ != 1 && stripes <= max_stripes && 16 * stripes <= boxes;
         stripes *= 2) {
      if (cost(stripes) < cost(best)) best = stripes;
    }
    const std::vector<float>& minima = striped.minima;
    for (std::size_t stripe = 1; stripe < best && !minima.empty(); ++stripe)
      borders_.push_back(minima[minima.size() * stripe / best]);
    borders_.erase(std::unique(borders_.begin(), borders_.end()), borders_.end());
  }

  /// May give up before it starts.
  Statistics sweep_all(const SearchInput<D>& input, std::span<const core::SortedBox<D>> sorted,
                       PairSink& pairs) {
    kernels::RunBuffer<D>& buffer = runs_[0];
    buffer.clear();
    buffer.reserve(sorted.size());
    for (const core::SortedBox<D>& box : sorted)
      buffer.append(box.box, box.id, kernels::side_bit(box.id, input.left_count));
    const kernels::Run<D> run = buffer.view(input.doubles);
    if (input.successor != nullptr && is_wasteful(run, max_tests_per_box * run.size)) {
      input.successor->finish([](const Box<D>&, BoxId, const Box<D>&, BoxId) { return true; });
      return {.references = run.size};
    }
    const auto sweep = [&](core::Range some, std::size_t worker, PairSink& sink) {
      const std::size_t begin = some.begin * swept_at_once;
      const std::size_t end = std::min(some.end * swept_at_once, run.size);
      const auto rows = kernels::rows_of(run, begin, end, parallel_.checkpoint(worker));
      return Statistics{.tests = kernels::sweep(rows, sink)};
    };
    Statistics statistics = parallel_.search((run.size + swept_at_once - 1) / swept_at_once, pairs, sweep);
    statistics.references = run.size;
    return statistics;
  }

  /// Never gives up.
  Statistics sweep_stripes(const SearchInput<D>& input, std::span<const core::SortedBox<D>> sorted,
                           PairSink& pairs) {
    const auto stripe_of = [this](float coordinate) {
      return static_cast<std::uint16_t>(std::upper_bound(borders_.begin(), borders_.end(), coordinate) -
                                        borders_.begin());
    };
    places_.resize(sorted.size());
    const std::size_t stripes = borders_.size() + 1;
    ends_.assign(stripes * parallel_.range_count(), 0);
    parallel_.for_numbered_ranges(sorted.size(), [&](std::size_t number, core::Range range, std::size_t) {
      for (std::size_t i = range.begin; i < range.end; ++i) {
        places_[i] = {stripe_of(sorted[i].box.min[1]), stripe_of(sorted[i].box.max[1])};
        for (std::size_t stripe = places_[i].first; stripe <= places_[i].last; ++stripe)
          ++ends_[number * stripes + stripe];
      }
    });
    core::renew(listed_, core::prefix_sum(std::span<std::size_t>(ends_), stripes));
    parallel_.for_numbered_ranges(sorted.size(), [&](std::size_t number, core::Range range, std::size_t) {
      for (std::size_t i = range.begin; i < range.end; ++i) {
        for (std::size_t stripe = places_[i].first; stripe <= places_[i].last; ++stripe)
          listed_[ends_[number * stripes + stripe]++] = static_cast<std::uint32_t>(i);
      }
    });
    const std::span<const std::size_t> ends = std::span(ends_).last(stripes);  // those of the last range
    const auto sweep = [&](core::Range some, std::size_t worker, PairSink& sink) {
      Statistics statistics;
      for (std::size_t stripe = some.begin; stripe < some.end; ++stripe) {
        const std::size_t begin = stripe == 0 ? 0 : ends[stripe - 1];
        const std::span<const std::uint32_t> list = std::span(listed_).subspan(begin, ends[stripe] - begin);
        kernels::RunBuffer<D>& run = runs_[worker];
        run.clear();
        run.reserve(list.size());
        for (const std::uint32_t i : list) {
          const auto before = static_cast<std::uint32_t>(places_[i].first < stripe);
          run.append(sorted[i].box, sorted[i].id, before | kernels::side_bit(sorted[i].id, input.left_count));
        }
        statistics.tests += kernels::sweep(run.view(input.doubles, parallel_.checkpoint(worker)), sink);
        statistics.references += list.size();
      }
      return statistics;
    };
    return parallel_.search(stripes, pairs, sweep);
  }

  /// The stripes in which a box begins and ends.
  struct Place {
    std::uint16_t first;
    std::uint16_t last;
  };

  int axis_;      // the axis to sweep along; -1: to be chosen
  int axes_ = 0;  // 1: no stripes; 2: stripes; 0: to be chosen

  core::Sample<D> sample_;
  core::SortedBoxes<D> sorted_;
  std::vector<float> borders_;  // a stripe's first coordinate, from the second stripe on
  std::vector<Place> places_;
  // By range and stripe: first how many boxes, then where the next one is listed, at last the list's end.
  core::LargeArray<std::size_t> ends_;
  core::LargeArray<std::uint32_t> listed_;  // places of boxes, stripe by stripe
  core::Parallel parallel_;
  std::vector<kernels::RunBuffer<D>> runs_;  // by worker
};

template <int D>
Strategies<D> sweep_and_prune_strategies() {
  return {.searcher = make_strategy<SweepAndPruneSearcher<D>>,
          .followers = {{"sweep_and_prune", make_sweep_and_prune_follower<D>, sweep_following<D>}},
          .find_costs = sweep_finding<D>,
          .outline = core::outline_by(&SweepAndPruneSearcher<D>::lay_out)};
}

}  // namespace

Algorithm sweep_and_prune() {
  return {
      .name = "sweep_and_prune",
      .summary =
          "a sorted sweep along the axis that separates the boxes best, in stripes of a second axis where "
          "that pays",
      .source = "paper.md, sections IV and VI-C; P. Terdiman, Box pruning revisited",
      .tunables = {{.name = "axis",
                    .summary = "the axis to sweep along",
                    .default_value = "auto",
                    .type = Tunable::Type::choice,
                    .choices = {"x", "y", "z"}},
                   {.name = "axes",
                    .summary = "how many axes are used: 1, or 2 for stripes",
                    .default_value = "auto",
                    .type = Tunable::Type::choice,
                    .choices = {"1", "2"}},
                   core::update_tunable(),
                   core::threads_tunable()},
      .in_2d = core::in_dimension<2, sweep_and_prune_strategies<2>>(),
      .in_3d = core::in_dimension<3, sweep_and_prune_strategies<3>>(),
      .tests_doubles = true,
      .gives_candidates = true,
  };
}

}  // namespace broadside::algorithm
