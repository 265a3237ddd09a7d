// PairFinder: what it does around its algorithm. Absent boxes, wrong boxes, sinks that throw.
#include "broadside/finder.hpp"

#include <functional>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "tests/support/boxes.hpp"

namespace broadside {
namespace {

/// Calls a function with what an algorithm gets to see.
class StubFinder final : public PairFinder<2> {
 public:
  using Search = std::function<void(std::span<const Box2>, PairSink&)>;

  explicit StubFinder(Search search) : search_(std::move(search)) {}

  using PairFinder<2>::count;

 private:
  void find_valid(std::span<const Box2> boxes, PairSink& pairs) override { search_(boxes, pairs); }

  Search search_;
};

/// Reports every pair of the boxes it is given.
void report_all(std::span<const Box2> boxes, PairSink& pairs) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size(); ++j) pairs.add(BoxId(j), BoxId(i));
  }
}

std::vector<Pair> find(PairFinder<2>& finder, std::span<const Box2> boxes) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  finder.find(boxes, collector);
  return pairs;
}

TEST(PairFinder, FlushesTheSink) {
  StubFinder finder(report_all);
  EXPECT_EQ(find(finder, std::vector{at(0), at(1)}), (std::vector<Pair>{{BoxId{0}, BoxId{1}}}));
}

TEST(PairFinder, ShowsItsAlgorithmNoAbsentBoxAndGivesPairsTheCallersIds) {
  std::vector<Box2> seen;
  StubFinder finder([&seen](std::span<const Box2> boxes, PairSink& pairs) {
    seen.assign(boxes.begin(), boxes.end());
    report_all(boxes, pairs);
  });
  const Box2 whole = {{-infinity, -infinity}, {infinity, infinity}};
  const std::vector<Box2> boxes = {absent_box<2>(), at(5), absent_box<2>(), whole, at(7), absent_box<2>()};
  EXPECT_EQ(find(finder, boxes),
            (std::vector<Pair>{{BoxId{1}, BoxId{3}}, {BoxId{1}, BoxId{4}}, {BoxId{3}, BoxId{4}}}));
  EXPECT_EQ(seen, (std::vector<Box2>{at(5), whole, at(7)}));
}

TEST(PairFinder, RenamesMorePairsThanFitIntoOneChunk) {
  StubFinder finder(report_all);
  std::vector<Box2> boxes(200, at(0));
  boxes.insert(boxes.begin() + 100, absent_box<2>());
  const std::vector<Pair> pairs = find(finder, boxes);
  ASSERT_EQ(pairs.size(), 200u * 199 / 2);
  std::size_t k = 0;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
      if (i == 100 || j == 100) continue;
      ASSERT_EQ(pairs[k++], (Pair{BoxId{i}, BoxId{j}}));
    }
  }
}

TEST(PairFinder, ForgetsAbsentBoxesInTheNextSearch) {
  StubFinder finder(report_all);
  find(finder, std::vector{absent_box<2>(), at(0), at(1)});
  EXPECT_EQ(find(finder, std::vector{at(0), at(1)}), (std::vector<Pair>{{BoxId{0}, BoxId{1}}}));
  EXPECT_EQ(find(finder, std::vector{absent_box<2>(), at(0)}), std::vector<Pair>{});
}

TEST(PairFinder, RefusesAWrongBoxBeforeAnythingHappens) {
  bool searched = false;
  StubFinder finder([&searched](std::span<const Box2>, PairSink&) { searched = true; });
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  const std::vector<Box2> boxes = {at(0), absent_box<2>(), {{0, 2}, {1, 1}}};
  try {
    finder.find(boxes, collector);
    FAIL() << "nothing was thrown";
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.index(), 2u);
  }
  EXPECT_FALSE(searched);
  EXPECT_TRUE(pairs.empty());
}

TEST(PairFinder, LeavesNothingInASinkThatThrew) {
  StubFinder finder(report_all);
  for (const bool with_absent : {false, true}) {
    std::vector<Pair> taken;
    bool full = true;
    PairFunction sink([&](std::span<const Pair> pairs) {
      if (full) throw std::runtime_error("full");
      taken.insert(taken.end(), pairs.begin(), pairs.end());
    });
    std::vector<Box2> boxes(100, at(0));
    if (with_absent) boxes.push_back(absent_box<2>());
    EXPECT_THROW(finder.find(boxes, sink), std::runtime_error);
    full = false;
    finder.find(std::vector{at(0), at(1)}, sink);
    EXPECT_EQ(taken, (std::vector<Pair>{{BoxId{0}, BoxId{1}}})) << with_absent;
  }
}

TEST(PairFinder, ForgetsThePairsOfASearchThatThrew) {
  std::vector<Pair> taken;
  PairCollector sink(taken);
  StubFinder failing([](std::span<const Box2>, PairSink& pairs) {
    pairs.add(BoxId{0}, BoxId{1});
    throw std::runtime_error("out of luck");
  });
  EXPECT_THROW(failing.find(std::vector{at(0), at(1)}, sink), std::runtime_error);
  sink.flush();
  EXPECT_TRUE(taken.empty());
}

TEST(PairFinder, TellsWhatTheLastSearchCountedAndNothingOlder) {
  bool counts = true;
  StubFinder* self = nullptr;
  StubFinder finder([&](std::span<const Box2> boxes, PairSink&) {
    if (counts) self->count({.tests = boxes.size(), .references = 7});
  });
  self = &finder;
  EXPECT_FALSE(finder.statistics().has_value());
  find(finder, std::vector{at(0), absent_box<2>(), at(1)});
  ASSERT_TRUE(finder.statistics().has_value());
  EXPECT_EQ(finder.statistics()->tests, 2u);
  EXPECT_EQ(finder.statistics()->references, 7u);
  counts = false;
  find(finder, std::vector{at(0)});
  EXPECT_FALSE(finder.statistics().has_value());
}

}  // namespace
}  // namespace broadside
