// Many pairs: counting them takes no memory for them, whatever the algorithm.
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/sinks.hpp"

#include "lab/join.hpp"
#include "lab/measure/memory.hpp"

namespace broadside::lab {
namespace {

constexpr std::uint64_t crowd = 3'000;  // whose pairs, kept, would take 36 MB
constexpr std::int64_t max_bytes = 2'000'000;

/// The most that was held while the pairs were counted, the boxes aside.
template <typename Search>
void expect_little_memory(std::uint64_t pairs, const Search& search) {
  PairCounter counter;
  const AllocationMeter meter;
  search(counter);
  if (const auto allocation = meter.read()) {
    EXPECT_LE(allocation->peak, max_bytes);
  }
  EXPECT_EQ(counter.count(), pairs);
}

template <typename Box>
void expect_to_count_without_keeping() {
  Box box;
  box.min.fill(1);
  box.max.fill(1);
  const AnyBoxes points = std::vector<Box>(crowd, box);
  box.max.fill(2);
  const AnyBoxes boxes = std::vector<Box>(crowd, box);
  for (const Algorithm& algorithm : algorithms()) {
    if (algorithm.kind != AlgorithmKind::own) continue;
    SCOPED_TRACE(std::string(algorithm.name) + ", " + std::to_string(dimension(boxes)) + "D, " +
                 std::string(name(precision(boxes))));
    const Entry entry{&algorithm, {algorithm.name, {}}};
    for (const AnyBoxes* const set : {&points, &boxes}) {
      expect_little_memory(crowd * (crowd - 1) / 2, [&](PairSink& pairs) { join(*set, entry, pairs); });
    }
    expect_little_memory(crowd * crowd, [&](PairSink& pairs) { join(points, boxes, entry, pairs); });
  }
}

TEST(CountingPairs, TakesNoMemoryForThem) {
  if (!AllocationMeter().read()) GTEST_SKIP() << "this build does not count allocations";
  expect_to_count_without_keeping<Box2>();
  expect_to_count_without_keeping<Box3>();
  expect_to_count_without_keeping<DoubleBox2>();
  expect_to_count_without_keeping<DoubleBox3>();
}

}  // namespace
}  // namespace broadside::lab
