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

TEST(QuadtreeSizesExperiment, IsConfirmedWhereLargeBoxesPropagateFourfoldAndFillTheTree) {
  const Finding finding = judged("quadtree_sizes", {levels(3.88), sizes(10)});
  for (const char* const statement : {"unit_size", "fourfold", "book_keeping"})
    EXPECT_EQ(verdict(finding, statement), "confirmed");
  EXPECT_NE(finding.reason.find("3.88 times"), std::string::npos) << finding.reason;
  EXPECT_NE(finding.reason.find("10.0 times"), std::string::npos) << finding.reason;
}

TEST(QuadtreeSizesExperiment, IsRefutedWhereALargeBoxPropagatesLessOrMore) {
  EXPECT_EQ(verdict(judged("quadtree_sizes", {levels(1.5), sizes(10)}), "fourfold"), "refuted");
  EXPECT_EQ(verdict(judged("quadtree_sizes", {levels(5), sizes(10)}), "fourfold"), "refuted");
}

TEST(QuadtreeSizesExperiment, IsRefutedWhereBoxesOfAUnitPropagateAsWell) {
  Table small = levels(3.88);
  small.rows[1][2] = 3.5;
  EXPECT_EQ(verdict(judged("quadtree_sizes", {small, sizes(10)}), "unit_size"), "refuted");
}

TEST(QuadtreeSizesExperiment, IsABurdenOnlyWhereThereAreMoreWhereOneInAHundredIsNone) {
  EXPECT_EQ(verdict(judged("quadtree_sizes", {levels(3.88), sizes(1.1)}), "book_keeping"),
            "holds within bounds: more than one box in a hundred is large");
}

/// A density: what leaves of 8 take over the best ones.
struct Density {
  double neighbours;
  double references;
  double time;
  double best_capacity;
};

Table capacities(const char* name, const std::vector<Density>& densities) {
  Table table{.name = name,
              .title = {},
              .columns = {{"neighbours"}, {"capacity"}, {"tests a box"}, {"references a box"}}};
  append(table.columns, ratio_columns("time over best"));
  for (const Density& density : densities) {
    for (const double capacity : {8.0, 32.0, 128.0, 512.0}) {
      const bool is_best = capacity == density.best_capacity;
      std::vector<Cell> row = {density.neighbours, capacity, capacity,
                               capacity == 8 ? density.references : 1.0};
      append(row, ratio(is_best ? 1 : capacity == 8 ? density.time : 2));
      table.add(row);
    }
  }
  return table;
}

Table own() { return capacities("own", {{1, 2, 2, 512}, {64, 4, 2, 512}}); }

TEST(QuadtreeCapacityExperiment, IsConfirmedWhereLargerLeavesAlleviateAllDenseWorlds) {
  const Finding finding =
      judged("quadtree_capacity",
             {capacities("paper", {{1, 1.5, 1.2, 32}, {16, 10, 2, 32}, {64, 12, 3, 128}}), own()});
  EXPECT_EQ(verdict(finding, "references"), "confirmed");
  EXPECT_EQ(verdict(finding, "larger_leaves"), "confirmed");
  EXPECT_NE(finding.reason.find("smallest leaf within 10 % of the best time from 32 to 128 boxes"),
            std::string::npos)
      << finding.reason;
}

TEST(QuadtreeCapacityExperiment, HoldsWhenTheDensestWorldsAreNotAlleviatedAnyMore) {
  const Finding finding =
      judged("quadtree_capacity",
             {capacities("paper", {{1, 1.5, 1.4, 32}, {16, 10, 2, 32}, {64, 12, 1.1, 128}}), own()});
  EXPECT_TRUE(verdict(finding, "larger_leaves")
                  .starts_with("holds within bounds: a box overlaps from 1 to 16 others"))
      << verdict(finding, "larger_leaves");
}

TEST(QuadtreeCapacityExperiment, IsRefutedWhereSmallLeavesAreTheBestOrDenseWorldsHaveNoMoreReferences) {
  const Finding small =
      judged("quadtree_capacity", {capacities("paper", {{1, 1.5, 1, 8}, {64, 12, 1, 8}}), own()});
  EXPECT_EQ(verdict(small, "references"), "confirmed");
  EXPECT_EQ(verdict(small, "larger_leaves"), "refuted");
  const Finding sparse =
      judged("quadtree_capacity", {capacities("paper", {{1, 1.5, 3, 32}, {64, 1.6, 3, 32}}), own()});
  EXPECT_EQ(verdict(sparse, "references"), "refuted");
  EXPECT_EQ(verdict(sparse, "larger_leaves"), "refuted");
}

}  // namespace
}  // namespace broadside::lab
