// Memory of each of our algorithms for many boxes: scale [BOXES [SCENE [ALGORITHMS]]].
//
// One call each, by a new finder. The pairs are hashed and not kept, so the figure is the memory of the call
// beyond its input and output. All must find the same pairs.
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "broadside/broadside.hpp"

#include "bench/guarded.hpp"
#include "lab/catalogue.hpp"
#include "lab/measure/benchmark.hpp"
#include "lab/measure/memory.hpp"
#include "lab/numbers.hpp"
#include "lab/report/machine.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::bench {
namespace {

template <int D>
void measure(const lab::NamedScene& named, std::size_t boxes, const std::string& algorithms) {
  const lab::History<D> input =
      lab::make_history<D>(named.scene, named.spec, {.boxes = boxes, .seed = 1, .frames = 0, .moving = 0});
  const lab::Catalogue catalogue;
  const auto count = static_cast<double>(input.boxes.size());
  std::uint64_t expected = 0;
  for (const lab::Entry& entry : catalogue.select(algorithms)) {
    // Quadratic: it compares each box with every other.
    if (algorithms == "own" && entry.spec.text() == "brute_force") continue;
    PairHasher pairs;
    const lab::AllocationMeter meter;
    Finder<D> finder(*entry.algorithm, entry.spec);
    const lab::Stopwatch watch;
    finder.find(input.boxes, pairs);
    const double milliseconds = watch.milliseconds();
    const auto memory = meter.read();
    if (expected != 0 && pairs.hash() != expected)
      throw std::runtime_error(
          fmt::format("{}: {} pairs; expected the pairs that the algorithm before it found",
                      entry.spec.text(), pairs.count()));
    expected = pairs.hash();
    fmt::print("{}D  {:<20} {:>14} {:>8.2f} {:>9.1f} {:>12.1f} {:>7.1f}\n", D, entry.spec.text(),
               lab::grouped(pairs.count()), milliseconds / 1e3, milliseconds * 1e6 / count,
               memory ? static_cast<double>(memory->kept) / count : 0,
               memory ? static_cast<double>(memory->peak) / count : 0);
    std::fflush(stdout);
  }
}

void run(std::size_t boxes, const std::string& scene, const std::string& algorithms) {
  const lab::NamedScene named = lab::find_scene(scene);
  const lab::Machine machine = lab::this_machine();
  fmt::print("{}, {} boxes; {}, {} cores; {}\n", scene, lab::grouped(boxes), machine.cpu, machine.cores,
             lab::this_build().compiler);
  fmt::print("    {:<20} {:>14} {:>8} {:>9} {:>12} {:>7}\n", "algorithm", "pairs", "s", "ns a box",
             "bytes a box", "at peak");
  measure<2>(named, boxes, algorithms);
  measure<3>(named, boxes, algorithms);
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("scale", 1, [&] {
    run(number_at(count, arguments, 1, 10'000'000), text_at(count, arguments, 2, "uniform"),
        text_at(count, arguments, 3, "own"));
    return 0;
  });
}
