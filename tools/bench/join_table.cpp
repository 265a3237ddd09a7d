// Joins the uniform data of the SIGMOD 2025 join table: join_table [BOXES [ALGORITHMS [ROUNDS]]].
//
// Two sets of BOXES boxes each (lab/scenes/join_table.hpp), as doubles, which is the type of the table's
// data, and as floats. A call takes both arrays, builds its structures and counts the pairs across the sets;
// the shortest time of the rounds is reported. If the number of pairs is published, a call that finds another
// number fails.
#include "lab/scenes/join_table.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "broadside/broadside.hpp"

#include "bench/guarded.hpp"
#include "lab/catalogue.hpp"
#include "lab/measure/benchmark.hpp"
#include "lab/numbers.hpp"
#include "lab/report/machine.hpp"

namespace broadside::bench {
namespace {

/// By the number of boxes in each set. Sizes without an entry expect the count of the first call.
std::map<std::size_t, std::uint64_t> expected_pairs = {{1'000'000, 40'428}, {10'000'000, 4'040'818}};

template <typename Real>
std::vector<Box<2, Real>> set_of(std::size_t count, std::uint32_t seed) {
  std::vector<Box<2, Real>> boxes(count);
  const std::vector<DoubleBox2> exact = lab::join_table_set(count, seed);
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < 2; ++axis) {
      boxes[i].min[axis] = static_cast<Real>(exact[i].min[axis]);
      boxes[i].max[axis] = static_cast<Real>(exact[i].max[axis]);
    }
  }
  return boxes;
}

template <typename Real>
void measure(std::size_t count, const std::vector<lab::Entry>& entries, std::size_t rounds) {
  const auto left = set_of<Real>(count, lab::join_table_left);
  const auto right = set_of<Real>(count, lab::join_table_right);
  for (const lab::Entry& entry : entries) {
    if (!entry.algorithm->has_dimension(2)) continue;
    Finder<2, Real> finder(*entry.algorithm, entry.spec);
    double min_ms = std::numeric_limits<double>::infinity();
    for (std::size_t round = 0; round < rounds; ++round) {
      PairCounter pairs;
      const lab::Stopwatch watch;
      finder.find_between(left, right, pairs);
      min_ms = std::min(min_ms, watch.milliseconds());
      const std::uint64_t expected = expected_pairs.try_emplace(count, pairs.count()).first->second;
      if (pairs.count() != expected)
        throw std::runtime_error(fmt::format("{}: {} pairs; expected {}", entry.spec.text(),
                                             lab::grouped(pairs.count()), lab::grouped(expected)));
    }
    fmt::print("{:<6}  {:<30} {:>14} {:>10.1f}\n", sizeof(Real) == sizeof(float) ? "float" : "double",
               entry.spec.text(), lab::grouped(expected_pairs[count]), min_ms);
    std::fflush(stdout);
  }
}

void run(std::size_t count, const std::string& algorithms, std::size_t rounds) {
  const lab::Machine machine = lab::this_machine();
  fmt::print("{} x {} boxes; {}, {} cores; {}\n", lab::grouped(count), lab::grouped(count), machine.cpu,
             machine.cores, lab::this_build().compiler);
  fmt::print("{:<6}  {:<30} {:>14} {:>10}\n", "", "algorithm", "pairs", "ms");
  const lab::Catalogue catalogue;
  const std::vector<lab::Entry> entries = catalogue.select(algorithms);
  measure<double>(count, entries, rounds);
  measure<float>(count, entries, rounds);
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("join_table", 1, [&] {
    run(number_at(count, arguments, 1, 1'000'000),
        text_at(count, arguments, 2, "auto,auto:threads=0,grid,sweep_and_prune,bvh,literature"),
        number_at(count, arguments, 3, 3));
    return 0;
  });
}
