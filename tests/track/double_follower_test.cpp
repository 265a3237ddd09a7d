// DoubleFollower: what it costs where boxes move to where their floats no longer tell them apart.
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "tests/support/rng.hpp"

namespace broadside {
namespace {

TEST(DoubleFollower, BoundsFalseCandidatesWithinAFrame) {
  constexpr std::size_t count = 20'000;
  constexpr std::size_t movers = 4'000;
  Rng random(1);
  const auto anywhere = [&](double from, double side) -> Box<2, double> {
    const double x = from + side * static_cast<double>(random.unit());
    const double y = from + side * static_cast<double>(random.unit());
    return {{x, y}, {x + 1, y + 1}};
  };
  std::vector<Box<2, double>> boxes;
  for (std::size_t i = 0; i < count; ++i) boxes.push_back(anywhere(0, 1000));
  Tracker<2, double> tracker("auto:update=follow");
  Tracker<2, double> expected("grid:update=rebuild");
  std::vector<BoxId> changed;
  for (int frame = 0; frame < 4; ++frame) {
    PairHasher begun;
    PairHasher ended;
    const auto statistics = tracker.update({boxes, changed}, begun, ended);
    PairHasher expected_begun;
    PairHasher expected_ended;
    expected.update({boxes, changed}, expected_begun, expected_ended);
    EXPECT_EQ(begun.hash(), expected_begun.hash()) << frame;
    EXPECT_EQ(ended.hash(), expected_ended.hash()) << frame;
    EXPECT_LT(statistics->hits, 64 * count) << frame;
    // So far away that all of them have a few coordinates as floats, in a rounding made for where they were.
    changed.clear();
    for (std::size_t i = 0; i < movers; ++i) {
      boxes[i] = anywhere(frame % 2 == 0 ? 1e10 : 0, 1000);
      changed.push_back(BoxId(i));
    }
  }
}

}  // namespace
}  // namespace broadside
