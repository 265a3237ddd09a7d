// The verdicts of the experiments on sweep and prune follow from their tables.
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "lab/experiments/experiment.hpp"

namespace broadside::lab {
namespace {

Finding judged(const char* experiment, const std::vector<Table>& tables) {
  return find_experiment(experiment).judge(tables);
}

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

TEST(SweepAxisExperiment, HoldsWhereBoundlessWorldsCostNothing) {
  const Finding finding = judged("sweep_axis", {worlds(1, 1), axes(), growth()});
  EXPECT_EQ(finding.verdict, Verdict::holds);
  EXPECT_NE(finding.reason.find("12.0 times the best one's time (one_line 2D)"), std::string::npos)
      << finding.reason;
  EXPECT_NE(finding.reason.find("n^2.00 in 2D"), std::string::npos) << finding.reason;
}

TEST(SweepAxisExperiment, HoldsWhenNoBoxIsInfiniteWhereThoseCost) {
  EXPECT_EQ(judged("sweep_axis", {worlds(1, 30), axes(), growth()}).verdict_text(),
            "holds when no box is infinite");
}

TEST(SweepAxisExperiment, DoesNotHoldWhereABoxFarAwayCosts) {
  EXPECT_EQ(judged("sweep_axis", {worlds(30, 1), axes(), growth()}).verdict, Verdict::does_not_hold);
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

}  // namespace
}  // namespace broadside::lab
