// docs/paper/errata.md on Algorithms 5 and 6: each printed listing goes wrong on its input, the mended one
// does not.
#include "paper_errata.hpp"

namespace broadside::paper {
namespace {

using enum printed::To;

/// Algorithm 5 with an active list that begins empty.
Record sweep(const std::vector<Box2>& boxes) {
  Record record;
  printed::Collection f;
  printed::algorithm_5_sweep(objects(boxes), f, excluding, record.sink());
  return record;
}

TEST(Erratum5a, TheLoopToTheLengthReadsPastTheEnd) {
  const std::vector<Box2> boxes = {box(0, 0, 1, 1)};
  Record record;
  printed::Collection f;
  expect_past_the_end("Algorithm 5",
                      [&] { printed::algorithm_5_sweep(objects(boxes), f, including, record.sink()); });
  expect_right("paper_sweep_and_prune", boxes);
}

TEST(Erratum5b, WithoutASortWhatStillMattersIsPruned) {
  const std::vector<Box2> boxes = {box(0, 0, 1, 1), box(5, 0, 6, 1), box(0, 0, 2, 1)};
  EXPECT_EQ(sweep(boxes).times(0, 2), 0U);
  expect_right("paper_sweep_and_prune", boxes);
}

TEST(Erratum5c, TheWholeActiveListIsTestedAtEachStep) {
  const std::vector<Box2> boxes(3, box(0, 0, 1, 1));
  EXPECT_EQ(sweep(boxes).times(0, 1), 2U);
  EXPECT_EQ(sweep(boxes).size(), 1U + 3U + 6U);
  EXPECT_EQ(expect_right("paper_sweep_and_prune", boxes).tests, 3U);
}

TEST(Erratum5d, TheActiveListIsNeverEmptied) {
  Record record;
  printed::Collection f;
  printed::algorithm_5_sweep({{BoxId{0}, box(0, 0, 1, 1)}}, f, excluding, record.sink());
  printed::algorithm_5_sweep({{BoxId{1}, box(0, 0, 1, 1)}}, f, excluding, record.sink());
  EXPECT_EQ(record.times(0, 1), 1U) << "a pair of boxes of two different sweeps";

  Finder<2> finder("paper_sweep_and_prune");
  PairCounter pairs;
  for (int call = 0; call < 2; ++call) finder.find(std::vector<Box2>{box(0, 0, 1, 1)}, pairs);
  EXPECT_EQ(pairs.count(), 0U);
}

TEST(Erratum6a, TheLoopToTheLengthReadsPastTheEnd) {
  const std::vector<Box2> boxes = {box(0, 0, 3, 1), box(2, 0, 3, 1)};
  printed::Collection f = objects({boxes[0]});
  expect_past_the_end("Algorithm 6", [&] { printed::algorithm_6_prune(f, objects(boxes)[1], including); });
  expect_right("paper_sweep_and_prune", boxes);
}

TEST(Erratum6b, WhatFollowsARemovedElementIsSkipped) {
  const std::vector<Box2> boxes = {box(0, 0, 1, 1), box(0, 0, 1, 1), box(2, 0, 3, 1)};
  printed::Collection f = objects({boxes[0], boxes[1]});
  printed::algorithm_6_prune(f, objects(boxes)[2], excluding);
  EXPECT_EQ(f.size(), 1U);
  EXPECT_EQ(sweep(boxes).times(1, 2), 1U);
  EXPECT_EQ(expect_right("paper_sweep_and_prune", boxes).tests, 1U);
}

TEST(ErratumT2, FromTheFurthestAwayNothingIsEverPruned) {
  const std::vector<Box2> furthest_first = {box(4, 0, 5, 1), box(2, 0, 3, 1), box(0, 0, 1, 1)};
  EXPECT_EQ(sweep(furthest_first).times(0, 2), 1U);
  EXPECT_EQ(expect_right("paper_sweep_and_prune", furthest_first).tests, 0U);
}

TEST(ErratumT13, APruneIsByOrderAndNotByEquality) {
  const auto active_after = [](const Box2& next) {
    printed::Collection f = objects({box(0, 0, 1, 1)});
    printed::algorithm_6_prune(f, {BoxId{1}, next}, excluding);
    return f.size();
  };
  EXPECT_EQ(active_after(box(2, 0, 3, 1)), 0U) << "the ends differ, and it is pruned";
  EXPECT_EQ(active_after(box(1, 0, 3, 1)), 1U) << "the ends are equal, and it stays";
}

TEST(ErratumT15, ANewObjectHasNoneToCollideWithWhereNoneIsActive) {
  const std::vector<Box2> apart = {box(0, 0, 1, 1), box(2, 0, 3, 1), box(4, 0, 5, 1)};
  EXPECT_EQ(sweep(apart).size(), 3U) << "each with itself";
  EXPECT_EQ(expect_right("paper_sweep_and_prune", apart).tests, 0U);
}

}  // namespace
}  // namespace broadside::paper
