// The verdicts of the experiments on boxes that move, in grids and quadtrees and in general, follow from
// their tables.
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "paper/experiments/experiment.hpp"
#include "paper/experiments/following.hpp"

namespace broadside::lab {
namespace {

using Curve = std::function<double(double x)>;

Finding judged(const char* experiment, const std::vector<Table>& tables) {
  return find_experiment(experiment).judge(tables);
}

double figure(const Finding& finding, const std::string& name) {
  for (const Figure& one : finding.figures) {
    if (one.name == name) return one.value;
  }
  throw std::invalid_argument("no figure " + name);
}

bool says(const Finding& finding, const std::string& text) {
  return finding.reason.find(text) != std::string::npos;
}

TEST(Following, RatiosOfWhatIsNotThereAreNotThereEither) {
  EXPECT_EQ(ratio_cell(6.0, 3.0), Cell(2.0));
  EXPECT_EQ(ratio_cell(6.0, Cell()), Cell());
  EXPECT_EQ(ratio_cell(6.0, 0.0), Cell());
  EXPECT_EQ(scaled_cell(Cell(), 3), Cell());
}

TEST(Following, ACrossoverIsOfTheRowsThatHaveBoth) {
  Table table{.name = "t", .title = {}, .columns = {{"x"}, {"first"}, {"second"}}};
  table.add({1.0, 4.0, 1.0});
  table.add({2.0, Cell(), 1.0});
  table.add({4.0, 1.0, 4.0});
  EXPECT_NEAR(crossover_in(table, "x", "first", "second").value(), 2, 1e-9);
}

// Experiment 9: rebuilding takes 1 ms; updating as many as the curve says.

Table fractions(int dimension, const Curve& updating, const Curve& best) {
  Table table{.name = dimension == 2 ? "times_2d" : "times_3d",
              .title = {},
              .columns = {{"algorithm"},
                          {"moving"},
                          {"updating"},
                          {"by"},
                          {"rebuilding"},
                          {"updating over rebuilding"},
                          {"left to itself"}}};
  for (const double moving : {0.1, 1.0, 10.0, 100.0}) {
    for (const std::string name : {"grid", "best of all"}) {
      const double ms = name == "grid" ? updating(moving) : best(moving);
      table.add({name, moving, ms, "some way", 1.0, ms, 1.5 * std::min(ms, 1.0)});
    }
  }
  return table;
}

TEST(UpdateFraction, HoldsUpToTheFractionWhereTheFirstAlgorithmIsRebuiltFaster) {
  const Curve tenth = [](double moving) { return moving / 10; };
  const Curve half = [](double moving) { return moving / 50; };
  const Finding finding = judged("update_fraction", {fractions(2, half, half), fractions(3, tenth, half)});
  EXPECT_EQ(finding.verdict_text(), "holds when less than 10 % of the boxes move");
  EXPECT_NEAR(figure(finding, "grid_2d_pays_up_to"), 50, 1e-6);
  EXPECT_NEAR(figure(finding, "best_of_all_3d_pays_up_to"), 50, 1e-6);
  EXPECT_NEAR(figure(finding, "worst_choice_over_better_way"), 1.5, 1e-9);
  EXPECT_TRUE(says(finding, "grid in 2D 50 %, grid in 3D 10 %")) << finding.reason;
}

TEST(UpdateFraction, HoldsWhereUpdatingIsFasterEvenIfAllMove) {
  const Curve little = [](double moving) { return moving / 1000; };
  EXPECT_EQ(judged("update_fraction", {fractions(2, little, little), fractions(3, little, little)}).verdict,
            Verdict::holds);
}

TEST(UpdateFraction, DoesNotHoldWhereAnAlgorithmNeverUpdatesFaster) {
  const Curve little = [](double moving) { return moving / 1000; };
  const Finding finding =
      judged("update_fraction", {fractions(2, little, little), fractions(
                                                                   3, [](double) { return 2.0; }, little)});
  EXPECT_EQ(finding.verdict, Verdict::does_not_hold);
  EXPECT_TRUE(says(finding, "grid in 3D never")) << finding.reason;
}

TEST(UpdateFraction, AsksForBothDimensionsAndTwoRowsOfEachAlgorithm) {
  const Curve some = [](double moving) { return moving / 10; };
  std::vector<Table> tables = {fractions(2, some, some), fractions(3, some, some)};
  EXPECT_THROW(judged("update_fraction", {tables[0]}), std::invalid_argument);
  tables[1].rows.resize(2);
  EXPECT_THROW(judged("update_fraction", tables), std::invalid_argument);
}

// Experiment 10: how many times as fast translating is, by the cells a box spans.

Table ways(const std::string& name, const Curve& gain) {
  Table table{.name = name,
              .title = {},
              .columns = {{"step"},
                          {"cells a box"},
                          {"reinserting over translating"},
                          {"cells touched by reinserting"},
                          {"cells touched by translating"}}};
  for (const std::string step : {"a tenth of a cell", "a cell"}) {
    for (const double cells : {64.0, 16.0, 4.0, 1.0}) table.add({step, cells, gain(cells), 2 * cells, cells});
  }
  return table;
}

TEST(GridTranslation, HoldsWhereReinsertingWinsInSingleCellsAndLosesInMany) {
  const Curve gain = [](double cells) { return cells < 10 ? 0.5 : 2; };
  EXPECT_EQ(judged("grid_translation", {ways("ways_2d", gain), ways("ways_3d", gain)}).verdict,
            Verdict::holds);
}

TEST(GridTranslation, HoldsWhenBoxesSpanManyCellsWhereReinsertingNeverWins) {
  const Curve gain = [](double cells) { return cells < 10 ? 1 : 2; };
  const Finding finding = judged("grid_translation", {ways("ways_2d", gain), ways("ways_3d", gain)});
  EXPECT_EQ(finding.verdict, Verdict::holds_when);
  EXPECT_TRUE(finding.condition.starts_with("a box spans 5 cells or more")) << finding.condition;
  EXPECT_EQ(figure(finding, "single_cell_step_of_a_cell_2d"), 1);
  EXPECT_EQ(figure(finding, "greatest_share_of_cells_saved"), 50);
}

TEST(GridTranslation, DoesNotHoldWhereTranslatingIsNotFasterInManyCells) {
  const Curve gain = [](double cells) { return cells < 10 ? 1 : 2; };
  const Curve none = [](double) { return 1.05; };
  EXPECT_EQ(judged("grid_translation", {ways("ways_2d", gain), ways("ways_3d", none)}).verdict,
            Verdict::does_not_hold);
}

TEST(GridTranslation, AsksForBothStepsAndCellsThatAreTouched) {
  const Curve gain = [](double cells) { return cells; };
  std::vector<Table> tables = {ways("ways_2d", gain), ways("ways_3d", gain)};
  tables[0].rows.resize(4);
  EXPECT_THROW(judged("grid_translation", tables), std::invalid_argument);
  tables[0] = ways("ways_2d", gain);
  tables[0].rows[0][3] = 0.0;
  EXPECT_THROW(judged("grid_translation", tables), std::invalid_argument);
}

// Experiment 11: rebuilding takes 1 ms; reinserting as much as the curve says.

std::vector<Table> grids(const Curve& few, const Curve& many) {
  Table table{.name = "times",
              .title = {},
              .columns = {{"case"},
                          {"dimension"},
                          {"boxes"},
                          {"drift"},
                          {"moving"},
                          {"reinserting"},
                          {"rebuilding"},
                          {"reinserting over rebuilding"},
                          {"tests reinserting"},
                          {"tests rebuilding"}}};
  for (const double boxes : {1000.0, 2000.0}) {
    for (const double moving : {1.0, 10.0, 100.0}) {
      const double ms = (boxes == 1000 ? few : many)(moving);
      table.add({boxes == 1000 ? "few" : "many", "2D", boxes, 0.2, moving, ms, 1.0, ms, 40.0, 10.0});
    }
  }
  return {table};
}

TEST(GridRebuilding, HoldsWhereRebuildingIsFasterBeforeMostBoxesMove) {
  const Finding finding = judged("grid_rebuilding", grids([](double moving) { return moving / 40; },
                                                          [](double moving) { return moving / 20; }));
  EXPECT_EQ(finding.verdict, Verdict::holds);
  EXPECT_NEAR(figure(finding, "earliest_crossover"), 20, 1e-6);
  EXPECT_NEAR(figure(finding, "latest_crossover"), 40, 1e-6);
  EXPECT_NEAR(figure(finding, "crossover_2d_1000_boxes_drift_20_percent"), 40, 1e-6);
  EXPECT_NEAR(figure(finding, "greatest_ratio_where_all_move"), 5, 1e-6);
}

TEST(GridRebuilding, HoldsWhenMoreMoveThanMost) {
  EXPECT_EQ(judged("grid_rebuilding", grids([](double moving) { return moving / 80; },
                                            [](double moving) { return moving / 20; }))
                .verdict_text(),
            "holds when more than 80 % of the boxes move");
}

TEST(GridRebuilding, DoesNotHoldWhereReinsertingIsFasterEvenIfAllMove) {
  const Finding finding = judged("grid_rebuilding", grids([](double moving) { return moving / 200; },
                                                          [](double moving) { return moving / 20; }));
  EXPECT_EQ(finding.verdict, Verdict::does_not_hold);
  EXPECT_TRUE(says(finding, "never (few)")) << finding.reason;
}

TEST(GridRebuilding, AsksForTwoRowsACase) {
  std::vector<Table> tables =
      grids([](double moving) { return moving; }, [](double moving) { return moving; });
  tables[0].rows.resize(4);
  EXPECT_THROW(judged("grid_rebuilding", tables), std::invalid_argument);
  tables[0].rows.clear();
  EXPECT_THROW(judged("grid_rebuilding", tables), std::invalid_argument);
}

// Experiment 14: how many times as fast as from the root the two other ways are, by the leaves a box is in.

Table trees(const std::string& name, const std::string& x, const Curve& across, const Curve& common) {
  Table table{
      .name = name,
      .title = {},
      .columns = {
          {"tree"}, {x}, {"leaves a box"}, {"from the root over relative"}, {"from the root over siblings"}}};
  for (const std::string tree : {"2D, capacity 32", "3D, capacity 4"}) {
    for (const double leaves : {1.0, 2.0, 4.0, 8.0})
      table.add({tree, 10 * leaves, leaves, common(leaves), across(leaves)});
  }
  return table;
}

/// By the way across to siblings; the one by the common node is as fast as from the root.
std::vector<Table> siblings(
    const Curve& across, const Curve& common = [](double) { return 1.0; }) {
  return {trees("depth", "boxes", across, common), trees("step", "drift", across, common),
          trees("spanning", "neighbours", across, common)};
}

TEST(QuadtreeSiblings, HoldsWhereItPaysInFewLeavesAndIsHorribleInMany) {
  const Finding finding = judged("quadtree_siblings", siblings([](double leaves) { return 2 / leaves; }));
  EXPECT_EQ(finding.verdict, Verdict::holds);
  EXPECT_EQ(figure(finding, "worst_slowdown"), 4);
  EXPECT_EQ(figure(finding, "worst_leaves"), 8);
}

TEST(QuadtreeSiblings, HoldsWhenBoxesAreInFewLeavesWhereItIsNotHorribleInMany) {
  const Finding finding =
      judged("quadtree_siblings", siblings([](double leaves) { return leaves < 3 ? 1.21 : 1.0; }));
  EXPECT_EQ(finding.verdict, Verdict::holds_when);
  EXPECT_TRUE(finding.condition.starts_with("boxes are in fewer than 2.8 leaves")) << finding.condition;
  EXPECT_TRUE(finding.condition.ends_with("gains nothing, but is not horrible")) << finding.condition;
  EXPECT_EQ(figure(finding, "siblings_fewest_leaves_2d_capacity_32"), 1.21);
  EXPECT_EQ(figure(finding, "siblings_most_leaves_3d_capacity_4"), 1);
}

TEST(QuadtreeSiblings, CallsALossALossBelowTwiceTheTime) {
  const Finding finding =
      judged("quadtree_siblings", siblings([](double leaves) { return leaves == 4 ? 0.625 : 1.5; }));
  EXPECT_EQ(finding.verdict, Verdict::holds_when);
  EXPECT_TRUE(
      finding.condition.ends_with("up to 1.60 times as long as from the root, a loss but not horrible"))
      << finding.condition;
  EXPECT_EQ(figure(finding, "worst_leaves"), 4);
}

TEST(QuadtreeSiblings, IsJudgedByReferencesCarriedAcrossAndNotByTheWayThroughTheCommonNode) {
  const Curve much = [](double leaves) { return 2 / leaves; };
  const Finding finding = judged("quadtree_siblings", siblings([](double) { return 1.05; }, much));
  EXPECT_EQ(finding.verdict, Verdict::does_not_hold);
  EXPECT_EQ(figure(finding, "relative_fewest_leaves_2d_capacity_32"), 2);
  EXPECT_EQ(figure(finding, "pays_below"), 0);
}

TEST(QuadtreeSiblings, AsksForItsTablesAndTwoRowsATree) {
  std::vector<Table> tables = siblings([](double) { return 1.5; });
  EXPECT_THROW(judged("quadtree_siblings", {tables[0], tables[1]}), std::invalid_argument);
  tables[2].rows.resize(5);
  EXPECT_THROW(judged("quadtree_siblings", tables), std::invalid_argument);
  tables[2].rows.clear();
  EXPECT_THROW(judged("quadtree_siblings", tables), std::invalid_argument);
}

TEST(QuadtreeSiblings, RefusesTablesWithoutTheWayAcross) {
  std::vector<Table> tables = siblings([](double) { return 1.5; });
  tables[2].columns.back().name = "another";
  EXPECT_THROW(judged("quadtree_siblings", tables), std::invalid_argument);
}

}  // namespace
}  // namespace broadside::lab
