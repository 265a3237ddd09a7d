// Many small worlds in one call, compared with a loop over find_pairs(): batch [WORLDS [BOXES [ROUNDS]]].
//
// Both find the same pairs of the same worlds in turns. The pairs must be the same, in the same order.
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "broadside/broadside.hpp"

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

template <int D, typename Real>
void race(const char* what, std::size_t worlds, std::size_t boxes, std::size_t rounds) {
  const std::vector<Box<D, Real>> all = make_worlds<D, Real>(worlds, boxes);
  std::vector<std::size_t> offsets;
  for (std::size_t world = 0; world <= worlds; ++world) offsets.push_back(world * boxes);
  std::vector<double> loop;
  std::vector<double> one;
  std::vector<double> two;
  std::size_t pairs = 0;
  for (std::size_t round = 0; round < rounds; ++round) {
    std::vector<Pair> expected;
    expected.reserve(pairs);
    lab::Stopwatch watch;
    for (std::size_t world = 0; world < worlds; ++world) {
      const std::vector<Pair> found = find_pairs(std::span(all).subspan(offsets[world], boxes));
      expected.insert(expected.end(), found.begin(), found.end());
    }
    loop.push_back(watch.milliseconds());
    watch = {};
    const BatchPairs alone = find_pairs_batch(all, offsets);
    one.push_back(watch.milliseconds());
    watch = {};
    const BatchPairs shared = find_pairs_batch(all, offsets, {.algorithm = AutoOptions{.threads = 2}});
    two.push_back(watch.milliseconds());
    if (alone.pairs != expected || shared.pairs != expected || alone.offsets != shared.offsets)
      throw std::runtime_error("a batch found other pairs than the loop; expected the same, in its order");
    pairs = expected.size();
  }
  const double base = lab::median(loop);
  fmt::print("{:<12}{:>10.1f}{:>12.2f}{:>12.2f} ({:.1f}x){:>12.2f} ({:.1f}x)\n", what,
             static_cast<double>(pairs) / static_cast<double>(worlds), base, lab::median(one),
             base / lab::median(one), lab::median(two), base / lab::median(two));
  std::fflush(stdout);
}

void run(std::size_t worlds, std::size_t boxes, std::size_t rounds) {
  const lab::Machine machine = lab::this_machine();
  fmt::print("{} worlds of {} boxes, {} rounds; {}, {} cores; {}\n", worlds, boxes, rounds, machine.cpu,
             machine.cores, lab::this_build().compiler);
  fmt::print("{:<12}{:>10}{:>12}{:>19}{:>19}\n", "median ms", "pairs each", "loop", "batch, 1 thread",
             "batch, 2 threads");
  race<2, float>("2D floats", worlds, boxes, rounds);
  race<3, float>("3D floats", worlds, boxes, rounds);
  race<2, double>("2D doubles", worlds, boxes, rounds);
  race<3, double>("3D doubles", worlds, boxes, rounds);
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
