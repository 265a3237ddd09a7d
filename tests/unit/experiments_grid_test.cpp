// What the experiments on brute force and grids (sections II and III of the paper) make of tables made by
// hand.
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "lab/experiments/experiment.hpp"

namespace broadside::lab {
namespace {

Finding judge(const char* experiment, const std::vector<Table>& tables) {
  return find_experiment(experiment).judge(tables);
}

double figure(const Finding& finding, const std::string& name) {
  for (const Figure& one : finding.figures) {
    if (one.name == name) return one.value;
  }
  throw std::invalid_argument("no figure " + name);
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
  const std::vector<std::string> ours = {"grid", "sweep_and_prune", "quadtree", "hierarchical_grid", "bvh"};
  return {race("paper", "paper_brute_force", {"paper_grid", "paper_sweep_and_prune", "paper_quadtree"}, tests,
               time),
          race("ours", "brute_force", ours, tests, time), race("ours_3d", "brute_force", ours, tests, time)};
}

TEST(Overtaking, HoldsFromWhereTheOthersAreFaster) {
  const Finding finding =
      judge("overtaking", races([](double) { return 8.0; }, [](double) { return 100.0; }));
  EXPECT_EQ(finding.verdict_text(), "holds when there are more than about 100 boxes");
  EXPECT_NEAR(figure(finding, "paper_grid_from"), 100, 1e-6);
  EXPECT_NEAR(figure(finding, "bvh_3d_from"), 100, 1e-6);
  EXPECT_NEAR(figure(finding, "paper_grid_tests_growth"), 0, 1e-6);
}

TEST(Overtaking, HoldsWhereTheOthersAreFasterFromTheFewestOn) {
  EXPECT_EQ(judge("overtaking", races([](double) { return 8.0; }, [](double) { return 1.0; })).verdict,
            Verdict::holds);
}

TEST(Overtaking, DoesNotHoldWhereOneIsNeverFasterOrTestsGrowAsInBruteForce) {
  const Finding slow = judge("overtaking", races([](double) { return 8.0; }, [](double n) { return 2 * n; }));
  EXPECT_EQ(slow.verdict, Verdict::does_not_hold);
  EXPECT_NE(slow.reason.find("paper_grid never"), std::string::npos) << slow.reason;
  EXPECT_EQ(judge("overtaking", races([](double n) { return n / 4; }, [](double) { return 1.0; })).verdict,
            Verdict::does_not_hold);
}

TEST(Overtaking, AsksForItsTablesAndForThreeRowsOfEachAlgorithm) {
  std::vector<Table> tables = races([](double) { return 8.0; }, [](double) { return 100.0; });
  EXPECT_THROW(judge("overtaking", {tables[0], tables[1]}), std::invalid_argument);
  tables[0].rows.resize(8);
  EXPECT_THROW(judge("overtaking", tables), std::invalid_argument);
}

}  // namespace
}  // namespace broadside::lab
