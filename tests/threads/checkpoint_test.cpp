// Workers::checkpoint: it is passed on the way through a search, and can end it.
#include <functional>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

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

class Checkpoint : public testing::TestWithParam<std::size_t> {
 protected:
  std::unique_ptr<PairFinder<2>> finder(std::string_view spec, std::function<void()> checkpoint) const {
    auto made = make_finder<2>(spec);
    made->set_workers({.threads = GetParam(),
                       .executor = GetParam() == 1 ? nullptr : &executor_,
                       .boxes_per_thread = 1,
                       .checkpoint = std::move(checkpoint)});
    return made;
  }

 private:
  /// All tasks are this thread's, so that it is known how many pieces it takes.
  mutable laws::ReverseExecutor executor_;
};

TEST_P(Checkpoint, IsPassedInTheCallersThreadAndChangesNoPair) {
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
    })->find(std::span<const Box2>(boxes), collector);
    EXPECT_GT(passed, 3) << spec;
    EXPECT_EQ(pairs, find_pairs(boxes, spec)) << spec;
  }
}

TEST_P(Checkpoint, EndsASearchThatFindsNothing) {
  const std::vector<Box2> boxes = apart(20'000);
  int passed = 0;
  const auto brute = finder("brute_force", [&] {
    if (++passed == 3) throw std::runtime_error("enough");
  });
  PairCounter counter;
  EXPECT_THROW(brute->find(std::span<const Box2>(boxes), counter), std::runtime_error);
  EXPECT_EQ(passed, 3);
  brute->find(std::span<const Box2>(boxes), counter);
  EXPECT_EQ(counter.count(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Threads, Checkpoint, testing::Values(1, 2));

}  // namespace
}  // namespace broadside
