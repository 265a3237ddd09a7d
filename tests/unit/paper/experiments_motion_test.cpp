// The verdicts of the experiments on boxes that move, in grids and quadtrees and in general, follow from
// their tables.
#include <cmath>
#include <functional>
#include <string>
#include <utility>
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
    EXPECT_GE(cost.detecting.median(), 0);
    EXPECT_GT(cost.mending.median(), 0);
    EXPECT_GT(cost.searching.median(), 0);
    EXPECT_EQ(cost.frame.frames, 3U);
    for (std::size_t i = 0; i < cost.frame.all.size(); ++i)
      EXPECT_LE(cost.detecting.all[i] + cost.mending.all[i] + cost.searching.all[i], cost.frame.all[i]);
    EXPECT_GE(cost.references, 1);
  }
  EXPECT_EQ(costs[0].movers, 30);
  EXPECT_LT(costs[0].moved, costs[1].moved);
}

TEST(Mending, IsComparedFrameByFrame) {
  // In the second frame, ten times as long, both take three times as long as in the first round.
  const FrameTimes times{.all = {2, 20, 6, 60, 2, 20}, .frames = 2};
  const FrameTimes others{.all = {1, 10, 3, 30, 1, 10}, .frames = 2};
  EXPECT_EQ(ratio_cells(times, others), (std::vector<Cell>{2.0, 2.0, 2.0}));
}

TEST(Growth, HasAnIntervalByHowFarPointsLieFromTheLine) {
  const Interval exact = growth_interval_of({{1, 1}, {2, 4}, {4, 16}, {8, 64}});
  EXPECT_NEAR(exact.low, 2, 1e-9);
  EXPECT_NEAR(exact.high, 2, 1e-9);
  // ln y is off by d, -d, -d, d at 0, 1, 2, 3 times ln 2: of slope 0, with a standard error of d sqrt(2 / 5)
  // / ln 2.
  const double d = 0.1;
  const Interval off =
      growth_interval_of({{1, std::exp(d)}, {2, std::exp(-d)}, {4, std::exp(-d)}, {8, std::exp(d)}});
  EXPECT_NEAR(off.high, 4.30 * d * std::sqrt(0.4) / std::log(2), 1e-9);
  EXPECT_NEAR(off.low, -off.high, 1e-9);
}

TEST(Growth, ARatioCrossesALevelWithinTheRangeOfItsInterval) {
  const std::vector<RatioAt> ratios = {{1, 0.5, {0.25, 1}}, {4, 2, {1, 4}}, {16, 8, {4, 16}}};
  const Crossing crossing = rises_above(1, ratios);
  EXPECT_NEAR(crossing.at.value(), 2, 1e-9);
  EXPECT_NEAR(crossing.earliest.value(), 1, 1e-9);
  EXPECT_NEAR(crossing.latest.value(), 4, 1e-9);
  EXPECT_FALSE(rises_above(20, ratios).at);
  EXPECT_EQ(rises_above(20, ratios).interval(100).low, 100);
}

TEST(Growth, ACrossoverIsOfTheRowsThatHaveBoth) {
  Table table{.name = "t", .title = {}, .columns = {{"x"}, {"first"}, {"second"}}};
  table.add({1.0, 4.0, 1.0});
  table.add({2.0, Cell(), 1.0});
  table.add({4.0, 1.0, 4.0});
  EXPECT_NEAR(crossover_in(table, "x", "first", "second").value(), 2, 1e-9);
}

// Experiment 9: building takes 1 ms; updating as many as the curve says, and mending half of that.

/// Rows by the boxes that move, with a grid and a sweep.
Table fractions(const Curve& grid, const Curve& sweep) {
  Table table{.name = "times", .title = {}, .columns = {{"algorithm"}, {"moving"}}};
  append(table.columns, ratio_columns("mending over building"));
  append(table.columns, ratio_columns("updating over rebuilding"));
  for (const double moving : {0.1, 1.0, 10.0, 100.0}) {
    for (const std::string name : {"paper_grid", "paper_sweep"}) {
      const double ms = (name == "paper_grid" ? grid : sweep)(moving);
      std::vector<Cell> row = {name, moving};
      append(row, ratio(ms / 2));
      append(row, ratio(ms));
      table.add(row);
    }
  }
  return table;
}

/// Detecting and mending where few boxes move, over building, with changes told by a flag and by comparison.
Table detection(double by_flag, double by_comparison) {
  Table table{
      .name = "detection", .title = {}, .columns = {{"algorithm"}, {"detection"}, {"detecting"}, {"frame"}}};
  append(table.columns, ratio_columns("detecting and mending over building"));
  for (const std::string name : {"paper_grid", "paper_sweep"}) {
    for (const auto& [detect, over] : {std::pair{"flag", by_flag}, std::pair{"compare", by_comparison}}) {
      std::vector<Cell> row = {name, detect, 1.0, 50.0};
      append(row, ratio(name == "paper_grid" ? over / 2 : over));
      table.add(row);
    }
  }
  return table;
}

std::vector<Table> updates(
    const Curve& grid, const Curve& sweep, const Curve& search = [](double) { return 0.1; },
    const Table& detected = detection(0.5, 0.5)) {
  Table searched = fractions(search, search);
  searched.name = "search";
  searched = searched.where("algorithm", "paper_grid");
  return {fractions(grid, sweep), searched, detected};
}

const Curve little = [](double moving) { return moving / 1000; };
const Curve tenth = [](double moving) { return moving / 10; };
const Curve half = [](double moving) { return moving / 50; };
const Curve twice = [](double) { return 2.5; };

TEST(UpdateFraction, HoldsUpToTheFractionWhereTheFirstStructureIsBuiltFaster) {
  const Finding finding = judged("update_fraction", updates(half, tenth));
  EXPECT_EQ(verdict(finding, "frames"), "holds within bounds: less than 10 % of the boxes move");
  EXPECT_EQ(verdict(finding, "structure"), "holds within bounds: less than 20 % of the boxes move");
  EXPECT_NEAR(figure(finding, "paper_grid_pays_up_to"), 50, 1e-6);
  EXPECT_NEAR(figure(finding, "greatest_ratio_where_all_move"), 10, 1e-6);
  EXPECT_NEAR(figure(finding, "least_mending_gain_where_fewest_move"), 200, 1e-6);
  EXPECT_TRUE(says(finding, "in whole frames: paper_grid 50 %, paper_sweep 10 %")) << finding.reason;
}

TEST(UpdateFraction, IsConfirmedWhereUpdatingIsFasterEvenIfAllMove) {
  const Finding finding = judged("update_fraction", updates(little, little));
  for (const char* const statement : {"structure", "frames", "detection", "search_delete_reinsert"})
    EXPECT_EQ(verdict(finding, statement), "confirmed") << statement;
}

TEST(UpdateFraction, NamesTheStructuresThatAreUpdatedFaster) {
  const Finding finding = judged("update_fraction", updates(half, twice));
  EXPECT_EQ(verdict(finding, "frames"),
            "holds within bounds: the structure is that of paper_grid and less than 50 % of the boxes move");
  EXPECT_TRUE(says(finding, "paper_sweep never")) << finding.reason;
}

TEST(UpdateFraction, IsRefutedWhereNoStructureIsEverUpdatedFaster) {
  const Finding finding = judged("update_fraction", updates(twice, twice, twice));
  for (const char* const statement : {"structure", "frames", "search_delete_reinsert"})
    EXPECT_EQ(verdict(finding, statement), "refuted") << statement;
}

TEST(UpdateFraction, IsNotFasterWhereTheIntervalHoldsOne) {
  EXPECT_EQ(
      verdict(judged("update_fraction", updates([](double) { return 0.995; }, [](double) { return 0.995; })),
              "frames"),
      "refuted");
}

TEST(UpdateFraction, HoldsForTheWayToKnowWhatChangedThatPays) {
  const auto with = [](double by_flag, double by_comparison) {
    return verdict(judged("update_fraction", updates(half, half, half, detection(by_flag, by_comparison))),
                   "detection");
  };
  EXPECT_EQ(with(0.5, 1.5), "holds within bounds: it is a flag");
  EXPECT_EQ(with(1.5, 0.5), "holds within bounds: it is a previous state");
  EXPECT_EQ(with(1.5, 1.5), "refuted");
}

TEST(UpdateFraction, SearchesPayUpToTheFractionWhereBuildingIsFaster) {
  EXPECT_EQ(verdict(judged("update_fraction", updates(little, little, tenth)), "search_delete_reinsert"),
            "holds within bounds: less than 20 % of the boxes move");
}

// Experiment 10: how many times as fast translating is, by the cells a box spans and by the step.

std::vector<Table> ways(const Curve& small, const Curve& whole, double wrong = 0) {
  Table table{.name = "ways",
              .title = {},
              .columns = {{"step"},
                          {"cells a box"},
                          {"references moved by reinserting"},
                          {"references moved by translating"}}};
  append(table.columns, ratio_columns("reinserting over translating"));
  for (const std::string step : {"a tenth of a cell", "a cell"}) {
    for (const double cells : {64.0, 16.0, 4.0, 1.0}) {
      std::vector<Cell> row = {step, cells, 2 * cells, cells};
      append(row, ratio((step == "a cell" ? whole : small)(cells)));
      table.add(row);
    }
  }
  Table rule{.name = "rule", .title = {}, .columns = {{"ends"}, {"wrong"}}};
  rule.add({100.0, wrong});
  return {table, rule};
}

const Curve wins_in_many = [](double cells) { return cells < 10 ? 0.5 : 2; };
const Curve loses_nowhere = [](double cells) { return cells < 10 ? 1 : 2; };

TEST(GridTranslation, IsConfirmedWhereReinsertingWinsInSingleCellsAndLosesInMany) {
  const Finding finding = judged("grid_translation", ways(wins_in_many, wins_in_many));
  for (const char* const statement : {"translating", "single_cell", "offset"})
    EXPECT_EQ(verdict(finding, statement), "confirmed") << statement;
}

TEST(GridTranslation, IsNotAlwaysFasterInASingleCellWhereReinsertingWinsForSomeStepsOnly) {
  EXPECT_EQ(verdict(judged("grid_translation", ways(loses_nowhere, wins_in_many)), "single_cell"),
            "holds within bounds: steps are of a cell");
  EXPECT_EQ(verdict(judged("grid_translation", ways(wins_in_many, loses_nowhere)), "single_cell"),
            "holds within bounds: steps are of a tenth of a cell");
}

TEST(GridTranslation, IsRefutedForASingleCellWhereReinsertingNeverWins) {
  const Finding finding = judged("grid_translation", ways(loses_nowhere, loses_nowhere));
  EXPECT_EQ(verdict(finding, "translating"), "confirmed");
  EXPECT_EQ(verdict(finding, "single_cell"), "refuted");
  EXPECT_EQ(figure(finding, "single_cell_step_of_a_cell"), 1);
  EXPECT_NEAR(figure(finding, "translating_wins_from"), 4.84, 0.01);
  EXPECT_EQ(figure(finding, "greatest_share_of_references_saved"), 50);
}

TEST(GridTranslation, IsRefutedWhereTranslatingIsNotFasterInManyCells) {
  const Curve hardly = [](double) { return 1.05; };
  EXPECT_EQ(verdict(judged("grid_translation", ways(hardly, hardly)), "translating"), "refuted");
}

TEST(GridTranslation, RefutesARuleThatIsWrongAboutSomeEnds) {
  const Finding finding = judged("grid_translation", ways(wins_in_many, wins_in_many, 7));
  EXPECT_EQ(verdict(finding, "offset"), "refuted");
  EXPECT_EQ(figure(finding, "rule_is_wrong"), 7);
}

// Experiment 11: rebuilding takes 1 ms; reinserting as much as the curve says.

std::vector<Table> grids(const Curve& few, const Curve& many, double looks_of_few = 2,
                         double looks_of_many = 2) {
  Table table{.name = "times",
              .title = {},
              .columns = {{"case"},
                          {"boxes"},
                          {"drift"},
                          {"moving"},
                          {"entries looked at by reinserting"},
                          {"entries looked at by rebuilding"}}};
  append(table.columns, ratio_columns("reinserting over rebuilding"));
  append(table.columns, ratio_columns("frames reinserting over rebuilding"));
  for (const double boxes : {1000.0, 2000.0}) {
    for (const double moving : {1.0, 10.0, 100.0}) {
      const bool is_few = boxes == 1000;
      std::vector<Cell> row = {
          is_few ? "few" : "many", boxes, 0.2, moving, 10 * (is_few ? looks_of_few : looks_of_many), 10.0};
      append(row, ratio((is_few ? few : many)(moving)));
      append(row, ratio(4));
      table.add(row);
    }
  }
  return {table};
}

const Curve fortieth = [](double moving) { return moving / 40; };
const Curve twentieth = [](double moving) { return moving / 20; };

TEST(GridRebuilding, IsConfirmedWhereRebuildingIsFasterBeforeMostBoxesMove) {
  const Finding finding = judged("grid_rebuilding", grids(fortieth, twentieth));
  EXPECT_EQ(verdict(finding, "rebuilding"), "confirmed");
  EXPECT_NEAR(figure(finding, "earliest_crossover"), 20, 1e-6);
  EXPECT_NEAR(figure(finding, "latest_crossover"), 40, 1e-6);
  EXPECT_NEAR(figure(finding, "crossover_1000_boxes_drift_20_percent"), 40, 1e-6);
  EXPECT_NEAR(figure(finding, "greatest_ratio_where_all_move"), 5, 1e-6);
}

TEST(GridRebuilding, HoldsWhereMoreMoveThanMost) {
  EXPECT_EQ(verdict(judged("grid_rebuilding", grids([](double moving) { return moving / 80; }, twentieth)),
                    "rebuilding"),
            "holds within bounds: more of the boxes move than 80 % of few, 20 % of many");
}

TEST(GridRebuilding, IsRefutedWhereReinsertingIsFasterEvenIfAllMove) {
  const Finding finding =
      judged("grid_rebuilding", grids([](double moving) { return moving / 200; }, twentieth));
  EXPECT_EQ(verdict(finding, "rebuilding"), "refuted");
  EXPECT_TRUE(says(finding, "never (few)")) << finding.reason;
}

TEST(GridRebuilding, CountsTheEntriesThatTwoHashesAreSaidToLookAt) {
  const auto hashes = [](double of_few, double of_many) {
    return verdict(judged("grid_rebuilding", grids(fortieth, twentieth, of_few, of_many)), "two_hashes");
  };
  EXPECT_EQ(hashes(2, 2.1), "confirmed");
  EXPECT_EQ(hashes(2, 4), "holds within bounds: there are few");
  EXPECT_EQ(hashes(3, 4), "refuted");
}

TEST(GridRebuilding, JudgesTwiceTheTimeApartFromTwiceTheWork) {
  const auto fiftieth = [](double moving) { return moving / 50; };
  EXPECT_EQ(verdict(judged("grid_rebuilding", grids(fiftieth, fiftieth, 4, 4)), "two_hashes_time"),
            "confirmed");
  const Finding finding = judged("grid_rebuilding", grids(fiftieth, twentieth, 2, 2));
  EXPECT_EQ(verdict(finding, "two_hashes_time"), "holds within bounds: there are few");
  EXPECT_EQ(verdict(finding, "two_hashes"), "confirmed");
}

// Experiment 14: how many times as fast as from the root the other ways are, by the leaves a box is in.

Table trees(const std::string& name, const std::string& x, const Curve& across, const Curve& common) {
  Table table{.name = name, .title = {}, .columns = {{"tree"}, {x}, {"leaves a box"}}};
  for (const char* const way : {"relative", "siblings", "cousins"})
    append(table.columns, ratio_columns(std::string("from the root over ") + way));
  for (const std::string tree : {"capacity 8", "capacity 2"}) {
    for (const double leaves : {1.0, 2.0, 4.0, 8.0}) {
      std::vector<Cell> row = {tree, 10 * leaves, leaves};
      for (const double gain : {common(leaves), 1.0, across(leaves)}) append(row, ratio(gain));
      table.add(row);
    }
  }
  return table;
}

/// By the way across to siblings and cousins; the one by the common node is as fast as from the root.
std::vector<Table> siblings(
    const Curve& across, const Curve& common = [](double) { return 1.0; }) {
  return {trees("depth", "boxes", across, common), trees("step", "drift", across, common),
          trees("spanning", "neighbours", across, common)};
}

TEST(QuadtreeSiblings, PayInFewLeavesAndTellTheGreatestLossInMany) {
  const Finding finding = judged("quadtree_siblings", siblings([](double leaves) { return 2 / leaves; }));
  EXPECT_TRUE(
      verdict(finding, "translating").starts_with("holds within bounds: boxes are in fewer than 1.8 leaves"))
      << verdict(finding, "translating");
  EXPECT_EQ(finding.statement("spanning").verdict, Verdict::not_testable);
  EXPECT_EQ(verdict(finding, "relative"), "refuted");
  EXPECT_EQ(figure(finding, "worst_slowdown"), 4);
  EXPECT_EQ(figure(finding, "worst_leaves"), 8);
}

TEST(QuadtreeSiblings, AreConfirmedWhereTheyPayInAnyNumberOfLeaves) {
  const Finding finding =
      judged("quadtree_siblings", siblings([](double) { return 1.5; }, [](double) { return 1.2; }));
  EXPECT_EQ(verdict(finding, "translating"), "confirmed");
  EXPECT_EQ(verdict(finding, "relative"), "confirmed");
}

TEST(QuadtreeSiblings, ArePaidForByTreesOfSomeCapacityOnly) {
  std::vector<Table> tables = siblings([](double) { return 1.0; }, [](double) { return 1.2; });
  const std::size_t column = tables[2].column("from the root over relative");
  for (std::vector<Cell>& row : tables[2].rows) {
    if (row[0] == Cell("capacity 2")) row[column] = row[column + 1] = row[column + 2] = 1.0;
  }
  EXPECT_EQ(verdict(judged("quadtree_siblings", tables), "relative"),
            "holds within bounds: leaves are of capacity 8");
}

TEST(QuadtreeSiblings, AreJudgedByReferencesCarriedAcrossAndNotByTheWayThroughTheCommonNode) {
  const Curve much = [](double leaves) { return 2 / leaves; };
  const Finding finding = judged("quadtree_siblings", siblings([](double) { return 1.05; }, much));
  EXPECT_EQ(verdict(finding, "translating"), "refuted");
  EXPECT_EQ(figure(finding, "relative_fewest_leaves_capacity_8"), 2);
}

}  // namespace
}  // namespace broadside::lab
