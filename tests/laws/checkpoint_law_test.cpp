// The law of checkpoints: a search asks whether to go on after every few million tests, wherever these are
// made: also in one cell, one node or one frame's followed boxes, in each algorithm.
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/executor.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "law_case.hpp"

namespace broadside::laws {
namespace {

/// Boxes that share a point, each begun and ended elsewhere: all tests are made in one place, and find pairs.
template <int D>
std::vector<Box<D>> boxes_in_one_place(std::size_t count, float shift = 0) {
  std::vector<Box<D>> boxes(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < D; ++axis) {
      boxes[i].min[axis] = shift + static_cast<float>((i * 7919 + 31 * axis) % count);
      boxes[i].max[axis] = boxes[i].min[axis] + 2 * static_cast<float>(count);
    }
  }
  return boxes;
}

/// Several times what may be tested between two checkpoints.
constexpr std::size_t boxes_of_a_search = reduced(9000);
constexpr std::size_t boxes_of_a_frame = reduced(4500);

struct Enough : std::runtime_error {
  Enough() : std::runtime_error("enough") {}
};

/// A checkpoint that counts its calls, and throws in one of them.
struct Calls {
  std::size_t count = 0;
  std::size_t last = 0;  // 0: it never throws

  std::function<void()> checkpoint() {
    return [this] {
      if (++count == last) throw Enough();
    };
  }
};

/// The calls that so many tests must have led to.
std::size_t min_calls(std::uint64_t tests, std::size_t boxes) {
  // Some boxes are compared with all others between two calls.
  return tests / (Checkpoint::max_tests + 64 * boxes);
}

class CheckpointLaw : public Law {
 protected:
  template <typename Searching>
  static void ask(Searching& searching, Calls& calls) {
    Workers workers = searching.workers();
    workers.threads = 1;
    workers.checkpoint = calls.checkpoint();
    searching.set_workers(workers);
  }

  /// The spec by which boxes are followed, where the algorithm has one.
  Spec following() const {
    for (const Tunable& tunable : algorithm().tunables) {
      if (tunable.name != "update") continue;
      for (const std::string& choice : tunable.choices) {
        if (choice == "follow" || choice == "binary" || choice == "reinsert" || choice == "relative")
          return {algorithm().name, {{"update", choice}}};
      }
    }
    return spec();
  }
};

TEST_P(CheckpointLaw, IsPassedAsOftenAsTheTestsOfOneCellAskFor) {
  in_dimension([&]<int D>() {
    const std::vector<Box<D>> boxes = boxes_in_one_place<D>(boxes_of_a_search);
    const std::uint64_t tests = std::uint64_t{boxes.size()} * (boxes.size() - 1) / 2;
    Finder<D> finder(algorithm(), spec());
    Calls calls;
    ask(finder, calls);
    PairCounter counter;
    finder.find(boxes, counter);
    EXPECT_EQ(counter.count(), tests);
    EXPECT_GE(calls.count, min_calls(tests, boxes.size()));
  });
}

TEST_P(CheckpointLaw, EndsASearchInOneCellBeforeManyMoreTests) {
  in_dimension([&]<int D>() {
    const std::vector<Box<D>> boxes = boxes_in_one_place<D>(boxes_of_a_search);
    const std::uint64_t tests = std::uint64_t{boxes.size()} * (boxes.size() - 1) / 2;
    if (min_calls(tests, boxes.size()) < 2) GTEST_SKIP() << "too few boxes under a sanitizer";
    Finder<D> finder(algorithm(), spec());
    Calls calls{.count = 0, .last = 2};
    ask(finder, calls);
    PairCounter counter;
    EXPECT_THROW(finder.find(boxes, counter), Enough);
    EXPECT_LE(counter.count(), 2 * (Checkpoint::max_tests + 64 * boxes.size()));
    calls.last = 0;
    PairCounter whole;
    finder.find(boxes, whole);
    EXPECT_EQ(whole.count(), tests);
  });
}

TEST_P(CheckpointLaw, IsPassedAsOftenAsTheTestsOfOneFrameAskFor) {
  in_dimension([&]<int D>() {
    const std::size_t count = boxes_of_a_frame;
    Tracker<D> tracker(algorithm(), following());
    Calls calls;
    ask(tracker, calls);
    std::vector<BoxId> all;
    for (std::size_t i = 0; i < count; ++i) all.push_back(BoxId(i));
    PairCounter events;
    tracker.update({.boxes = boxes_in_one_place<D>(count)}, events, events);
    calls.count = 0;
    const auto statistics =
        tracker.update({.boxes = boxes_in_one_place<D>(count, 0.25F), .changed = all}, events, events);
    const std::uint64_t pairs = std::uint64_t{count} * (count - 1) / 2;
    EXPECT_EQ(events.count(), pairs);
    // Some keep ends in order, and test nothing where the order stays; these count nothing either.
    const std::uint64_t tests = statistics ? statistics->tests : 0;
    if (is_own(GetParam())) {
      EXPECT_GE(tests, pairs);
    }
    EXPECT_GE(calls.count, min_calls(tests, count));
    calls = {.count = 0, .last = 1};
    if (min_calls(tests, count) > 0) {
      EXPECT_THROW(
          tracker.update({.boxes = boxes_in_one_place<D>(count, 0.5F), .changed = all}, events, events),
          Enough);
    }
    calls.last = 0;
    PairCounter none;
    tracker.update({.boxes = boxes_in_one_place<D>(count, 0.75F), .changed = all}, none, none);
    EXPECT_EQ(none.count(), 0u);
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, CheckpointLaw, testing::ValuesIn(law_cases_without_peers()), case_name);

}  // namespace
}  // namespace broadside::laws
