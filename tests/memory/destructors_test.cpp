// Destructors that run where there is no memory: they must not ask for any.
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "broadside/finder.hpp"
#include "broadside/recorder.hpp"
#include "broadside/sinks.hpp"

#include "failing_allocation.hpp"

namespace broadside::laws {
namespace {

/// Runs the first task last, in the calling thread, so that what others have found waits until then.
class LastExecutor final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 2; }
  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    for (std::size_t i = count; i > 1; --i) std::jthread([&task, i] { task(i - 1); });
    task(0);
  }
};

struct SinkFailed {};

TEST(Search, PutsAwayPairsThatWaitWithoutMemory) {
  const std::vector<Box2> boxes(2000, Box2{{0, 0}, {1, 1}});
  LastExecutor executor;
  Finder<2> finder("brute_force");
  finder.set_workers({.threads = 2, .executor = &executor, .boxes_per_thread = 1});
  std::optional<FailingAllocation> no_memory;
  PairFunction full([&no_memory](std::span<const Pair>) {
    no_memory.emplace(0, FailureKind::from_then_on);
    throw SinkFailed();
  });
  bool threw = false;
  try {
    finder.find(boxes, full);
  } catch (const SinkFailed&) {
    threw = true;
  }
  no_memory.reset();
  EXPECT_TRUE(threw);
  std::size_t count = 0;
  PairFunction counted([&count](std::span<const Pair> chunk) { count += chunk.size(); });
  finder.find(boxes, counted);
  EXPECT_EQ(count, boxes.size() * (boxes.size() - 1) / 2);
}

TEST(Recorder, IsDestroyedWithoutMemoryWhereItsFileCannotBeClosed) {
  std::optional<broadside::Recorder2> recorder(std::in_place);
  const int next = dup(0);
  ASSERT_EQ(close(next), 0);
  ASSERT_TRUE(recorder->open("/dev/null"));
  ASSERT_EQ(close(next), 0);  // the recorder's own
  const FailingAllocation no_memory(0, FailureKind::from_then_on);
  recorder.reset();
}

}  // namespace
}  // namespace broadside::laws
