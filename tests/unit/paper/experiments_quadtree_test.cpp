// The verdicts of the experiments on quadtrees follow from their tables.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/paper/judged.hpp"

namespace broadside::lab {
namespace {

/// A box of 1 and one of 64 units in leaves of 2 and of 1; the larger one comes to `factor` times as many.
Table levels(double factor) {
  Table table{.name = "levels",
              .title = {},
              .columns = {{"size"}, {"leaves"}, {"leaves over the level above"}, {"(1 + size / side)^2"}}};
  table.add({1.0, 2.25, Cell(), 2.25});
  table.add({1.0, 4.0, 4 / 2.25, 4.0});
  table.add({64.0, 1089.0, Cell(), 1089.0});
  table.add({64.0, 1089 * factor, factor, 4225.0});
  return table;
}

/// What `growth` times as many references come of.
Table sizes(double growth) {
  Table table{.name = "sizes",
              .title = {},
              .columns = {{"size of a large box"},
                          {"algorithm"},
                          {"pairs a box"},
                          {"references a box"},
                          {"time"},
                          {"peak memory"}}};
  for (const double size : {0.5, 32.0}) {
    for (const std::string name : {"paper_quadtree", "quadtree", "grid", "sweep_and_prune"}) {
      const double references = size == 32 && name == "paper_quadtree" ? growth : 1;
      table.add({size, name, size, references, 2 * references, 1000 * references});
    }
  }
  return table;
}

TEST(QuadtreeSizesExperiment, HoldsWhereLargeBoxesPropagateFourfoldAndFillTheTree) {
  const Finding finding = judged("quadtree_sizes", {levels(3.88), sizes(10)});
  EXPECT_EQ(finding.verdict, Verdict::holds);
  EXPECT_NE(finding.reason.find("3.88 times"), std::string::npos) << finding.reason;
  EXPECT_NE(finding.reason.find("10.0 times"), std::string::npos) << finding.reason;
}

TEST(QuadtreeSizesExperiment, DoesNotHoldWhereALargeBoxPropagatesLessOrMore) {
  EXPECT_EQ(judged("quadtree_sizes", {levels(1.5), sizes(10)}).verdict, Verdict::does_not_hold);
  EXPECT_EQ(judged("quadtree_sizes", {levels(5), sizes(10)}).verdict, Verdict::does_not_hold);
}

TEST(QuadtreeSizesExperiment, HoldsWhenThereAreMoreWhereOneInAHundredIsNoBurden) {
  EXPECT_EQ(judged("quadtree_sizes", {levels(3.88), sizes(1.1)}).verdict_text(),
            "holds when more than one box in a hundred is large");
}

/// A density: what leaves of 8 and the best ones take.
struct Density {
  double neighbours;
  double references;
  double time;
  double best_capacity;
  double best_time = 1;
};

Table capacities(const char* name, const std::vector<Density>& densities) {
  Table table{.name = name,
              .title = {},
              .columns = {{"neighbours"}, {"capacity"}, {"tests a box"}, {"references a box"}, {"time"}}};
  for (const Density& density : densities) {
    for (const double capacity : {8.0, 32.0, 128.0, 512.0}) {
      const bool is_best = capacity == density.best_capacity;
      const double time = is_best ? density.best_time : capacity == 8 ? density.time : 2 * density.best_time;
      table.add({density.neighbours, capacity, capacity, capacity == 8 ? density.references : 1.0, time});
    }
  }
  return table;
}

Table own() { return capacities("own", {{1, 2, 2, 512}, {64, 4, 2, 512}}); }

TEST(QuadtreeCapacityExperiment, HoldsWhereLargerLeavesAlleviateAllDenseWorlds) {
  const Finding finding =
      judged("quadtree_capacity",
             {capacities("paper", {{1, 1.5, 1.2, 32}, {16, 10, 2, 32}, {64, 12, 3, 128}}), own()});
  EXPECT_EQ(finding.verdict, Verdict::holds);
  EXPECT_NE(finding.reason.find("smallest leaf within 10 % of the best time from 32 to 128 boxes"),
            std::string::npos)
      << finding.reason;
}

TEST(QuadtreeCapacityExperiment, HoldsWhenTheDensestWorldsAreNotAlleviatedAnyMore) {
  const Finding finding =
      judged("quadtree_capacity",
             {capacities("paper", {{1, 1.5, 1.4, 32}, {16, 10, 2, 32}, {64, 12, 1.1, 128}}), own()});
  EXPECT_EQ(finding.verdict, Verdict::holds_when);
  EXPECT_EQ(finding.condition.find("a box overlaps from 1 to 16 others"), 0U) << finding.condition;
}

TEST(QuadtreeCapacityExperiment, DoesNotHoldWhereSmallLeavesAreTheBestOrDenseWorldsHaveNoMoreReferences) {
  EXPECT_EQ(
      judged("quadtree_capacity", {capacities("paper", {{1, 1.5, 1, 8}, {64, 12, 1, 8}}), own()}).verdict,
      Verdict::does_not_hold);
  EXPECT_EQ(
      judged("quadtree_capacity", {capacities("paper", {{1, 1.5, 3, 32}, {64, 1.6, 3, 32}}), own()}).verdict,
      Verdict::does_not_hold);
}

}  // namespace
}  // namespace broadside::lab
