// The typed options of the library's algorithms: what they convert to, and what is refused.
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/error.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"
#include "broadside/spec.hpp"
#include "broadside/tracker.hpp"
#include "broadside/world.hpp"

namespace broadside {
namespace {

TEST(TypedOptions, ConvertToTheSpecThatATextGives) {
  EXPECT_EQ(Spec(AutoOptions{}).text(), "auto");
  EXPECT_EQ(Spec(AutoOptions{.threads = 0}).text(), "auto:threads=0");
  EXPECT_EQ(Spec(BruteForceOptions{.update = Update::rebuild}).text(), "brute_force:update=rebuild");
  EXPECT_EQ(Spec(GridOptions{.cell = 2.5, .update = Update::follow}).text(), "grid:update=follow:cell=2.5");
  EXPECT_EQ(Spec(SweepAndPruneOptions{.axis = Axis::z, .is_striped = false}).text(),
            "sweep_and_prune:axis=z:axes=1");
  EXPECT_EQ(Spec(QuadtreeOptions{.capacity = 32, .threads = 2}).text(), "quadtree:threads=2:capacity=32");
  EXPECT_EQ(Spec(BvhOptions{}).text(), "bvh");
}

TEST(TypedOptions, KeepANumberExactly) {
  const double cell = 0.1 + 0.2;
  const Spec spec = GridOptions{.cell = cell};
  const Algorithm& grid = *find_algorithm("grid");
  EXPECT_EQ(Settings(spec, grid.tunables).number("cell"), cell);
  EXPECT_EQ(Settings(Spec(spec.text()), grid.tunables).number("cell"), cell);
}

TEST(TypedOptions, AreTakenWhereverASpecIs) {
  const std::vector<Box2> boxes = {{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}, {{9, 9}, {9, 9}}};
  const std::vector<Pair> expected = {{BoxId{0}, BoxId{1}}};
  EXPECT_EQ(find_pairs(boxes, {.algorithm = GridOptions{.cell = 2.5}}), expected);

  std::vector<Pair> found;
  Finder<2> finder(QuadtreeOptions{.capacity = 1});
  finder.find(boxes, [&](Pair pair) { found.push_back(pair); });
  EXPECT_EQ(found, expected);

  std::vector<Pair> begun;
  Tracker<2> tracker(BvhOptions{.threads = 2, .update = Update::follow});
  EXPECT_EQ(tracker.workers().threads, 2U);
  tracker.update(
      {.boxes = boxes}, [&](Pair pair) { begun.push_back(pair); }, [](Pair) {});
  EXPECT_EQ(begun, expected);

  World2 world({.algorithm = SweepAndPruneOptions{.axis = Axis::y}});
  for (const Box2& box : boxes) world.add(box);
  EXPECT_EQ(world.update().begun.size(), 1U);
}

/// The message with which a spec is refused; empty if it is not.
template <int D>
std::string refusal(const Spec& spec) {
  try {
    Finder<D> finder(spec);
  } catch (const InvalidSpec& error) {
    return error.what();
  }
  return {};
}

TEST(TypedOptions, AreRefusedWithTheValueFoundAndTheValuesExpected) {
  const auto names = [](const std::string& message, const char* value) {
    return message.find(value) != std::string::npos && message.find("expected") != std::string::npos;
  };
  EXPECT_PRED2(names, refusal<2>(GridOptions{.cell = 0}), "cell is '0'");
  EXPECT_PRED2(names, refusal<2>(GridOptions{.cell = -1}), "cell is '-1'");
  EXPECT_PRED2(names, refusal<2>(GridOptions{.cell = std::numeric_limits<double>::quiet_NaN()}), "nan");
  EXPECT_PRED2(names, refusal<2>(GridOptions{.cell = std::numeric_limits<double>::infinity()}), "inf");
  EXPECT_PRED2(names, refusal<2>(QuadtreeOptions{.capacity = 0}), "capacity is '0'");
  EXPECT_PRED2(names, refusal<2>(AutoOptions{.threads = static_cast<std::size_t>(-1)}), "threads is '");
  EXPECT_PRED2(names, refusal<2>(SweepAndPruneOptions{.axis = Axis::z}), "axis is 'z'");
  EXPECT_EQ(refusal<3>(SweepAndPruneOptions{.axis = Axis::z}), "");
  EXPECT_PRED2(names, refusal<3>(SweepAndPruneOptions{.axis = Axis{5}}), "axis is '5'");
  EXPECT_PRED2(names, refusal<2>(BvhOptions{.update = Update{9}}), "update is '9'");
  EXPECT_PRED2(names, refusal<2>(Spec("grid", {{"cell", 2}, {"cell", 3}})), "cell is given twice");
}

}  // namespace
}  // namespace broadside
