// The verdicts of the experiments on boxes that move, in grids and quadtrees and in general, follow from
// their tables.
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "paper/experiments/experiment.hpp"
#include "paper/experiments/mending.hpp"
#include "paper/experiments/table.hpp"
#include "tests/unit/paper/judged.hpp"

namespace broadside::lab {
namespace {

using Curve = std::function<double(double x)>;

bool says(const Finding& finding, const std::string& text) {
  return finding.reason.find(text) != std::string::npos;
}

TEST(Mending, IsTimedAndCountedOnFramesWhoseEventsAreRight) {
  const Catalogue catalogue;
  const Laboratory laboratory(catalogue, true);
  const std::vector<MendingCost> costs =
      measure_mending<2>(laboratory, {"paper_grid:update=translate", "paper_grid:update=rebuild"},
                         {.scene = "uniform", .boxes = 300, .moving = 0.1, .frames = 3});
  ASSERT_EQ(costs.size(), 2U);
  for (const MendingCost& cost : costs) {
    EXPECT_GT(cost.mending_ms, 0);
    EXPECT_GT(cost.searching_ms, 0);
    EXPECT_LE(cost.mending_ms, cost.frame_ms);
    EXPECT_GE(cost.references, 1);
  }
  EXPECT_LT(costs[0].moved, costs[1].moved);
}

TEST(Growth, ACrossoverIsOfTheRowsThatHaveBoth) {
  Table table{.name = "t", .title = {}, .columns = {{"x"}, {"first"}, {"second"}}};
  table.add({1.0, 4.0, 1.0});
  table.add({2.0, Cell(), 1.0});
  table.add({4.0, 1.0, 4.0});
  EXPECT_NEAR(crossover_in(table, "x", "first", "second").value(), 2, 1e-9);
}

// Experiment 9: rebuilding takes 1 ms; updating as many as the curve says.

Table fractions(const Curve& grid, const Curve& sweep) {
  Table table{.name = "times",
              .title = {},
              .columns = {{"algorithm"},
                          {"moving"},
                          {"updating"},
                          {"rebuilding"},
                          {"updating over rebuilding"},
                          {"mending over building"}}};
  for (const double moving : {0.1, 1.0, 10.0, 100.0}) {
    for (const std::string name : {"paper_grid", "paper_sweep"}) {
      const double ms = (name == "paper_grid" ? grid : sweep)(moving);
      table.add({name, moving, ms, 1.0, ms, ms / 2});
    }
  }
  return table;
}

TEST(UpdateFraction, HoldsUpToTheFractionWhereTheFirstStructureIsBuiltFaster) {
  const Curve tenth = [](double moving) { return moving / 10; };
  const Curve half = [](double moving) { return moving / 50; };
  const Finding finding = judged("update_fraction", {fractions(half, tenth)});
  EXPECT_EQ(finding.verdict_text(), "holds when less than 10 % of the boxes move");
  EXPECT_NEAR(figure(finding, "paper_grid_pays_up_to"), 50, 1e-6);
  EXPECT_NEAR(figure(finding, "greatest_loss_where_all_move"), 10, 1e-6);
  EXPECT_NEAR(figure(finding, "least_mending_gain_where_fewest_move"), 200, 1e-6);
  EXPECT_TRUE(says(finding, "paper_grid 50 %, paper_sweep 10 %")) << finding.reason;
}

TEST(UpdateFraction, HoldsWhereUpdatingIsFasterEvenIfAllMove) {
  const Curve little = [](double moving) { return moving / 1000; };
  EXPECT_EQ(judged("update_fraction", {fractions(little, little)}).verdict, Verdict::holds);
}

TEST(UpdateFraction, DoesNotHoldWhereAStructureIsNeverUpdatedFaster) {
  const Finding finding =
      judged("update_fraction",
             {fractions([](double moving) { return moving / 1000; }, [](double) { return 2.0; })});
  EXPECT_EQ(finding.verdict, Verdict::does_not_hold);
  EXPECT_TRUE(says(finding, "paper_sweep never")) << finding.reason;
}

// Experiment 10: how many times as fast translating is, by the cells a box spans.

Table ways(const Curve& gain) {
  Table table{.name = "ways",
              .title = {},
              .columns = {{"step"},
                          {"cells a box"},
                          {"reinserting over translating"},
                          {"references moved by reinserting"},
                          {"references moved by translating"}}};
  for (const std::string step : {"a tenth of a cell", "a cell"}) {
    for (const double cells : {64.0, 16.0, 4.0, 1.0}) table.add({step, cells, gain(cells), 2 * cells, cells});
  }
  return table;
}

TEST(GridTranslation, HoldsWhereReinsertingWinsInSingleCellsAndLosesInMany) {
  EXPECT_EQ(judged("grid_translation", {ways([](double cells) { return cells < 10 ? 0.5 : 2; })}).verdict,
            Verdict::holds);
}

TEST(GridTranslation, HoldsWhenBoxesSpanManyCellsWhereReinsertingNeverWins) {
  const Finding finding = judged("grid_translation", {ways([](double cells) { return cells < 10 ? 1 : 2; })});
  EXPECT_EQ(finding.verdict, Verdict::holds_when);
  EXPECT_TRUE(finding.condition.starts_with("a box spans 5 cells or more")) << finding.condition;
  EXPECT_EQ(figure(finding, "single_cell_step_of_a_cell"), 1);
  EXPECT_EQ(figure(finding, "greatest_share_of_references_saved"), 50);
}

TEST(GridTranslation, DoesNotHoldWhereTranslatingIsNotFasterInManyCells) {
  EXPECT_EQ(judged("grid_translation", {ways([](double) { return 1.05; })}).verdict, Verdict::does_not_hold);
}

// Experiment 11: rebuilding takes 1 ms; reinserting as much as the curve says.

std::vector<Table> grids(const Curve& few, const Curve& many) {
  Table table{.name = "times",
              .title = {},
              .columns = {{"case"},
                          {"boxes"},
                          {"drift"},
                          {"moving"},
                          {"reinserting"},
                          {"rebuilding"},
                          {"reinserting over rebuilding"},
                          {"frame reinserting"},
                          {"frame rebuilding"}}};
  for (const double boxes : {1000.0, 2000.0}) {
    for (const double moving : {1.0, 10.0, 100.0}) {
      const double ms = (boxes == 1000 ? few : many)(moving);
      table.add({boxes == 1000 ? "few" : "many", boxes, 0.2, moving, ms, 1.0, ms, 40.0, 10.0});
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
  EXPECT_NEAR(figure(finding, "crossover_1000_boxes_drift_20_percent"), 40, 1e-6);
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

// Experiment 14: how many times as fast as from the root the other ways are, by the leaves a box is in.

Table trees(const std::string& name, const std::string& x, const Curve& across, const Curve& common) {
  Table table{.name = name,
              .title = {},
              .columns = {{"tree"},
                          {x},
                          {"leaves a box"},
                          {"from the root over relative"},
                          {"from the root over siblings"},
                          {"from the root over cousins"}}};
  for (const std::string tree : {"capacity 8", "capacity 2"}) {
    for (const double leaves : {1.0, 2.0, 4.0, 8.0})
      table.add({tree, 10 * leaves, leaves, common(leaves), 1.0, across(leaves)});
  }
  return table;
}

/// By the way across to siblings and cousins; the one by the common node is as fast as from the root.
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
  EXPECT_EQ(figure(finding, "cousins_fewest_leaves_capacity_8"), 1.21);
  EXPECT_EQ(figure(finding, "cousins_most_leaves_capacity_2"), 1);
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
  EXPECT_EQ(figure(finding, "relative_fewest_leaves_capacity_8"), 2);
  EXPECT_EQ(figure(finding, "pays_below"), 0);
}

}  // namespace
}  // namespace broadside::lab
