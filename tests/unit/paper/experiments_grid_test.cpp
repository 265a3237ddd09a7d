// What the experiments on brute force and grids (sections II and III of the paper) make of tables made by
// hand.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/paper/judged.hpp"

namespace broadside::lab {
namespace {

// Experiment 1.

/// Brute force that takes this share of the tests that it should, in time that grows with this exponent.
Table brute_force(double share, double exponent) {
  Table table{.name = "tests",
              .title = "",
              .columns = {{"boxes"}, {"all pairs"}, {"unique pairs"}, {"tests"}, {"time"}}};
  for (const double n : {1000.0, 2000.0, 4000.0})
    table.add({n, n * n, n * (n - 1) / 2, share * n * (n - 1) / 2, std::pow(n, exponent)});
  return table;
}

TEST(BruteForceTests, AreATautologyWhereTheListingTestsUniquePairs) {
  const Finding finding = judged("brute_force_tests", {brute_force(1, 2)});
  EXPECT_TRUE(verdict(finding, "unique_pairs").starts_with("not testable: a tautology"));
  EXPECT_EQ(verdict(finding, "quadratic"), "confirmed");
}

TEST(BruteForceTests, AreRefutedWhereTheListingTestsOthersOrTimeGrowsOtherwise) {
  EXPECT_EQ(verdict(judged("brute_force_tests", {brute_force(2, 2)}), "unique_pairs"), "refuted");
  EXPECT_EQ(verdict(judged("brute_force_tests", {brute_force(1, 1.5)}), "quadratic"), "refuted");
}

// Experiment 2.

using Curve = std::function<double(double boxes)>;

/// A table of experiment 2: brute force, and the others, whose tests a box and time a box are given.
Table race(const std::string& name, const std::string& brute_force, const std::vector<std::string>& others,
           const Curve& tests, const Curve& time) {
  Table table{.name = name, .title = "", .columns = {{"boxes"}, {"algorithm"}, {"tests a box"}, {"time"}}};
  for (double n = 8; n <= 2048; n *= 2) {
    table.add({n, brute_force, (n - 1) / 2, n * n / 1e6});
    for (const std::string& other : others) table.add({n, other, tests(n), time(n) * n / 1e6});
  }
  return table;
}

std::vector<Table> races(const Curve& tests, const Curve& time) {
  const std::vector<std::string> ours = {"grid", "sweep_and_prune", "quadtree", "bvh"};
  return {race("paper", "paper_brute_force", {"paper_grid", "paper_sweep_and_prune", "paper_quadtree"}, tests,
               time),
          race("ours", "brute_force", ours, tests, time), race("ours_3d", "brute_force", ours, tests, time)};
}

TEST(Overtaking, HoldsFromWhereTheOthersAreFaster) {
  const Finding finding =
      judged("overtaking", races([](double) { return 8.0; }, [](double) { return 100.0; }));
  EXPECT_EQ(verdict(finding, "collections"), "confirmed");
  EXPECT_EQ(verdict(finding, "quadratic"), "not testable: a tautology, as in claim 1");
  EXPECT_EQ(verdict(finding, "overtaking"), "holds within bounds: there are more than about 100 boxes");
  EXPECT_NEAR(figure(finding, "paper_grid_from"), 100, 1e-6);
  EXPECT_NEAR(figure(finding, "bvh_3d_from"), 100, 1e-6);
  EXPECT_NEAR(figure(finding, "paper_grid_tests_growth"), 0, 1e-6);
}

TEST(Overtaking, IsConfirmedWhereTheOthersAreFasterFromTheFewestOn) {
  const Finding finding = judged("overtaking", races([](double) { return 8.0; }, [](double) { return 1.0; }));
  EXPECT_EQ(verdict(finding, "overtaking"), "confirmed");
}

TEST(Overtaking, IsRefutedWhereOneIsNeverFasterOrTestsGrowAsInBruteForce) {
  const Finding slow =
      judged("overtaking", races([](double) { return 8.0; }, [](double n) { return 2 * n; }));
  EXPECT_EQ(verdict(slow, "overtaking"), "refuted");
  EXPECT_EQ(verdict(slow, "collections"), "confirmed");
  EXPECT_NE(slow.reason.find("paper_grid never"), std::string::npos) << slow.reason;
  const Finding crowded =
      judged("overtaking", races([](double n) { return n / 4; }, [](double) { return 1.0; }));
  EXPECT_EQ(verdict(crowded, "collections"), "refuted");
}

TEST(Overtaking, NamesTheAlgorithmsWhoseCollectionsAreSmaller) {
  std::vector<Table> tables = races([](double) { return 8.0; }, [](double) { return 1.0; });
  for (std::vector<Cell>& row : tables[0].rows) {
    if (row[1] == Cell("paper_sweep_and_prune")) row[2] = std::get<double>(row[0]);
  }
  EXPECT_EQ(verdict(judged("overtaking", tables), "collections"),
            "holds within bounds: the algorithm is paper_grid or paper_quadtree");
}

// Experiment 3.

/// Worlds of 32, 64, ... cells on a side. A matrix takes `cell_bytes` for each cell up to the cap; its boxes
/// are tested as often as `tests` says.
std::vector<Table> worlds(double cell_bytes, const Curve& tests) {
  Table cells{.name = "cells", .title = "", .columns = {{"world over cell"}, {"kept"}, {"cells"}}};
  Table grids{.name = "grids",
              .title = "",
              .columns = {{"world over cell"}, {"grid"}, {"memory"}, {"tests a box"}, {"time"}}};
  for (double world = 32; world <= 4096; world *= 2) {
    cells.add({world, "in a matrix", world * world});
    cells.add({world, "in a hash", 900.0});
    const double capped = std::min(world, 256.0);
    grids.add({world, "paper_grid:cell=2", 5000 + cell_bytes * capped * capped, tests(world), 1.0});
    for (const char* grid : {"grid", "grid in 3D"}) grids.add({world, grid, 90e3, 10.0, 1.0});
  }
  return {cells, grids};
}

TEST(GridMemory, CallsTheGrowthOfAMatrixATautologyAndItsCapADefeat) {
  const Finding finding = judged("grid_memory", worlds(24, [](double world) { return world; }));
  EXPECT_TRUE(verdict(finding, "matrix").starts_with("not testable: a tautology"))
      << verdict(finding, "matrix");
  EXPECT_EQ(verdict(finding, "purpose"), "confirmed");
  EXPECT_NEAR(figure(finding, "bytes_a_cell"), 24, 1e-6);
  EXPECT_NEAR(figure(finding, "largest_matrix_bytes"), 24 * 4096.0 * 4096.0, 1);
  EXPECT_NEAR(figure(finding, "full_at_world"), std::sqrt(16e9 / 24), 1);
  EXPECT_EQ(figure(finding, "grid_memory_growth"), 1);
}

TEST(GridMemory, IsNotDefeatedWhereLargeCellsCostNoTests) {
  EXPECT_EQ(verdict(judged("grid_memory", worlds(24, [](double) { return 8.0; })), "purpose"), "refuted");
}

TEST(GridMemory, IsRefutedWhereMemoryIsThatOfTheBoxes) {
  EXPECT_EQ(verdict(judged("grid_memory", worlds(0, [](double world) { return world; })), "matrix"),
            "refuted");
}

// Experiment 4.

/// Shares of adding, in percent, by the number of neighbours, the same for cells of every size.
std::vector<Table> shares(const Curve& kept, const Curve& anew, double references = 1) {
  Table shares{.name = "shares",
               .title = "",
               .columns = {{"scene"},
                           {"neighbours"},
                           {"cells across a box"},
                           {"references a box"},
                           {"tests a box"},
                           {"adding"},
                           {"adding to new cells"}}};
  Table grids{.name = "grids", .title = "", .columns = {{"cells across a box"}, {"grid"}, {"time"}}};
  for (const double neighbours : {1.0, 4.0, 16.0, 64.0}) {
    for (double across = 1; across <= 16; across *= 2) {
      // Where cells are large, nothing is as in the small ones that the claim is about.
      const bool is_large = across < 8;
      shares.add({"uniform:neighbours=" + std::to_string(neighbours), neighbours, across,
                  references * across * across, across, is_large ? 0 : kept(neighbours),
                  is_large ? 0 : anew(neighbours)});
    }
  }
  for (const double across : {1.0, 4.0}) {
    grids.add({across, "paper_grid", across});
    grids.add({across, "grid", 1.0});
  }
  return {shares, grids};
}

const Curve all = [](double) { return 90.0; };
const Curve none = [](double) { return 5.0; };
const Curve half_at_eight = [](double neighbours) { return 50 * std::sqrt(8 / neighbours); };

TEST(GridSpanning, IsConfirmedWhereMostTimeGoesIntoAdding) {
  const Finding finding = judged("grid_spanning", shares(all, all));
  EXPECT_EQ(verdict(finding, "adding"), "confirmed");
  EXPECT_EQ(verdict(finding, "slots"), "confirmed");
  EXPECT_NEAR(figure(finding, "references_growth"), 2, 1e-6);
  EXPECT_NEAR(figure(finding, "tests_growth"), 1, 1e-6);
  EXPECT_EQ(figure(finding, "paper_grid_time_over_1_cell_across"), 4);
}

TEST(GridSpanning, HoldsUpToSomeDensity) {
  EXPECT_EQ(verdict(judged("grid_spanning", shares(half_at_eight, all)), "adding"),
            "holds within bounds: a box touches fewer than about 8.00 others");
}

TEST(GridSpanning, HoldsForNewCellsOnly) {
  EXPECT_EQ(verdict(judged("grid_spanning", shares(none, all)), "adding"),
            "holds within bounds: each search makes its cells anew");
  EXPECT_EQ(verdict(judged("grid_spanning", shares(none, half_at_eight)), "adding"),
            "holds within bounds: each search makes its cells anew, and a box touches fewer than about 8.00 "
            "others");
}

TEST(GridSpanning, IsRefutedWhereTestsTakeMost) {
  EXPECT_EQ(verdict(judged("grid_spanning", shares(none, none)), "adding"), "refuted");
}

TEST(GridSpanning, CountsTheCellsOfABox) {
  EXPECT_EQ(
      verdict(judged("grid_spanning", shares(all, all, 1.13)), "slots"),
      "holds within bounds: boxes are much longer than cells; 16.0 cells long they are in 1.13 times as many "
      "(erratum T3)");
  EXPECT_EQ(verdict(judged("grid_spanning", shares(all, all, 2)), "slots"), "refuted");
}

// Experiment 5.

/// Curves of cells from 1 to 32 boxes long, the best 4, and hardly better in the scenes in `flat`; what grids
/// choose takes `chosen` times as long as the best.
std::vector<Table> curves(const std::vector<std::string>& flat, double chosen, double chosen_in_mixed = 0) {
  std::vector<Table> tables;
  Table choices{.name = "choices", .title = "", .columns = {{"scene"}, {"grid"}}};
  append(choices.columns, ratio_columns("chosen over best"));
  for (const auto& [name, label] : {std::pair{"paper", "the paper's grid"}, std::pair{"ours", "our grid"},
                                    std::pair{"ours_3d", "our grid in 3D"}}) {
    Table table{.name = name, .title = "", .columns = {{"scene"}, {"cell"}}};
    append(table.columns, ratio_columns("time over best"));
    for (const char* scene : {"uniform", "power_law", "mixed", "clustered", "thin"}) {
      const bool is_flat = std::ranges::count(flat, scene) > 0;
      for (double cell = 1; cell <= 32; cell *= 2) {
        std::vector<Cell> row = {scene, cell};
        append(row, ratio(1 + std::abs(std::log2(cell / 4)) * (is_flat ? 0.05 : 0.5)));
        table.add(row);
      }
      std::vector<Cell> row = {scene, label};
      append(row, ratio(chosen_in_mixed > 0 && scene == std::string("mixed") ? chosen_in_mixed : chosen));
      choices.add(row);
    }
    tables.push_back(std::move(table));
  }
  tables.push_back(std::move(choices));
  return tables;
}

TEST(GridCellSize, IsTunedByHandWhereEachSceneHasAnOptimumThatNoRuleFinds) {
  const Finding finding = judged("grid_cell_size", curves({}, 2));
  EXPECT_EQ(verdict(finding, "balance"), "confirmed");
  EXPECT_EQ(verdict(finding, "by_hand"), "confirmed");
  EXPECT_EQ(figure(finding, "best_cell_thin"), 4);
  EXPECT_EQ(figure(finding, "largest_over_best_thin"), 2.5);
  EXPECT_EQ(figure(finding, "ours_3d_chosen_over_best_at_most"), 2);
  EXPECT_EQ(figure(finding, "own_curves_with_both_ends_high"), 10);
}

TEST(GridCellSize, IsNoMatterOfHandsWhereARuleFindsTheOptimum) {
  const Finding finding = judged("grid_cell_size", curves({}, 1.1));
  EXPECT_EQ(verdict(finding, "balance"), "confirmed");
  EXPECT_EQ(verdict(finding, "by_hand"), "refuted");
}

TEST(GridCellSize, IsAMatterOfHandsInTheSceneThatTheRuleMisses) {
  EXPECT_EQ(
      verdict(judged("grid_cell_size", curves({}, 1.1, 1.5)), "by_hand"),
      "holds within bounds: boxes are as in mixed, where the size that our grid chooses takes 1.50 times as "
      "long as the best");
}

TEST(GridCellSize, IsNoMatterOfHandsWhereNoiseAloneMakesTheRuleMiss) {
  EXPECT_EQ(verdict(judged("grid_cell_size", curves({}, 1.1, 1.255)), "by_hand"), "refuted");
}

TEST(GridCellSize, NamesTheScenesInWhichOnlySomeHaveAnOptimum) {
  EXPECT_EQ(verdict(judged("grid_cell_size", curves({"uniform", "mixed", "thin"}, 2)), "balance"),
            "holds within bounds: boxes are as in power_law, clustered");
}

TEST(GridCellSize, IsNoBalanceWhereNoSizeMatters) {
  EXPECT_EQ(
      verdict(judged("grid_cell_size", curves({"uniform", "power_law", "mixed", "clustered", "thin"}, 1)),
              "balance"),
      "refuted");
}

}  // namespace
}  // namespace broadside::lab
