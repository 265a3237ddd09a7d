// Our own claim: what the experiment makes of tables made by hand.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "paper/experiments/winners_measure.hpp"
#include "tests/unit/paper/judged.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Times of auto, brute_force, grid, sweep_and_prune, quadtree and bvh; 0: not measured.
using Times = std::vector<double>;

/// Adds a field in which boxes stand still, or some move.
void add_field(Table& fields, bool moves, const Times& times, double peer = 0) {
  std::vector<Cell> row(fields.columns.size());
  row[fields.column("map")] = std::string(moves ? "motion 2D" : "density 2D");
  row[fields.column("boxes")] = 1'000.0;
  row[fields.column(moves ? "moving" : "neighbours")] = 1.0;
  const std::size_t first = fields.column("auto");
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (times[i] > 0) row[first + i] = times[i];
  }
  if (peer > 0) row[fields.column("peer")] = peer;
  fields.add(std::move(row));
}

std::vector<Table> tables_of(const std::vector<std::pair<bool, Times>>& some, double peer = 0) {
  Table fields{.name = "fields", .title = "fields", .columns = {{"map"}, {"boxes"}, {"neighbours"}}};
  fields.columns.insert(fields.columns.end(), {{"size ratio"}, {"cluster spread"}, {"moving"}, {"auto"}});
  for (const std::string& name : single_algorithms()) fields.columns.push_back({name});
  fields.columns.insert(fields.columns.end(), {{"fastest"}, {"fastest peer"}, {"peer"}});
  for (const auto& [moves, times] : some) add_field(fields, moves, times, peer);
  return {fields,
          {.name = "instruction_sets",
           .title = "sets",
           .columns = {{"dimension"}, {"boxes"}, {"algorithm"}, {"instruction set"}, {"time"}}},
          {.name = "threads",
           .title = "threads",
           .columns = {{"dimension"}, {"boxes"}, {"algorithm"}, {"threads"}, {"time"}}}};
}

bool has_figure(const Finding& finding, const std::string& name) {
  return std::ranges::find(finding.figures, name, &Figure::name) != finding.figures.end();
}

/// Each of these fields so often that chance cannot draw the same one only.
std::vector<std::pair<bool, Times>> often(const std::vector<std::pair<bool, Times>>& some) {
  std::vector<std::pair<bool, Times>> fields;
  for (int i = 0; i < 20; ++i) fields.insert(fields.end(), some.begin(), some.end());
  return fields;
}

const Times grid_wins = {1, 9, 1, 4, 4, 2};
const Times bvh_wins = {1, 0, 2, 4, 4, 1};
const Times bvh_wins_and_auto_errs = {4, 9, 2, 4, 4, 1};

TEST(Winners, IsConfirmedWhereWinnersDifferAndAutoLosesLeast) {
  const Finding finding =
      judged("winners",
             tables_of(often({{false, grid_wins}, {false, bvh_wins}, {true, grid_wins}, {true, bvh_wins}})));
  EXPECT_EQ(verdict(finding, "no_best"), "confirmed") << finding.reason;
  EXPECT_EQ(verdict(finding, "choosing"), "confirmed") << finding.reason;
  EXPECT_THAT(finding.reason, AllOf(HasSubstr("Of 80 fields"), HasSubstr("grid in 40, bvh in 40"),
                                    Not(HasSubstr("quadtree"))));
  EXPECT_EQ(figure(finding, "won_by_grid"), 40);
  EXPECT_EQ(figure(finding, "won_by_bvh"), 40);
  EXPECT_EQ(figure(finding, "fields_still"), 40);
  EXPECT_NEAR(figure(finding, "auto_over_single_still"), std::sqrt(0.5), 1e-9);
  EXPECT_DOUBLE_EQ(figure(finding, "auto_mean"), 1);
  EXPECT_DOUBLE_EQ(figure(finding, "single_worst"), 2);
  EXPECT_DOUBLE_EQ(figure(finding, "bvh_gain_most"), 2);
}

TEST(Winners, IsRefutedWhereOneAlgorithmIsBestEverywhereButForNoise) {
  const Finding finding =
      judged("winners", tables_of({{false, grid_wins}, {true, {1, 9, 1.05, 4, 4, 1}}, {true, grid_wins}}));
  EXPECT_EQ(verdict(finding, "no_best"), "refuted") << finding.reason;
}

TEST(Winners, IsRefutedWhereAutoChoosesBadly) {
  const Finding finding = judged("winners", tables_of({{false, grid_wins},
                                                       {false, bvh_wins_and_auto_errs},
                                                       {true, grid_wins},
                                                       {true, bvh_wins_and_auto_errs}}));
  EXPECT_EQ(verdict(finding, "choosing"), "refuted") << finding.reason;
  EXPECT_DOUBLE_EQ(figure(finding, "auto_worst"), 4);
}

TEST(Winners, HoldsForStillOrForMovingBoxesWhereAutoChoosesWellForThese) {
  const Finding still = judged(
      "winners",
      tables_of(
          often({{false, grid_wins}, {false, bvh_wins}, {true, grid_wins}, {true, bvh_wins_and_auto_errs}})));
  EXPECT_EQ(verdict(still, "choosing"), "holds within bounds: the boxes stand still") << still.reason;
  const Finding moving = judged(
      "winners",
      tables_of(
          often({{true, grid_wins}, {true, bvh_wins}, {false, grid_wins}, {false, bvh_wins_and_auto_errs}})));
  EXPECT_EQ(verdict(moving, "choosing"), "holds within bounds: boxes move") << moving.reason;
}

TEST(Winners, IsNotConfirmedWhereOtherFieldsCouldHaveMadeASingleAlgorithmBetter) {
  // Auto is better in the mean, by one field among many in which it is worse.
  std::vector<std::pair<bool, Times>> fields(10, {false, {1.05, 9, 1, 4, 4, 1.1}});
  fields.push_back({false, {1, 9, 4, 4, 4, 5}});
  const Finding finding = judged("winners", tables_of(fields));
  EXPECT_LT(figure(finding, "auto_over_single_still"), 1);
  EXPECT_EQ(verdict(finding, "choosing"), "refuted") << finding.reason;
}

TEST(Winners, CountsFieldsInWhichTheFirstTwoAreHardlyApart) {
  const Finding finding = judged("winners", tables_of({{false, grid_wins}, {false, {1, 9, 1, 4, 4, 1.04}}}));
  EXPECT_EQ(figure(finding, "near_ties"), 1);
}

TEST(Winners, TakesAnAlgorithmThatWasLeftOutOfAFieldForNoneThatIsBestEverywhere) {
  Times only_grid_elsewhere = bvh_wins;
  only_grid_elsewhere[2] = 0;
  const Finding finding = judged("winners", tables_of({{false, grid_wins},
                                                       {false, only_grid_elsewhere},
                                                       {true, grid_wins},
                                                       {true, only_grid_elsewhere}}));
  EXPECT_EQ(verdict(finding, "no_best"), "confirmed") << finding.reason;
}

TEST(Winners, TellsOfInstructionSetsThreadsAndPeersWhereThereAreAny) {
  std::vector<Table> tables = tables_of({{false, grid_wins}, {false, bvh_wins}}, 8);
  EXPECT_DOUBLE_EQ(figure(judged("winners", tables), "peer_over_auto_mean"), 8);
  tables[1].add({"2D", 100.0, "grid", "AVX2", 1.0});
  tables[2].add({"2D", 100.0, "grid", 1.0, 3.0});
  EXPECT_FALSE(has_figure(judged("winners", tables), "simd_gain_mean"));
  EXPECT_FALSE(has_figure(judged("winners", tables), "thread_gain_mean"));
  tables[1].add({"2D", 100.0, "grid", "SSE4", 2.0});
  tables[1].add({"2D", 100.0, "grid", "SCALAR", 5.0});
  tables[2].add({"2D", 100.0, "grid", 2.0, 2.0});
  const Finding finding = judged("winners", tables);
  EXPECT_DOUBLE_EQ(figure(finding, "simd_gain_mean"), 5);
  EXPECT_DOUBLE_EQ(figure(finding, "thread_gain_mean"), 1.5);
  EXPECT_THAT(finding.reason,
              AllOf(HasSubstr("AVX2 is 5.0 to 5.0 times as fast as SCALAR"), HasSubstr("2 threads")));
}

}  // namespace
}  // namespace broadside::lab
