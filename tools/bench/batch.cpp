// Many small worlds in one call, compared with a loop: batch [WORLDS [BOXES [ROUNDS]]]. find_pairs_batch()
// against a loop over find_pairs(), and a BatchTracker, whose boxes all move, against a Tracker for each
// world.
//
// Both find the same pairs of the same worlds in turns. The pairs must be the same; of a search, in the same
// order.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "broadside/broadside.hpp"

#include "bench/gain.hpp"
#include "bench/guarded.hpp"
#include "lab/measure/benchmark.hpp"
#include "lab/measure/samples.hpp"
#include "lab/report/machine.hpp"
#include "lab/scenes/random.hpp"

namespace broadside::bench {
namespace {

/// Worlds in which a box overlaps about two others.
template <int D, typename Real>
std::vector<Box<D, Real>> make_worlds(std::size_t worlds, std::size_t boxes) {
  lab::Random random(1);
  const double side = std::pow(static_cast<double>(boxes), 1.0 / D) * (D == 2 ? 1.5 : 1.6);
  std::vector<Box<D, Real>> all(worlds * boxes);
  for (Box<D, Real>& box : all) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = static_cast<Real>(random.between(0, side));
      box.max[axis] = box.min[axis] + static_cast<Real>(random.between(0.5, 1.5));
    }
  }
  return all;
}

std::vector<std::size_t> offsets_of(std::size_t worlds, std::size_t boxes) {
  std::vector<std::size_t> offsets;
  for (std::size_t world = 0; world <= worlds; ++world) offsets.push_back(world * boxes);
  return offsets;
}

struct Times {
  std::vector<double> loop;
  std::vector<double> one;
  std::vector<double> two;
  std::size_t pairs = 0;
};

void print(const char* what, std::size_t worlds, const Times& times) {
  const double base = lab::median(times.loop);
  fmt::print("{:<19}{:>10.1f}{:>12.2f}{:>12.2f} ({:.1f}x){:>12.2f} ({:.1f}x)\n", what,
             static_cast<double>(times.pairs) / static_cast<double>(worlds), base, lab::median(times.one),
             base / lab::median(times.one), lab::median(times.two), base / lab::median(times.two));
  std::fflush(stdout);
}

template <int D, typename Real>
void race_search(const char* what, std::size_t worlds, std::size_t boxes, std::size_t rounds) {
  const std::vector<Box<D, Real>> all = make_worlds<D, Real>(worlds, boxes);
  const std::vector<std::size_t> offsets = offsets_of(worlds, boxes);
  Times times;
  for (std::size_t round = 0; round < rounds; ++round) {
    std::vector<Pair> expected;
    expected.reserve(times.pairs);
    lab::Stopwatch watch;
    for (std::size_t world = 0; world < worlds; ++world) {
      const std::vector<Pair> found = find_pairs(std::span(all).subspan(offsets[world], boxes));
      expected.insert(expected.end(), found.begin(), found.end());
    }
    times.loop.push_back(watch.milliseconds());
    watch = {};
    const BatchPairs alone = find_pairs_batch(all, offsets);
    times.one.push_back(watch.milliseconds());
    watch = {};
    const BatchPairs shared = find_pairs_batch(all, offsets, {.algorithm = AutoOptions{.threads = 2}});
    times.two.push_back(watch.milliseconds());
    if (alone.pairs != expected || shared.pairs != expected || alone.offsets != shared.offsets)
      throw std::runtime_error("a batch found other pairs than the loop; expected the same, in its order");
    times.pairs = expected.size();
  }
  print(what, worlds, times);
}

/// The hash of the events of all worlds, whatever their order.
template <typename Begun, typename Ended>
std::uint64_t hash_of_events(std::size_t worlds, const Begun& begun, const Ended& ended) {
  std::uint64_t sum = 0;
  for (std::size_t world = 0; world < worlds; ++world)
    sum += (hash_of(begun(world)) - 3 * hash_of(ended(world))) * (2 * world + 1);
  return sum;
}

template <int D, typename Real>
void race_frames(const char* what, std::size_t worlds, std::size_t boxes, std::size_t rounds) {
  std::vector<Box<D, Real>> all = make_worlds<D, Real>(worlds, boxes);
  const std::vector<std::size_t> offsets = offsets_of(worlds, boxes);
  std::vector<BoxId> changed;
  for (std::size_t i = 0; i < boxes; ++i) changed.push_back(static_cast<BoxId>(i));
  std::vector<Tracker<D, Real>> trackers(worlds);
  BatchTracker<D, Real> alone;
  BatchTracker<D, Real> shared(AutoOptions{.threads = 2});
  lab::Random random(2);
  Times times;
  for (std::size_t round = 0; round <= rounds; ++round) {
    std::vector<std::vector<Pair>> begun(worlds);
    std::vector<std::vector<Pair>> ended(worlds);
    lab::Stopwatch watch;
    for (std::size_t world = 0; world < worlds; ++world) {
      PairCollector to_begun(begun[world]);
      PairCollector to_ended(ended[world]);
      trackers[world].update({std::span(all).subspan(offsets[world], boxes), changed}, to_begun, to_ended);
    }
    const double loop = watch.milliseconds();
    watch = {};
    const BatchEvents one = alone.update(all, offsets);
    const double one_ms = watch.milliseconds();
    watch = {};
    const BatchEvents two = shared.update(all, offsets);
    const double two_ms = watch.milliseconds();
    const auto hash = [&](const BatchEvents& events) {
      return hash_of_events(
          worlds, [&](std::size_t world) { return events.begun.of(world); },
          [&](std::size_t world) { return events.ended.of(world); });
    };
    const std::uint64_t expected = hash_of_events(
        worlds, [&](std::size_t world) { return std::span<const Pair>(begun[world]); },
        [&](std::size_t world) { return std::span<const Pair>(ended[world]); });
    if (hash(one) != expected || hash(two) != expected)
      throw std::runtime_error("a BatchTracker reported other events than the trackers; expected the same");
    times.pairs = alone.pairs().pairs.size();
    for (Box<D, Real>& box : all) {
      for (int axis = 0; axis < D; ++axis) {
        const auto step = static_cast<Real>(random.between(-0.1, 0.1));
        box.min[axis] += step;
        box.max[axis] += step;
      }
    }
    if (round == 0) continue;  // the first frame
    times.loop.push_back(loop);
    times.one.push_back(one_ms);
    times.two.push_back(two_ms);
  }
  print(what, worlds, times);
}

void run(std::size_t worlds, std::size_t boxes, std::size_t rounds) {
  const lab::Machine machine = lab::this_machine();
  fmt::print("{} worlds of {} boxes, {} rounds; {}, {} cores; {}\n", worlds, boxes, rounds, machine.cpu,
             machine.cores, lab::this_build().compiler);
  fmt::print("{:<19}{:>10}{:>12}{:>19}{:>19}\n", "median ms", "pairs each", "loop", "batch, 1 thread",
             "batch, 2 threads");
  race_search<2, float>("find, 2D floats", worlds, boxes, rounds);
  race_search<3, float>("find, 3D floats", worlds, boxes, rounds);
  race_search<2, double>("find, 2D doubles", worlds, boxes, rounds);
  race_search<3, double>("find, 3D doubles", worlds, boxes, rounds);
  race_frames<2, float>("frame, 2D floats", worlds, boxes, rounds);
  race_frames<3, float>("frame, 3D floats", worlds, boxes, rounds);
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("batch", 1, [&] {
    run(number_at(count, arguments, 1, 4096), number_at(count, arguments, 2, 100),
        number_at(count, arguments, 3, 21));
    return 0;
  });
}
