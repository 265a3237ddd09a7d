// The part about whole frames: a tracker over the search alone, and its worst frames.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

#include "bench/motion/parts.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "lab/report/aligned_columns.hpp"
#include "lab/scenes/random.hpp"

namespace broadside::bench {
namespace {

/// Finds the pairs of each frame, and nothing else. Its events are told apart outside the measured time.
template <int D>
class SearchAlone final : public MotionFollower<D> {
 public:
  explicit SearchAlone(const std::string& spec) : finder_(Spec(spec)) {}

  void take(const lab::Step<D>& step) override {
    lab::apply(step, boxes_);
    std::swap(before_, pairs_);
    pairs_.clear();
  }

  void update() override {
    PairCollector found(pairs_);
    finder_.find(boxes_, found);
  }

  const lab::FrameEvents& events() override {
    std::ranges::sort(pairs_);
    events_.begun.clear();
    events_.ended.clear();
    std::ranges::set_difference(pairs_, before_, std::back_inserter(events_.begun));
    std::ranges::set_difference(before_, pairs_, std::back_inserter(events_.ended));
    return events_;
  }

  std::string explanation() const override {
    return fmt::format("{} pairs; {}", lab::grouped(pairs_.size()), finder_.explanation());
  }

 private:
  Finder<D> finder_;
  std::vector<Box<D>> boxes_;
  std::vector<Pair> before_;
  std::vector<Pair> pairs_;
  lab::FrameEvents events_;
};

template <int D>
Box<D> shifted(Box<D> box, const std::array<double, D>& way) {
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = static_cast<float>(box.min[axis] + way[axis]);
    box.max[axis] = static_cast<float>(box.max[axis] + way[axis]);
  }
  return box;
}

/// Motions that go on alike for any number of frames. `drift` is relative to a box's first side.
template <int D>
StartMotion<D> steady_motion(const std::string& kind, const std::string& scene,
                             const lab::SceneRequest& request) {
  if (kind == "straight") return motion_of<D>(scene, request);
  const std::vector<Box<D>> homes = motion_of<D>(scene, request)().boxes;
  return [=]() -> Motion<D> {
    const auto random = std::make_shared<lab::Random>(request.seed);
    const auto frame = std::make_shared<int>(0);
    const auto next = [=] {
      ++*frame;
      lab::Step<D> step{homes.size(), {}, {}};
      for (std::size_t i = 0; i < homes.size(); ++i) {
        const double side = homes[i].max[0] - homes[i].min[0];
        std::array<double, D> way{};
        if (kind == "alike")
          way.fill(request.drift * side * *frame);
        else
          for (double& along : way) along = request.drift * side * random->between(-0.5, 0.5);
        step.changed.push_back(BoxId(i));
        // One box in fifty is absent, each time others.
        const bool is_absent = kind == "churn" && random->chance(0.02);
        step.boxes.push_back(is_absent ? absent_box<D>() : shifted<D>(homes[i], way));
      }
      return step;
    };
    return {homes, next};
  };
}

template <int D>
void frames_in(const MotionBenchmarkOptions& options, const std::string& kind, std::size_t boxes,
               double drift) {
  const Turns turns = options.turns(60, 1);
  lab::SceneRequest request = options.request(boxes, turns, options.moving.empty() ? 1 : options.moving[0]);
  request.drift = drift;
  const std::string scene = options.scenes.empty() ? "uniform" : options.scenes[0];
  const lab::Catalogue catalogue;
  const std::vector<lab::Entry> entries = catalogue.select(options.algorithms_or("auto"));
  std::vector<Competitor<D>> competitors = trackers<D>(entries);
  competitors.insert(competitors.begin(), {"search alone", "boxes", [spec = entries.front().spec.text()] {
                                             return std::make_unique<SearchAlone<D>>(spec);
                                           }});
  const RaceOutcome outcome = race<D>(std::move(competitors), steady_motion<D>(kind, scene, request), turns);
  print_heading(
      fmt::format("{}, {} by {:.3g} of a box, {} events a frame", scene, kind, drift,
                  lab::rounded(static_cast<double>(outcome.events) / static_cast<double>(turns.frames))),
      D, boxes, turns);
  print_table(outcome);
  for (const RaceRunner& runner : outcome.runners) {
    if (!runner.ran()) continue;
    fmt::print("  {}: worst over median {:.2f}\n", runner.algorithm,
               std::ranges::max(runner.frames_ms) / lab::median(runner.frames_ms));
  }
  fmt::print("\n");
}

}  // namespace

void frames(const MotionBenchmarkOptions& options) {
  for (const std::string& kind : options.kinds) {
    for (const int dimension : options.dimensions) {
      const std::vector<std::size_t> counts = options.boxes > 0
                                                  ? std::vector{options.boxes}
                                                  : std::vector<std::size_t>{300, 1'000, 3'000, 10'000};
      for (const std::size_t boxes : counts) {
        if (dimension == 2)
          frames_in<2>(options, kind, boxes, options.drift);
        else
          frames_in<3>(options, kind, boxes, options.drift);
      }
    }
  }
}

}  // namespace broadside::bench
