// The verdicts of the experiments on sweep and prune follow from their tables.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/paper/judged.hpp"

namespace broadside::lab {
namespace {

/// What the sweeps cost in a world without bounds and with infinite boxes, over the bounded ones.
Table worlds(double boundless, double infinite) {
  Table table{.name = "worlds",
              .title = {},
              .columns = {{"world"}, {"algorithm"}, {"tests"}, {"time"}, {"memory"}, {"bounded world"}}};
  for (const std::string name :
       {"sweep_and_prune", "paper_sweep_and_prune", "paper_grid", "paper_quadtree"}) {
    const bool is_sweep = name.find("sweep") != std::string::npos;
    const double cost = is_sweep ? boundless : 90;
    table.add({"compact", name, 1000.0, 1.0, 5000.0, "compact"});
    table.add({"1 box far away", name, 1000 * cost, cost, 5000.0, "compact"});
    table.add({"4 infinite boxes", name, 1000 * infinite, infinite, 5000.0, "compact"});
  }
  return table;
}

Table axes() {
  Table table{.name = "axes",
              .title = {},
              .columns = {{"scene"}, {"sweep"}, {"tests a box"}, {"time"}, {"time over best axis's"}}};
  table.add({"one_line 2D", "x", 500.0, 12.0, 12.0});
  table.add({"one_line 2D", "y", 2.0, 1.0, 1.0});
  table.add({"one_line 2D", "auto", 2.0, 1.1, 1.1});
  table.add({"one_line 2D", "auto, stripes", 2.0, 0.55, 0.55});
  table.add({"one_line 2D", "paper, x", 500.0, 40.0, 40.0});
  return table;
}

Table growth() {
  Table table{.name = "growth", .title = {}, .columns = {{"boxes"}, {"sweep"}, {"tests"}}};
  for (const double boxes : {100.0, 10'000.0}) {
    table.add({boxes, "sweep_and_prune:axes=1 2D", boxes * boxes});
    table.add({boxes, "sweep_and_prune:axes=1 3D", boxes * boxes});
    table.add({boxes, "sweep_and_prune 2D", boxes});
  }
  return table;
}

TEST(SweepAxisExperiment, IsConfirmedWhereBoundlessWorldsCostNothing) {
  const Finding finding = judged("sweep_axis", {worlds(1, 1), axes(), growth()});
  EXPECT_EQ(verdict(finding, "no_bounds"), "confirmed");
  EXPECT_TRUE(verdict(finding, "one_axis").starts_with("not testable: a choice of the draft"));
  EXPECT_NE(finding.reason.find("12.0 times the best one's time (one_line 2D)"), std::string::npos)
      << finding.reason;
  EXPECT_NE(finding.reason.find("n^2.00 in 2D"), std::string::npos) << finding.reason;
}

TEST(SweepAxisExperiment, HoldsWhereNoBoxIsInfiniteWhereThoseCost) {
  EXPECT_EQ(verdict(judged("sweep_axis", {worlds(1, 30), axes(), growth()}), "no_bounds"),
            "holds within bounds: no box is infinite");
}

TEST(SweepAxisExperiment, IsRefutedWhereABoxFarAwayCosts) {
  EXPECT_EQ(verdict(judged("sweep_axis", {worlds(30, 1), axes(), growth()}), "no_bounds"), "refuted");
}

TEST(SweepAxisExperiment, RefusesTablesWithoutWhatItJudgesBy) {
  EXPECT_THROW(judged("sweep_axis", {worlds(1, 1), axes()}), std::invalid_argument);
  Table bounded = worlds(1, 1);
  bounded.rows.resize(1);
  EXPECT_THROW(judged("sweep_axis", {bounded, axes(), growth()}), std::invalid_argument);
  Table no_scene = axes();
  no_scene.rows.clear();
  EXPECT_THROW(judged("sweep_axis", {worlds(1, 1), no_scene, growth()}), std::invalid_argument);
  Table short_growth = growth();
  short_growth.rows.resize(3);
  EXPECT_THROW(judged("sweep_axis", {worlds(1, 1), axes(), short_growth}), std::invalid_argument);
}

/// The places that boxes move grow with their number to the power of these exponents.
Table order_growth(double in_corridor, double in_plane, double in_space) {
  Table table{.name = "growth",
              .title = {},
              .columns = {{"world"}, {"boxes"}, {"places moved a box"}, {"places moved"}, {"insertion"}}};
  const auto add = [&table](const std::string& world, double exponent) {
    for (const double boxes : {1'000.0, 16'000.0}) {
      const double places = std::pow(boxes, exponent);
      table.add({world, boxes, places / boxes, places, places});
    }
  };
  add("corridor", in_corridor);
  add("plane", in_plane);
  add("space", in_space);
  return table;
}

/// Mending takes 10 ms and this for each place by insertion, 40 ms by a sort, and the sweep another 100 ms;
/// with a heap the whole frame takes `heap`.
Table motion_frames(double milliseconds_a_place, double heap = 160) {
  Table table{.name = "frames",
              .title = {},
              .columns = {{"motion"}, {"update"}, {"places moved a box"}, {"mending"}, {"time"}}};
  append(table.columns, ratio_columns("insertion's frame over this"));
  for (const double places : {0.1, 1.0, 10.0, 100.0}) {
    const double inserted = 10 + milliseconds_a_place * places;
    const auto add = [&](const std::string& update, double mending, double time) {
      std::vector<Cell> row = {std::to_string(places), update, places, mending, time};
      append(row, ratio((inserted + 100) / time));
      table.add(row);
    };
    add("insertion", inserted, inserted + 100);
    add("rebuild", 40, 140);
    add("heap", 60, heap);
  }
  return table;
}

TEST(SweepInsertionExperiment, IsLinearWhereAsManyArePassedWhereMoreBoxesMeanMorePlaces) {
  const Finding finding = judged("sweep_insertion", {order_growth(1, 1.5, 1.67), motion_frames(1)});
  EXPECT_EQ(verdict(finding, "linear"),
            "holds within bounds: the number of others that a box passes in a frame does not grow with the "
            "number of "
            "boxes");
  EXPECT_NE(finding.reason.find("n^1.50 in a plane"), std::string::npos) << finding.reason;
}

TEST(SweepInsertionExperiment, IsConfirmedWhereItIsLinearInEachWorldAndRefutedWhereInNone) {
  EXPECT_EQ(verdict(judged("sweep_insertion", {order_growth(1, 1, 1.05), motion_frames(0.1)}), "linear"),
            "confirmed");
  EXPECT_EQ(verdict(judged("sweep_insertion", {order_growth(1.5, 1.5, 1.6), motion_frames(1)}), "linear"),
            "refuted");
}

TEST(SweepInsertionExperiment, ImprovesOnAHeapWhereItsFramesAreFaster) {
  const auto improved = [](const Table& frames) {
    return verdict(judged("sweep_insertion", {order_growth(1, 1, 1), frames}), "improved");
  };
  EXPECT_EQ(improved(motion_frames(0.1)), "confirmed");
  // A frame of 110 + p crosses 160 at p = 50; between 10 and 100 places on straight lines of logarithms.
  EXPECT_TRUE(improved(motion_frames(1))
                  .starts_with("holds within bounds: a box passes fewer than about 32.7 others"))
      << improved(motion_frames(1));
  EXPECT_EQ(improved(motion_frames(1, 100)), "refuted");
}

TEST(SweepInsertionExperiment, RefusesTablesWithoutWhatItJudgesBy) {
  const Table growing = order_growth(1, 1.5, 1.67);
  EXPECT_THROW(judged("sweep_insertion", {growing}), std::invalid_argument);
  Table no_frames = motion_frames(1);
  no_frames.rows.clear();
  EXPECT_THROW(judged("sweep_insertion", {growing, no_frames}), std::invalid_argument);
  Table one_number = growing;
  one_number.rows.resize(1);
  EXPECT_THROW(judged("sweep_insertion", {one_number, motion_frames(1)}), std::invalid_argument);
}

/// A search takes 5 ns a comparison; what each place costs comes on top.
Table reinsertion_growth(double nanoseconds_a_place) {
  Table table{.name = "growth",
              .title = {},
              .columns = {{"boxes go"}, {"boxes"}, {"comparisons"}, {"places moved"}, {"time"}}};
  for (const bool is_near : {true, false}) {
    for (const double boxes : {1'000.0, 16'000.0, 256'000.0}) {
      const double comparisons = 2 * std::log2(boxes);
      const double places = is_near ? 1 : boxes / 3;
      table.add({is_near ? "a fifth of their size" : "anywhere", boxes, comparisons, places,
                 5 * comparisons + nanoseconds_a_place * places});
    }
  }
  return table;
}

Table mover_frames() {
  Table table{.name = "frames",
              .title = {},
              .columns = {{"boxes go"}, {"k"}, {"update"}, {"boxes"}, {"mending"}, {"time"}}};
  for (const double k : {1.0, 10.0, 100.0}) {
    table.add({"anywhere", k, "binary", 5'000.0, k, 100 + k});
    table.add({"anywhere", k, "insertion", 5'000.0, 30.0, 130.0});
    table.add({"anywhere", k, "heap", 5'000.0, 200.0, 300.0});
    table.add({"anywhere", k, "rebuild", 5'000.0, 20.0, 120.0});
  }
  return table;
}

TEST(SweepReinsertionExperiment, CallsTheSearchATautologyAndTheHeapAName) {
  const Finding finding = judged("sweep_reinsertion", {reinsertion_growth(1), mover_frames()});
  EXPECT_TRUE(verdict(finding, "search").starts_with("not testable: a tautology"))
      << verdict(finding, "search");
  EXPECT_TRUE(verdict(finding, "heap").starts_with("not testable: it names a method"));
}

TEST(SweepReinsertionExperiment, IsRefutedWhereJumpsMoveManyEvenIfTheyAreFewNearby) {
  const Finding finding = judged("sweep_reinsertion", {reinsertion_growth(0.02), mover_frames()});
  EXPECT_EQ(verdict(finding, "bound"), "refuted");
  EXPECT_NE(finding.reason.find("from about 21,512 boxes on"), std::string::npos) << finding.reason;
  EXPECT_NE(finding.reason.find("up to about 20.0 boxes"), std::string::npos) << finding.reason;
}

TEST(SweepReinsertionExperiment, IsConfirmedWhereNoReinsertionMovesMany) {
  Table few = reinsertion_growth(0);
  for (std::vector<Cell>& row : few.rows) row[3] = 1.0;
  EXPECT_EQ(verdict(judged("sweep_reinsertion", {few, mover_frames()}), "bound"), "confirmed");
}

TEST(SweepReinsertionExperiment, RefutesASearchThatLooksAtMore) {
  Table many = reinsertion_growth(0);
  for (std::vector<Cell>& row : many.rows) row[2] = std::get<double>(row[1]);
  EXPECT_EQ(verdict(judged("sweep_reinsertion", {many, mover_frames()}), "search"), "refuted");
}

TEST(SweepReinsertionExperiment, RefusesTablesWithoutWhatItJudgesBy) {
  EXPECT_THROW(judged("sweep_reinsertion", {reinsertion_growth(1)}), std::invalid_argument);
  Table near_only = reinsertion_growth(1);
  near_only.rows.resize(3);
  EXPECT_THROW(judged("sweep_reinsertion", {near_only, mover_frames()}), std::invalid_argument);
}

}  // namespace
}  // namespace broadside::lab
