// Parts about worst cases: spikes, a frame in which all boxes jump, and boxes at rest; and recorded motion.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "bench/motion/parts.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "lab/report/aligned_columns.hpp"
#include "lab/scenes/motion.hpp"

namespace broadside::bench {
namespace {

using lab::rounded;

template <int D>
std::vector<Box<D>> boxes_of(const std::string& scene, std::size_t boxes, std::uint64_t seed) {
  const lab::NamedScene named = lab::find_scene(scene);
  return lab::make_history<D>(named.scene, named.spec, {.boxes = boxes, .seed = seed}).boxes;
}

std::string scene_of(const MotionBenchmarkOptions& options) {
  return options.scenes.empty() ? "uniform" : options.scenes[0];
}

double moving_of(const MotionBenchmarkOptions& options) {
  return options.moving.empty() ? 0.1 : options.moving[0];
}

template <int D>
void spikes_in(const MotionBenchmarkOptions& options) {
  const std::size_t boxes = options.boxes_or(100'000);
  const Turns turns = options.turns(1'000, 5);
  const lab::Catalogue catalogue;
  const RaceOutcome outcome =
      race<D>(catalogue.select(options.algorithms_or("auto")),
              motion_of<D>(scene_of(options), options.request(boxes, turns, moving_of(options))), turns);
  print_heading(fmt::format("spikes, {}, {:.3g} % moving", scene_of(options), moving_of(options) * 100), D,
                boxes, turns);
  print_table(outcome);
  for (const RaceRunner& runner : outcome.runners) {
    if (!runner.ran()) continue;
    const auto worst = std::ranges::max_element(runner.frames_ms);
    fmt::print("  {}: worst over median {:.2f}, frame {}\n", runner.algorithm,
               *worst / lab::median(runner.frames_ms), worst - runner.frames_ms.begin() + 1);
  }
  fmt::print("\n");
}

constexpr std::size_t between_jumps = 9;

template <int D>
void jumps_in(const MotionBenchmarkOptions& options) {
  const std::size_t boxes = options.boxes_or(100'000);
  const Turns turns = options.turns(5 * (between_jumps + 1), 5);
  const lab::Catalogue catalogue;
  const std::string scene = fmt::format("jumps:every={}", between_jumps + 1);
  const RaceOutcome outcome =
      race<D>(catalogue.select(options.algorithms_or("auto,auto:update=rebuild")),
              motion_of<D>(scene, {.boxes = boxes, .seed = options.seed, .frames = turns.frames}), turns);
  print_heading(scene, D, boxes, turns);
  lab::AlignedColumns columns("<>>>>");
  columns.add({"algorithm", "jump us", "the frame after", "others", "first frame"});
  std::vector<std::pair<std::string, double>> jumps;
  for (const RaceRunner& runner : outcome.runners) {
    if (!runner.ran()) continue;
    std::array<std::vector<double>, 3> kinds;  // frames of jumps, frames after jumps, other frames
    for (std::size_t i = 0; i < runner.frames_ms.size(); ++i) {
      const std::size_t place = i % (between_jumps + 1);
      kinds[place == between_jumps ? 0 : place == 0 && i > 0 ? 1 : 2].push_back(runner.frames_ms[i] * 1e3);
    }
    const auto text = [](const std::vector<double>& times) {
      return times.empty() ? std::string("-") : rounded(lab::median(times));
    };
    if (!kinds[0].empty()) jumps.emplace_back(runner.algorithm, lab::median(kinds[0]));
    columns.add(
        {runner.algorithm, text(kinds[0]), text(kinds[1]), text(kinds[2]), rounded(runner.build_ms * 1e3)});
  }
  fmt::print("{}", columns.text("  "));
  for (std::size_t i = 1; i < jumps.size(); ++i)
    fmt::print("  jump of {} over that of {}: {:.2f}\n", jumps[0].first, jumps[i].first,
               jumps[0].second / jumps[i].second);
  fmt::print("\n");
}

/// A motion with the movers first and the boxes at rest after them.
template <int D>
struct MovingPopulation {
  std::vector<Box<D>> boxes;
  std::vector<Box<D>> movers;
};

/// `movers` boxes in the middle of a scene, in a region that holds about `around` of its boxes; and those
/// boxes alone.
template <int D>
std::array<MovingPopulation<D>, 2> populations(const std::string& scene, std::size_t resting,
                                               std::size_t around, std::size_t movers, std::uint64_t seed) {
  const std::vector<Box<D>> still = boxes_of<D>(scene, resting, seed);
  Box<D> bounds = still.front();
  for (const Box<D>& box : still) bounds = merged(bounds, box);
  // In a uniform scene, the number of boxes in the middle is proportional to its volume.
  const double share = std::pow(static_cast<double>(around) / static_cast<double>(resting), 1.0 / D);
  Box<D> middle;
  for (int axis = 0; axis < D; ++axis) {
    const double centre = (double{bounds.min[axis]} + bounds.max[axis]) / 2;
    const double half = (double{bounds.max[axis]} - bounds.min[axis]) / 2 * share;
    middle.min[axis] = static_cast<float>(centre - half);
    middle.max[axis] = static_cast<float>(centre + half);
  }
  std::array<MovingPopulation<D>, 2> made;
  const auto inside = [&middle](const Box<D>& box) {
    for (int axis = 0; axis < D; ++axis) {
      if (box.min[axis] < middle.min[axis] || box.max[axis] > middle.max[axis]) return false;
    }
    return true;
  };
  for (const Box<D>& box : boxes_of<D>(scene, resting, seed + 1)) {
    if (made[0].movers.size() < movers && inside(box)) made[0].movers.push_back(box);
  }
  made[1].movers = made[0].movers;
  for (MovingPopulation<D>& world : made) world.boxes = world.movers;
  for (const Box<D>& box : still) {
    made[0].boxes.push_back(box);
    if (overlap(box, middle)) made[1].boxes.push_back(box);
  }
  return made;
}

template <int D>
void rest_in(const MotionBenchmarkOptions& options) {
  constexpr std::size_t around = 10'000;
  constexpr std::size_t movers = 2'000;
  const std::size_t resting = options.boxes_or(1'000'000);
  Turns turns = options.turns(50, 5);
  const auto both = populations<D>(scene_of(options), resting, around, movers, options.seed);
  const lab::Catalogue catalogue;
  const std::vector<lab::Entry> entries = catalogue.select(options.algorithms_or("auto"));
  print_heading(fmt::format("boxes that rest, {}, {} and {} movers", scene_of(options),
                            lab::grouped(both[1].boxes.size() - both[1].movers.size()),
                            lab::grouped(both[0].movers.size())),
                D, resting, turns);
  std::array<RaceOutcome, 2> outcomes;
  const std::size_t rounds = std::exchange(turns.rounds, 1);
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t world = 0; world < 2; ++world) {
      const StartMotion<D> start = [&]() -> Motion<D> {
        const auto moving = std::make_shared<lab::MovingBoxes<D>>(
            both[world].movers, lab::SceneRequest{.seed = options.seed, .moving = 1, .drift = options.drift},
            false);
        return {both[world].boxes, [moving, size = both[world].boxes.size()] {
                  lab::Step<D> step = moving->next();
                  step.size = size;
                  return step;
                }};
      };
      merge(outcomes[world], race<D>(entries, start, turns));
    }
  }
  if (outcomes[0].events != outcomes[1].events)
    throw std::runtime_error(
        fmt::format("{} events in the large world and {} in the small one; expected "
                    "equally many, as the same boxes meet",
                    outcomes[0].events, outcomes[1].events));
  fmt::print("  {} boxes\n", lab::grouped(both[0].boxes.size()));
  print_table(outcomes[0]);
  fmt::print("  {} boxes\n", lab::grouped(both[1].boxes.size()));
  print_table(outcomes[1]);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (!outcomes[0].runners[i].ran() || !outcomes[1].runners[i].ran()) continue;
    fmt::print("  {}: the large world takes {:.2f} times as long\n", outcomes[0].runners[i].algorithm,
               lab::median(outcomes[0].runners[i].frames_ms) / lab::median(outcomes[1].runners[i].frames_ms));
  }
  fmt::print("\n");
}

template <int D>
void recorded_in(const MotionBenchmarkOptions& options, const std::string& engine,
                 const std::string& scenes_of_engine) {
  const std::size_t boxes = options.boxes_or(5'000);
  const Turns turns = options.turns(60, 5);
  const lab::Catalogue catalogue;
  for (const lab::Scene& scene : lab::scenes()) {
    const bool wanted = options.scenes.empty()
                            ? scene.name.starts_with(scenes_of_engine) || scene.name == "pile"
                            : std::ranges::find(options.scenes, scene.name) != options.scenes.end();
    const bool moves = D == 2 ? bool(scene.history_2d) : bool(scene.history_3d);
    if (!moves || !wanted) continue;
    const StartMotion<D> motion =
        motion_of<D>(scene.name, {.boxes = boxes, .seed = options.seed, .frames = turns.frames});
    const RaceOutcome outcome =
        race<D>(catalogue.select(options.algorithms_or("auto," + engine)), motion, turns);
    print_heading(fmt::format("{} ({}), {:.3g} % moving", scene.name, scene.source,
                              outcome.mean_movers() / static_cast<double>(boxes) * 100),
                  D, boxes, turns);
    print_table(outcome);
    fmt::print("\n");
  }
}

bool wants(const MotionBenchmarkOptions& options, int dimension) {
  return std::ranges::find(options.dimensions, dimension) != options.dimensions.end();
}

}  // namespace

void spikes(const MotionBenchmarkOptions& options) {
  if (wants(options, 2)) spikes_in<2>(options);
  if (wants(options, 3)) spikes_in<3>(options);
}

void jumps(const MotionBenchmarkOptions& options) {
  if (wants(options, 2)) jumps_in<2>(options);
  if (wants(options, 3)) jumps_in<3>(options);
}

void rest(const MotionBenchmarkOptions& options) {
  if (wants(options, 2)) rest_in<2>(options);
  if (wants(options, 3)) rest_in<3>(options);
}

void recorded(const MotionBenchmarkOptions& options) {
  if (wants(options, 2)) recorded_in<2>(options, "box2d_tree", "box2d_");
  if (wants(options, 3)) recorded_in<3>(options, "bullet_dbvt", "bullet_");
}

}  // namespace broadside::bench
