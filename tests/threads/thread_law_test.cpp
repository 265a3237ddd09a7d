// The law of threads: the same pairs in the same order, whoever does the work and however many.
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/debug/history.hpp"
#include "broadside/debug/outline.hpp"
#include "broadside/error.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"
#include "broadside/world.hpp"

#include "hard_inputs.hpp"
#include "law_case.hpp"
#include "law_sinks.hpp"
#include "searches.hpp"
#include "tests/support/executors.hpp"
#include "tests/support/rng.hpp"
#include "whole_frames.hpp"

namespace broadside::laws {
namespace {

/// Who may do the work.
struct Crew {
  std::string name;
  Workers workers;
};

class ThreadLaw : public Law {
 protected:
  /// Every number of threads and every executor that the law is tested with; a sanitizer sees no more in
  /// fewer threads.
  std::vector<Crew> crews() {
    std::vector<Crew> crews = {{"7 threads", workers(7)},
                               {"5 threads in reverse", workers(5, &reverse_)},
                               {"all threads of their own", workers(0, &threads_)},
                               {"3 threads and the caller's", workers(3, &team_)},
                               {"4 threads in any order", workers(4, &shuffling_)}};
    if (!sanitized) {
      crews.push_back({"2 threads", workers(2)});
      crews.push_back({"4 threads", workers(4)});
    }
    return crews;
  }

  ReverseExecutor reverse_;
  ThreadExecutor threads_;
  TeamExecutor team_;
  ShufflingExecutor shuffling_;
};

TEST_P(ThreadLaw, FindsTheSamePairsInTheSameOrder) {
  in_dimension([&]<int D>() {
    Finder<D> alone(algorithm(), spec());
    Finder<D> shared(algorithm(), spec());
    std::vector<Input<D>> inputs = hard_inputs<D>(algorithm(), reduced(1000));
    inputs.push_back({"scattered", scattered_boxes<D>(reduced(20'000, 1), D == 2 ? 300 : 50)});
    for (const Input<D>& input : inputs) {
      std::vector<Pair> expected;
      PairCollector expected_pairs(expected);
      const std::optional<Statistics> expected_statistics = alone.find(input.boxes, expected_pairs);
      for (const Crew& crew : crews()) {
        shared.set_workers(crew.workers);
        std::vector<Pair> pairs;
        PairCollector collector(pairs);
        const std::optional<Statistics> statistics = shared.find(input.boxes, collector);
        EXPECT_EQ(pairs, expected) << input.name << ", " << crew.name;
        EXPECT_EQ(statistics->tests, expected_statistics->tests) << input.name;
        EXPECT_EQ(statistics->references, expected_statistics->references) << input.name;
      }
    }
  });
}

TEST_P(ThreadLaw, FindsTheSamePairsBetweenSetsInTheSameOrder) {
  in_dimension([&]<int D>() {
    Finder<D> alone(algorithm(), spec());
    Finder<D> shared(algorithm(), spec());
    std::vector<Box<D>> boxes = scattered_boxes<D>(3000, 60);
    for (const bool with_absent : {false, true}) {
      if (with_absent) boxes[700] = absent_box<D>();
      for (const std::size_t left_count : {1, 800, 2999}) {
        const std::vector<Pair> expected = found(alone, boxes, left_count);
        for (const Crew& crew : crews()) {
          shared.set_workers(crew.workers);
          EXPECT_EQ(found(shared, boxes, left_count), expected) << left_count << ", " << crew.name;
        }
      }
    }
  });
}

TEST_P(ThreadLaw, FindsTheSamePairsOfDoublesInTheSameOrder) {
  in_dimension([&]<int D>() {
    Finder<D, double> alone(algorithm(), spec());
    Finder<D, double> shared(algorithm(), spec());
    Rng rng(5);
    for (const double shift : {0.0, 1e9}) {
      std::vector<Box<D, double>> boxes(2000);
      for (Box<D, double>& box : boxes) {
        for (int axis = 0; axis < D; ++axis) {
          box.min[axis] = shift + (rng.one_in(3) ? 1e7 : 0) + rng.between(0, 30);
          box.max[axis] = box.min[axis] + rng.between(0, 2);
        }
      }
      boxes[3] = absent_box<D, double>();
      for (const std::size_t left_count : {0, 900}) {
        const std::vector<Pair> expected = found(alone, boxes, left_count);
        EXPECT_FALSE(expected.empty());
        for (const Crew& crew : crews()) {
          shared.set_workers(crew.workers);
          EXPECT_EQ(found(shared, boxes, left_count), expected) << left_count << ", " << crew.name;
        }
      }
    }
  });
}

TEST_P(ThreadLaw, CountsAndHashesWithoutAnOrder) {
  in_dimension([&]<int D>() {
    Finder<D> finder(algorithm(), spec());
    const std::vector<Box<D>> boxes = scattered_boxes<D>(3000, D == 2 ? 60 : 20);
    PairCounter count;
    PairHasher hash;
    finder.find(boxes, count);
    finder.find(boxes, hash);
    ASSERT_GT(count.count(), 1000u);
    for (const Crew& crew : crews()) {
      finder.set_workers(crew.workers);
      PairCounter shared_count;
      PairHasher shared_hash;
      for (int round = 1; round <= 2; ++round) {  // a sink adds up what it gets
        finder.find(boxes, shared_count);
        finder.find(boxes, shared_hash);
        EXPECT_EQ(shared_count.count(), round * count.count()) << crew.name;
        EXPECT_EQ(shared_hash.count(), round * hash.count()) << crew.name;
        EXPECT_EQ(shared_hash.hash(), round * hash.hash()) << crew.name;
      }
    }
  });
}

TEST_P(ThreadLaw, CallsASinkInTheCallersThreadAlone) {
  in_dimension([&]<int D>() {
    Finder<D> finder(algorithm(), spec());
    const std::vector<Box<D>> boxes = scattered_boxes<D>(3000, 60);
    for (const Crew& crew : crews()) {
      finder.set_workers(crew.workers);
      std::size_t calls = 0;
      PairFunction function([&calls, caller = std::this_thread::get_id()](std::span<const Pair>) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        ++calls;
      });
      finder.find(boxes, function);
      EXPECT_GT(calls, 0u) << crew.name;
    }
  });
}

TEST_P(ThreadLaw, NamesTheFirstWrongBox) {
  in_dimension([&]<int D>() {
    Finder<D> finder(algorithm(), spec());
    std::vector<Box<D>> boxes = scattered_boxes<D>(3000, 60);
    for (const std::size_t wrong : {2900, 1700, 31}) {
      boxes[wrong].max[0] = boxes[wrong].min[0] - 1;
      for (const Crew& crew : crews()) {
        finder.set_workers(crew.workers);
        try {
          found(finder, boxes);
          ADD_FAILURE() << "nothing was thrown by " << crew.name;
        } catch (const InvalidInput& error) {
          EXPECT_EQ(error.index(), wrong) << crew.name;
        }
      }
    }
  });
}

TEST_P(ThreadLaw, LetsThroughWhatASinkThrowsAndCanBeUsedAfter) {
  in_dimension([&]<int D>() {
    Finder<D> finder(algorithm(), spec());
    const std::vector<Box<D>> boxes = scattered_boxes<D>(3000, D == 2 ? 30 : 12);
    const std::vector<Pair> expected = found(finder, boxes);
    for (const Crew& crew : crews()) {
      finder.set_workers(crew.workers);
      for (const int chunks : {0, 1, 4}) {
        PairFunction function([left = chunks](std::span<const Pair>) mutable {
          if (left-- == 0) throw SinkIsFull();
        });
        EXPECT_THROW(finder.find(boxes, function), SinkIsFull) << crew.name;
        EXPECT_EQ(found(finder, boxes), expected) << crew.name;
      }
    }
  });
}

TEST_P(ThreadLaw, LetsThroughWhatAnExecutorThrowsAndATrackerDeliversThatFrameAfter) {
  in_dimension([&]<int D>() {
    ClosedExecutor closed;
    Tracker<D> tracker(algorithm(), spec());
    const std::vector<Box<D>> boxes = scattered_boxes<D>(300, 10);
    std::vector<Pair> begun;
    PairCollector begun_pairs(begun);
    PairCounter ended;
    tracker.set_workers(workers(2, &closed));
    EXPECT_THROW(tracker.update({boxes, {}}, begun_pairs, ended), ExecutorIsClosed);
    EXPECT_TRUE(begun.empty());
    tracker.set_workers(workers(2));
    tracker.update({boxes, {}}, begun_pairs, ended);
    EXPECT_EQ(begun, pairs_of(WholeFrame<D>{.boxes = boxes}));
    EXPECT_EQ(ended.count(), 0u);
  });
}

/// Frames in which few boxes move, then all, then few again; each mover goes some way, or far.
template <int D>
std::vector<Step<D>> frames_of(std::vector<Box<D>> boxes, std::size_t few) {
  Rng rng(7);
  std::vector<Step<D>> steps;
  for (const std::size_t movers : {few, few, boxes.size(), few, few}) {
    Step<D> step{boxes.size(), {}, {}};
    for (std::size_t i = 0; i < movers; ++i) {
      const std::size_t place = i * (boxes.size() / movers);
      for (int axis = 0; axis < D; ++axis) {
        const auto way = static_cast<float>(rng.one_in(8) ? rng.between(-20, 20) : rng.between(-0.5, 0.5));
        boxes[place].min[axis] += way;
        boxes[place].max[axis] += way;
      }
      step.changed.push_back(BoxId(place));
      step.boxes.push_back(boxes[place]);
    }
    steps.push_back(step);
  }
  return steps;
}

TEST_P(ThreadLaw, FollowsBoxesToTheSameEventsByTheSameTests) {
  in_dimension([&]<int D>() {
    const std::vector<Box<D>> first = scattered_boxes<D>(reduced(12'000, 1), D == 2 ? 200 : 40);
    for (const Crew& crew : crews()) {
      Tracker<D> alone(algorithm(), spec());
      Tracker<D> shared(algorithm(), spec());
      shared.set_workers(crew.workers);
      std::vector<Box<D>> boxes = first;
      const auto update = [&](std::span<const BoxId> changed) {
        std::array<std::vector<Pair>, 4> events;
        PairCollector begun(events[0]);
        PairCollector ended(events[1]);
        PairCollector shared_begun(events[2]);
        PairCollector shared_ended(events[3]);
        const auto expected = alone.update({boxes, changed}, begun, ended);
        const auto statistics = shared.update({boxes, changed}, shared_begun, shared_ended);
        EXPECT_EQ(events[2], events[0]) << crew.name;
        EXPECT_EQ(events[3], events[1]) << crew.name;
        EXPECT_EQ(statistics->tests, expected->tests) << crew.name;
        EXPECT_EQ(shared.explanation(), alone.explanation()) << crew.name;
      };
      update({});
      for (const Step<D>& step : frames_of(first, first.size() / 6)) {
        apply(step, boxes);
        update(step.changed);
      }
    }
  });
}

TEST_P(ThreadLaw, LaysOutTheSameCells) {
  in_dimension([&]<int D>() {
    const std::vector<Box<D>> boxes = scattered_boxes<D>(2000, D == 2 ? 40 : 12);
    const Outline<D> expected = outline<D, float>(algorithm(), spec(), boxes);
    for (const Crew& crew : crews()) {
      const Outline<D> laid_out = outline<D, float>(algorithm(), spec(), boxes, crew.workers);
      EXPECT_EQ(laid_out.caption, expected.caption) << crew.name;
      EXPECT_EQ(laid_out.levels, expected.levels) << crew.name;
    }
  });
}

TEST_P(ThreadLaw, TakesThreadsFromTheSpecAndLeavesAFewBoxesToTheCaller) {
  in_dimension([&]<int D>() {
    Spec threaded = spec();
    threaded.values.emplace_back("threads", "2");
    EXPECT_EQ(Finder<D>(algorithm(), threaded).workers().threads, 2u);
    EXPECT_EQ((Finder<D, double>(algorithm(), threaded).workers().threads), 2u);
    EXPECT_EQ(Tracker<D>(algorithm(), threaded).workers().threads, 2u);
    const std::string spec = threaded.text();
    World<D> world(spec);
    EXPECT_EQ(world.workers().threads, 2u);
    ReverseExecutor executor;
    static_cast<void>(find_pairs(scattered_boxes<D>(60, 10), {.algorithm = spec, .executor = &executor}));
    EXPECT_EQ(executor.runs, 0u);
    static_cast<void>(
        find_pairs(scattered_boxes<D>(10'000, 300), {.algorithm = spec, .executor = &executor}));
    EXPECT_GT(executor.runs, 0u);
  });
}

INSTANTIATE_TEST_SUITE_P(Own, ThreadLaw, testing::ValuesIn(threaded_cases()), case_name);

TEST(ThreadLawCases, AreSome) { EXPECT_FALSE(threaded_cases().empty()); }

}  // namespace
}  // namespace broadside::laws
