// The memory that a search takes beyond its boxes and pairs, by however many threads.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

#include "lab/measure/memory.hpp"
#include "lab/scenes/random.hpp"
#include "tests/support/executors.hpp"

namespace broadside::lab {
namespace {

constexpr std::int64_t max_waiting = std::int64_t{64} << 20;
constexpr std::int64_t max_bytes_per_box = 200;

class SearchMemory : public testing::Test {
 protected:
  void SetUp() override {
    if (!AllocationMeter().read()) GTEST_SKIP() << "this build does not count allocations";
  }
};

/// The most that was held while `auto` searched with three threads, all of them new to it.
template <int D, typename Real>
std::int64_t peak_of(const std::vector<Box<D, Real>>& boxes, Executor& executor, PairSink& pairs) {
  const AllocationMeter meter;
  Finder<D, Real> finder("auto");
  finder.set_workers({.threads = 3, .executor = &executor, .boxes_per_thread = 1});
  finder.find(boxes, pairs);
  return meter.read()->peak;
}

TEST_F(SearchMemory, IsBoundedWhereThreadsFindMorePairsThanWait) {
  const std::vector<Box2> boxes(20'000, Box2{{0, 0}, {1, 1}});
  const auto count = static_cast<std::int64_t>(boxes.size());
  laws::ThreadExecutor threads;
  laws::TeamExecutor team;
  for (Executor* const executor : {static_cast<Executor*>(&threads), static_cast<Executor*>(&team)}) {
    std::int64_t pairs = 0;
    PairFunction function(
        [&pairs](std::span<const Pair> chunk) { pairs += static_cast<std::int64_t>(chunk.size()); });
    EXPECT_LE(peak_of(boxes, *executor, function), max_waiting + count * max_bytes_per_box);
    EXPECT_EQ(pairs, count * (count - 1) / 2);
    PairCounter counter;
    EXPECT_LE(peak_of(boxes, *executor, counter), count * max_bytes_per_box);
  }
}

/// Boxes about many powers of two: nearly all are in one cell, however many cells there are.
template <int D, typename Real>
std::vector<Box<D, Real>> nested_boxes(std::size_t count) {
  Random random(1);
  std::vector<Box<D, Real>> boxes(count);
  for (Box<D, Real>& box : boxes) {
    const double size = std::ldexp(1.0, -static_cast<int>(random.below(40)));
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = static_cast<Real>(size * random.between(1, 2));
      box.max[axis] = box.min[axis] + static_cast<Real>(size * 1e-3);
    }
  }
  return boxes;
}

template <int D, typename Real>
void expect_little_for_nested_boxes() {
  const std::vector<Box<D, Real>> boxes = nested_boxes<D, Real>(100'000);
  laws::TeamExecutor team;
  PairCounter pairs;
  EXPECT_LE(peak_of(boxes, team, pairs), static_cast<std::int64_t>(boxes.size()) * max_bytes_per_box);
}

TEST_F(SearchMemory, IsBoundedWhereBoxesCrowdInACell) {
  expect_little_for_nested_boxes<2, float>();
  expect_little_for_nested_boxes<3, float>();
  expect_little_for_nested_boxes<2, double>();
  expect_little_for_nested_boxes<3, double>();
}

}  // namespace
}  // namespace broadside::lab
