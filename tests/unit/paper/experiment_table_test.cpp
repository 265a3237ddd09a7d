// Tables of experiments, how their numbers grow, and where one line crosses another.
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "paper/experiments/table.hpp"
#include "tests/support/message.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using Points = std::vector<std::pair<double, double>>;

Table times() {
  Table table{.name = "times", .title = "Times", .columns = {{"algorithm"}, {"boxes"}, {"time", "ms"}}};
  table.add({"grid", 10.0, 1.0});
  table.add({"bvh", 10.0, 2.0});
  table.add({"grid", 20.0, {}});
  table.add({"bvh", 20.0, 3.0});
  return table;
}

TEST(ExperimentTable, GivesColumnsByNameAndLeavesOutWhatIsNotThere) {
  const Table table = times();
  EXPECT_EQ(table.column("time"), 2u);
  EXPECT_THAT(table.numbers("time"), ElementsAre(1, 2, 3));
  EXPECT_THAT(table.texts("algorithm"), ElementsAre("grid", "bvh", "grid", "bvh"));
  EXPECT_THAT(table.numbers("algorithm"), ElementsAre());
  EXPECT_THAT(table.distinct_texts("algorithm"), ElementsAre("grid", "bvh"));
  EXPECT_THAT(table.distinct_numbers("boxes"), ElementsAre(10, 20));
  EXPECT_THAT(table.points("boxes", "time"), ElementsAre(Pair(10, 1), Pair(10, 2), Pair(20, 3)));
}

TEST(ExperimentTable, KeepsTheRowsThatHaveACell) {
  const Table bvh = times().where("algorithm", "bvh");
  EXPECT_THAT(bvh.points("boxes", "time"), ElementsAre(Pair(10, 2), Pair(20, 3)));
  EXPECT_EQ(bvh.columns, times().columns);
  EXPECT_TRUE(times().where("boxes", 15.0).rows.empty());
}

TEST(ExperimentTable, SaysWhichColumnAndTableThereIsNot) {
  EXPECT_THAT(message_of<std::invalid_argument>([] { times().column("tme"); }),
              AllOf(HasSubstr("'times'"), HasSubstr("'tme'"), HasSubstr("algorithm, boxes, time")));
  EXPECT_THAT(message_of<std::invalid_argument>([] { times().where("tme", 1.0); }), HasSubstr("'tme'"));
  EXPECT_THAT(message_of<std::invalid_argument>([] { times().points("boxes", "tme"); }), HasSubstr("'tme'"));
  EXPECT_THAT(message_of<std::invalid_argument>([] { table_named({times()}, "tests"); }),
              HasSubstr("'tests'"));
  EXPECT_EQ(table_named({times()}, "times").title, "Times");
}

TEST(ExperimentTable, RefusesARowThatDoesNotFitAndANumberThatIsNone) {
  Table table = times();
  EXPECT_THAT(message_of<std::invalid_argument>([&] {
                table.add({"grid", 10.0});
              }),
              AllOf(HasSubstr("2 cells"), HasSubstr("expected 3")));
  for (const double number :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(message_of<std::invalid_argument>([&] {
                  table.add({"grid", 10.0, number});
                }),
                AllOf(HasSubstr("row 5"), HasSubstr("'time'"), HasSubstr("finite")));
  }
  EXPECT_EQ(table, times());
}

TEST(Growth, IsTheExponentOfAPower) {
  EXPECT_NEAR(growth_of({{1, 3}, {10, 300}, {100, 30'000}}), 2, 1e-12);
  EXPECT_NEAR(growth_of({{5, 7}, {50, 7}}), 0, 1e-12);
  EXPECT_NEAR(growth_of({{1, 8}, {2, 4}, {4, 2}}), -1, 1e-12);
}

TEST(Growth, RefusesPointsThatTellNothing) {
  for (const Points& points :
       {Points{}, Points{{1, 1}}, Points{{2, 1}, {2, 5}}, Points{{1, 0}, {2, 1}}, Points{{-1, 1}, {2, 1}}})
    EXPECT_THROW(growth_of(points), std::invalid_argument);
}

TEST(Crossover, IsWhereALineGoesBelowAnotherForGood) {
  const Points flat = {{1, 10}, {10, 10}, {100, 10}, {1'000, 10}};
  EXPECT_NEAR(crossover(flat, {{1, 1}, {10, 1}, {100, 100}, {1'000, 1'000}}).value(), 31.6228, 1e-3);
  // Below, above, below: the last time counts.
  EXPECT_NEAR(crossover(flat, {{1, 100}, {10, 100}, {100, 1}, {1'000, 100}}).value(), 316.228, 1e-2);
  EXPECT_EQ(crossover(flat, {{1, 11}, {10, 11}, {100, 11}, {1'000, 11}}), 1);
  EXPECT_EQ(crossover(flat, {{1, 11}, {10, 11}, {100, 11}, {1'000, 9}}), std::nullopt);
  EXPECT_EQ(crossover(flat, flat), std::nullopt);
}

TEST(Crossover, RefusesLinesThatAreNotOverTheSameX) {
  const Points line = {{1, 10}, {10, 10}};
  EXPECT_THROW(crossover({}, {}), std::invalid_argument);
  EXPECT_THROW(crossover(line, {{1, 10}}), std::invalid_argument);
  EXPECT_THROW(crossover(line, {{1, 10}, {11, 10}}), std::invalid_argument);
  EXPECT_THROW(crossover(line, {{1, 10}, {10, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace broadside::lab
