// Workers::checkpoint: it is passed on the way through a search, and can end it.
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

#include "tests/support/executors.hpp"

namespace broadside {
namespace {

/// Each on its own, so that a search finds nothing.
std::vector<Box2> apart(std::size_t count) {
  std::vector<Box2> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<float>(2 * (i % 150));
    const auto y = static_cast<float>(2 * (i / 150));
    boxes.push_back({{x, y}, {x + 1, y + 1}});
  }
  return boxes;
}

class SearchCheckpoint : public testing::TestWithParam<std::size_t> {
 protected:
  Finder<2> finder(std::string_view spec, std::function<void()> checkpoint) const {
    Finder<2> made(spec);
    made.set_workers({.threads = GetParam(),
                      .executor = GetParam() == 1 ? nullptr : &executor_,
                      .boxes_per_thread = 1,
                      .checkpoint = std::move(checkpoint)});
    return made;
  }

 private:
  /// All tasks are this thread's, so that it is known how many pieces it takes.
  mutable laws::ReverseExecutor executor_;
};

TEST_P(SearchCheckpoint, IsPassedInTheCallersThreadAndChangesNoPair) {
  std::vector<Box2> boxes = apart(20'000);
  for (std::size_t i = 0; i < 500; ++i) boxes.push_back(boxes[7 * i]);
  for (const std::string_view spec : {"brute_force", "grid", "sweep_and_prune", "quadtree", "bvh"}) {
    int passed = 0;
    const auto here = std::this_thread::get_id();
    std::vector<Pair> pairs;
    PairCollector collector(pairs);
    finder(spec, [&] {
      EXPECT_EQ(std::this_thread::get_id(), here);
      ++passed;
    }).find(boxes, collector);
    EXPECT_GT(passed, 3) << spec;
    EXPECT_EQ(pairs, find_pairs(boxes, {.algorithm = spec})) << spec;
  }
}

TEST_P(SearchCheckpoint, EndsASearchThatFindsNothing) {
  const std::vector<Box2> boxes = apart(20'000);
  int passed = 0;
  Finder<2> brute = finder("brute_force", [&] {
    if (++passed == 3) throw std::runtime_error("enough");
  });
  PairCounter counter;
  EXPECT_THROW(brute.find(boxes, counter), std::runtime_error);
  EXPECT_EQ(passed, 3);
  brute.find(boxes, counter);
  EXPECT_EQ(counter.count(), 0u);
}

/// Runs one task in a thread of its own, and the caller's task once that thread has had time to take all
/// there is to do.
class LateCallersExecutor final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 2; }

  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    std::thread other([&] { task(0); });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    for (std::size_t i = 1; i < count; ++i) task(i);
    other.join();
  }
};

TEST(CheckpointOfAWaitingThread, EndsWhatAnotherThreadSearches) {
  // Boxes of the left set, all in one place: one cell of many tests and few pairs.
  std::vector<Box2> boxes(60'000, Box2{{0, 0}, {1, 1}});
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].max[0] += static_cast<float>(i % 1000);
  LateCallersExecutor executor;
  for (const std::string_view spec : {"grid", "quadtree", "sweep_and_prune:axes=2"}) {
    Finder<2> finder(spec);
    finder.set_workers({.threads = 2, .executor = &executor, .boxes_per_thread = 1, .checkpoint = [] {
                          throw std::runtime_error("enough");
                        }});
    PairCounter counter;
    EXPECT_THROW(finder.find_across(boxes, boxes.size() - 1, counter), std::runtime_error) << spec;
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, SearchCheckpoint, testing::Values(1, 2));

}  // namespace
}  // namespace broadside
