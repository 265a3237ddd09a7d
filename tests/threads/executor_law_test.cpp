// The law of executors: whatever order they run tasks in and whatever they throw, pairs are right afterwards.
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"
#include "broadside/world.hpp"

#include "law_case.hpp"
#include "searches.hpp"
#include "tests/support/executors.hpp"

namespace broadside::laws {
namespace {

class ExecutorLaw : public Law {};

/// Calls `search(executor)` with executors of which another run fails each time, until none does; `check()`
/// after each that threw.
template <typename Search, typename Check>
void fail_each_run(const Search& search, const Check& check) {
  for (const bool is_half_way : {false, true}) {
    bool threw = true;
    for (std::size_t run = 0; threw; ++run) {
      FailingExecutor executor;
      executor.failing_run = run;
      executor.is_half_way = is_half_way;
      threw = false;
      try {
        search(executor);
      } catch (const NotAnException&) {
        threw = true;
        check();
      }
      ASSERT_EQ(threw, executor.runs > run);
      ASSERT_TRUE(threw || run > 0);
    }
  }
}

TEST_P(ExecutorLaw, FindsTheSamePairsAfterAnyRunThrewWhatIsNoException) {
  in_dimension([&]<int D>() {
    Finder<D> finder(algorithm(), spec());
    const std::vector<Box<D>> boxes = scattered_boxes<D>(2000, D == 2 ? 40 : 12);
    const std::vector<Pair> expected = found(finder, boxes);
    fail_each_run(
        [&](Executor& executor) {
          finder.set_workers(workers(3, &executor));
          EXPECT_EQ(found(finder, boxes), expected);
        },
        [&] {
          finder.set_workers(workers(2));
          EXPECT_EQ(found(finder, boxes), expected);
        });
  });
}

TEST_P(ExecutorLaw, LosesAndDoublesNoEventOfAWorldWhereAnyRunThrew) {
  in_dimension([&]<int D>() {
    const std::vector<Box<D>> boxes = scattered_boxes<D>(400, D == 2 ? 20 : 7);
    bool ran = true;
    for (std::size_t run = 0; ran; ++run) {
      FailingExecutor executor;
      executor.failing_run = run;
      executor.is_half_way = run % 2 != 0;
      World<D> world(spec().text());
      world.set_workers(workers(3, &executor));
      std::vector<Handle> handles(boxes.size());
      world.add(boxes, handles);
      std::size_t pairs = 0;
      for (const std::size_t movers : {boxes.size() / 8, boxes.size(), boxes.size() / 8}) {
        std::vector<Box<D>> now = boxes;
        for (std::size_t i = 0; i < movers; ++i) {
          now[i].min[0] += static_cast<float>(movers % 7);
          now[i].max[0] += static_cast<float>(movers % 7);
        }
        world.move(std::span(handles).first(movers), std::span<const Box<D>>(now).first(movers));
        Events events;
        try {
          events = world.update();
        } catch (const NotAnException&) {
          events = world.update();
        }
        pairs += events.begun.size();
        pairs -= events.ended.size();
        std::vector<Box<D>> seen;
        for (const Handle handle : handles) seen.push_back(world.box(handle));
        ASSERT_EQ(pairs, find_pairs(seen, {.algorithm = "brute_force"}).size()) << "run " << run;
        ASSERT_EQ(world.pairs().size(), pairs) << "run " << run;
      }
      ran = executor.runs > run;
      ASSERT_TRUE(ran || run > 0);
    }
  });
}

TEST_P(ExecutorLaw, FindsTheSamePairsWhereTasksAndSearchesRunWithinTasks) {
  in_dimension([&]<int D>() {
    Finder<D> outer(algorithm(), spec());
    Finder<D> inner(algorithm(), spec());
    const std::vector<Box<D>> boxes = scattered_boxes<D>(3000, D == 2 ? 40 : 12);
    const std::vector<Box<D>> others = scattered_boxes<D>(2000, D == 2 ? 40 : 12, 2);
    const std::vector<Pair> expected = found(outer, boxes);
    const std::vector<Pair> expected_of_others = found(outer, others);
    NestingExecutor nesting;
    outer.set_workers(workers(7, &nesting));
    inner.set_workers(workers(4, &nesting));
    std::vector<Pair> pairs;
    int inner_searches = 0;
    PairFunction sink([&](std::span<const Pair> chunk) {
      pairs.insert(pairs.end(), chunk.begin(), chunk.end());
      nesting.idle();
      if (inner_searches == 3) return;
      ++inner_searches;
      std::vector<Pair> inner_pairs;
      PairFunction inner_sink([&](std::span<const Pair> inner_chunk) {
        inner_pairs.insert(inner_pairs.end(), inner_chunk.begin(), inner_chunk.end());
        nesting.idle();
      });
      inner.find(others, inner_sink);
      EXPECT_EQ(inner_pairs, expected_of_others);
    });
    outer.find(boxes, sink);
    EXPECT_EQ(pairs, expected);
    EXPECT_EQ(inner_searches, 3);
  });
}

INSTANTIATE_TEST_SUITE_P(Own, ExecutorLaw, testing::ValuesIn(threaded_cases()), case_name);

TEST(WorldExecutor, MayThrowAnythingWhereAnUpdateGivesMemoryBack) {
  const std::vector<Box2> boxes = scattered_boxes<2>(6000, 600);
  for (const char* const algorithm : {"grid", "auto"}) {
    const auto pairs_left = find_pairs(std::span(boxes).first(500), {.algorithm = "brute_force"}).size();
    bool threw = true;
    for (std::size_t run = 0; threw; ++run) {
      FailingExecutor executor;
      World2 world(algorithm);
      world.set_workers(workers(2, &executor));
      std::vector<Handle> handles(boxes.size());
      world.add(boxes, handles);
      world.update();
      world.remove(std::span(handles).subspan(500));
      world.update();
      executor.failing_run = executor.runs + run;
      try {
        world.update();
      } catch (const NotAnException&) {
        world.update();
      }
      threw = executor.runs > executor.failing_run;
      EXPECT_EQ(world.statistics().slots, 500u);
      EXPECT_EQ(world.pairs().size(), pairs_left);
      executor.failing_run = std::numeric_limits<std::size_t>::max();
      world.remove(handles[0]);
      EXPECT_NO_THROW(world.update());
    }
  }
}

}  // namespace
}  // namespace broadside::laws
