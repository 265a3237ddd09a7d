// Finder: what it does around its searcher. Absent boxes, wrong boxes, sinks that throw.
#include "broadside/finder.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/sinks.hpp"

#include "tests/support/boxes.hpp"
#include "tests/support/searchers.hpp"

namespace broadside {
namespace {

using Search = std::function<void(std::span<const Box2>, PairSink&)>;

Finder<2> stub_finder(Search search) {
  return Finder<2>(std::make_unique<StubSearcher>(
      [search = std::move(search)](const SearchInput<2>& input, PairSink& pairs) {
        search(input.boxes, pairs);
        return std::nullopt;
      }));
}

/// Reports every pair of the boxes it is given.
void report_all(std::span<const Box2> boxes, PairSink& pairs) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size(); ++j) pairs.add(BoxId(j), BoxId(i));
  }
}

std::vector<Pair> find(Finder<2>& finder, std::span<const Box2> boxes) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  finder.find(boxes, collector);
  return pairs;
}

TEST(Finder, FlushesTheSink) {
  Finder<2> finder = stub_finder(report_all);
  EXPECT_EQ(find(finder, std::vector{at(0), at(1)}), (std::vector<Pair>{{BoxId{0}, BoxId{1}}}));
}

TEST(Finder, ShowsItsAlgorithmNoAbsentBoxAndGivesPairsTheCallersIds) {
  std::vector<Box2> seen;
  Finder<2> finder = stub_finder([&seen](std::span<const Box2> boxes, PairSink& pairs) {
    seen.assign(boxes.begin(), boxes.end());
    report_all(boxes, pairs);
  });
  const Box2 whole = {{-infinity, -infinity}, {infinity, infinity}};
  const std::vector<Box2> boxes = {absent_box<2>(), at(5), absent_box<2>(), whole, at(7), absent_box<2>()};
  EXPECT_EQ(find(finder, boxes),
            (std::vector<Pair>{{BoxId{1}, BoxId{3}}, {BoxId{1}, BoxId{4}}, {BoxId{3}, BoxId{4}}}));
  EXPECT_EQ(seen, (std::vector<Box2>{at(5), whole, at(7)}));
}

TEST(Finder, RenamesMorePairsThanFitIntoOneChunk) {
  Finder<2> finder = stub_finder(report_all);
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

TEST(Finder, ForgetsAbsentBoxesInTheNextSearch) {
  Finder<2> finder = stub_finder(report_all);
  find(finder, std::vector{absent_box<2>(), at(0), at(1)});
  EXPECT_EQ(find(finder, std::vector{at(0), at(1)}), (std::vector<Pair>{{BoxId{0}, BoxId{1}}}));
  EXPECT_EQ(find(finder, std::vector{absent_box<2>(), at(0)}), std::vector<Pair>{});
}

TEST(Finder, RefusesAWrongBoxBeforeAnythingHappens) {
  bool searched = false;
  Finder<2> finder = stub_finder([&searched](std::span<const Box2>, PairSink&) { searched = true; });
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

TEST(Finder, LeavesNothingInASinkThatThrew) {
  Finder<2> finder = stub_finder(report_all);
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

TEST(Finder, ForgetsThePairsOfASearchThatThrew) {
  std::vector<Pair> taken;
  PairCollector sink(taken);
  Finder<2> failing = stub_finder([](std::span<const Box2>, PairSink& pairs) {
    pairs.add(BoxId{0}, BoxId{1});
    throw std::runtime_error("out of luck");
  });
  EXPECT_THROW(failing.find(std::vector{at(0), at(1)}, sink), std::runtime_error);
  sink.flush();
  EXPECT_TRUE(taken.empty());
}

TEST(Finder, ReturnsWhatTheSearchCounted) {
  std::optional<Statistics> counted;
  Finder<2> finder(std::make_unique<StubSearcher>([&](const SearchInput<2>&, PairSink&) { return counted; }));
  PairCounter pairs;
  const std::vector<Box2> boxes = {at(0), absent_box<2>(), at(1)};
  EXPECT_FALSE(finder.find(boxes, pairs).has_value());
  counted = Statistics{.tests = 2, .references = 7};
  EXPECT_EQ(finder.find(boxes, pairs)->tests, 2u);
  EXPECT_EQ(finder.find(boxes, [](Pair) {})->references, 7u);
  EXPECT_EQ(finder.find_between(boxes, boxes, pairs)->tests, 2u);
  EXPECT_EQ(finder.find_across(boxes, 1, pairs)->tests, 2u);
}

TEST(Finder, DropsPairsWithinASetThatItsSearcherWrites) {
  Finder<2> finder = stub_finder(report_all);
  const std::vector<Box2> boxes = {at(0), at(0), at(0), at(0)};
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  finder.find_across(boxes, 1, collector);
  EXPECT_EQ(pairs, (std::vector<Pair>{{BoxId{0}, BoxId{0}}, {BoxId{0}, BoxId{1}}, {BoxId{0}, BoxId{2}}}));
}

TEST(Finder, RefusesIdsOutOfRangeOfItsSearcher) {
  for (const Pair wrong : {Pair{BoxId{1}, BoxId{3}}, Pair{BoxId{2}, BoxId{2}}}) {
    const auto write = [wrong](std::span<const Box2>, PairSink& pairs) {
      pairs.add(wrong.first, wrong.second);
    };
    Finder<2> finder = stub_finder(write);
    // One is absent: ids are renamed behind the searcher, in an array that ends with them.
    for (const Box2& last : {at(2), absent_box<2>()}) {
      std::vector<Pair> taken;
      PairCollector sink(taken);
      EXPECT_THROW(finder.find(std::vector{at(0), at(1), last}, sink), std::logic_error);
      EXPECT_TRUE(taken.empty());
    }
  }
}

TEST(Finder, HandsItsWorkersToItsSearcher) {
  std::size_t threads = 0;
  Finder<2> finder(std::make_unique<StubSearcher>([&](const SearchInput<2>& input, PairSink&) {
    threads = input.workers.threads;
    return std::nullopt;
  }));
  finder.set_workers({.threads = 3});
  find(finder, std::vector{at(0), at(1)});
  EXPECT_EQ(threads, 3u);
}

TEST(Finder, DecidesPairsOfDoublesAfterASearcherThatKnowsFloatsAlone) {
  Finder<2, double> finder(std::make_unique<StubSearcher>([](const SearchInput<2>& input, PairSink& pairs) {
    report_all(input.boxes, pairs);
    return std::nullopt;
  }));
  // As floats, all three touch.
  const std::vector<DoubleBox2> boxes = {
      {{0, 0}, {16777216, 1}}, {{16777217, 0}, {16777218, 1}}, {{16777218, 0}, {16777219, 1}}};
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  finder.find(boxes, collector);
  EXPECT_EQ(pairs, (std::vector<Pair>{{BoxId{1}, BoxId{2}}}));
}

TEST(Finder, IsAValueThatMoves) {
  Finder<2> first = stub_finder(report_all);
  first.set_bad_input(BadInput::quarantine);
  Finder<2> second = std::move(first);
  EXPECT_EQ(second.bad_input(), BadInput::quarantine);
  EXPECT_EQ(find(second, std::vector{at(0), at(1)}).size(), 1u);
  first = Finder<2>("grid");
  EXPECT_EQ(find(first, std::vector{at(0), at(5)}).size(), 0u);
}

TEST(Finder, RefusesANullSearcher) {
  EXPECT_THROW(Finder<2>(std::unique_ptr<Searcher<2>>()), std::invalid_argument);
  EXPECT_THROW((Finder<3, double>(std::unique_ptr<Searcher<3>>())), std::invalid_argument);
}

}  // namespace
}  // namespace broadside
