// What calls back, and what follows a call, is in the caller's floating-point environment.
#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/debug/outline.hpp"
#include "broadside/debug/shadow.hpp"
#include "broadside/error.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"
#include "broadside/world.hpp"

#include "environment.hpp"
#include "tests/laws/law_sinks.hpp"

namespace broadside::laws {
namespace {

/// Boxes of which each overlaps its neighbours.
std::vector<Box2> stair(std::size_t count) {
  std::vector<Box2> boxes(count);
  for (std::size_t i = 0; i < count; ++i) {
    boxes[i].min.fill(static_cast<float>(i));
    boxes[i].max.fill(static_cast<float>(i + 1));
  }
  return boxes;
}

/// Counts calls back that see another environment than that in which it was made.
class Witness {
 public:
  void look() {
    ++calls_;
    if (control_bits() != expected_) ++others_;
  }

  /// Whether there were calls, and all as expected, and the environment is that one still.
  testing::AssertionResult is_content() const {
    if (control_bits() != expected_) return testing::AssertionFailure() << "the environment is another one";
    if (calls_ > 0 && others_ == 0) return testing::AssertionSuccess();
    return testing::AssertionFailure() << others_ << " of " << calls_ << " calls in another environment";
  }

 private:
  std::uint64_t expected_ = control_bits();
  std::atomic<std::size_t> calls_ = 0;
  std::atomic<std::size_t> others_ = 0;
};

class WitnessSink : public PairSink {
 public:
  explicit WitnessSink(Witness& witness) : witness_(witness) {}

 protected:
  void consume(std::span<const Pair>) override { witness_.look(); }

  Witness& witness_;
};

/// Keeps no pairs, so that each thread can have its own.
class ClonedSink final : public WitnessSink {
 public:
  using WitnessSink::WitnessSink;

  std::unique_ptr<PairSink> empty_clone() const override {
    witness_.look();
    return std::make_unique<ClonedSink>(witness_);
  }
  void merge(PairSink&) override { witness_.look(); }
};

/// Runs tasks in the calling thread, which has another environment meanwhile.
class WitnessExecutor final : public Executor {
 public:
  explicit WitnessExecutor(Witness& witness) : witness_(witness) {}

  std::size_t threads() const noexcept override {
    witness_.look();
    return 3;
  }

  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    witness_.look();
    for (std::size_t i = 0; i < count; ++i) {
      task(i);
      witness_.look();
    }
  }

 private:
  Witness& witness_;
};

class CallBack : public testing::TestWithParam<Environment> {};

TEST_P(CallBack, OfASinkIsInTheCallersEnvironment) {
  std::vector<Box2> boxes = stair(3000);
  const InEnvironment in(GetParam());
  for (const bool with_absent : {false, true}) {
    if (with_absent) boxes[7] = absent_box<2>();
    Witness witness;
    WitnessSink sink(witness);
    find_pairs(boxes, sink);
    find_pairs(boxes, boxes, sink);
    Finder<2> finder("grid");
    finder.find_across(boxes, 1500, sink);
    Tracker<2> tracker("grid");
    tracker.update({.boxes = boxes, .changed = {}}, sink, sink);
    ShadowTracker<2> shadow("grid");
    shadow.update({.boxes = boxes, .changed = {}}, sink, sink);
    EXPECT_TRUE(witness.is_content());
  }
}

TEST_P(CallBack, KeepsWhatASinkHoldsWhereInputIsRefused) {
  std::vector<Box2> boxes = stair(2);
  boxes[1].min[0] = 100;
  const InEnvironment in(GetParam());
  PairCounter sink;
  sink.add(BoxId{0}, BoxId{1});
  EXPECT_THROW(Finder<2>("grid").find(boxes, sink), InvalidInput);
  sink.flush();
  EXPECT_EQ(sink.count(), 1U);
}

TEST_P(CallBack, OfASinkByThreadsIsInTheCallersEnvironment) {
  const std::vector<Box2> boxes = stair(3000);
  const InEnvironment in(GetParam());
  Witness witness;
  WitnessExecutor executor(witness);
  Finder<2> finder("grid");
  for (Executor* const workers : {static_cast<Executor*>(nullptr), static_cast<Executor*>(&executor)}) {
    for (const std::size_t threads : {0, 3}) {
      finder.set_workers({.threads = threads, .executor = workers, .boxes_per_thread = 1});
      WitnessSink sink(witness);
      finder.find(boxes, sink);
    }
  }
  ClonedSink cloned(witness);
  finder.find(boxes, cloned);
  EXPECT_TRUE(witness.is_content());
}

TEST_P(CallBack, OfAPredicateIsInTheCallersEnvironment) {
  const std::vector<Box2> boxes = stair(100);
  const InEnvironment in(GetParam());
  Witness witness;
  World2 world;
  world.set_predicate([&](Handle, Handle) {
    witness.look();
    static_cast<void>(find_pairs(boxes));
    witness.look();
    return true;
  });
  for (const Box2& box : boxes) world.add(box);
  world.update();
  EXPECT_TRUE(witness.is_content());
}

TEST_P(CallBack, OfAVisitorIsInTheCallersEnvironment) {
  const std::vector<Box2> boxes = stair(100);
  const InEnvironment in(GetParam());
  Witness witness;
  World2 world;
  for (const Box2& box : boxes) world.add(box);
  world.overlapping(boxes[3], [&](Handle) { witness.look(); });
  world.hits(Ray<2>{.origin = {-1, -1}, .direction = {1, 1}}, [&](Handle, float) { witness.look(); });
  EXPECT_TRUE(witness.is_content());
}

TEST_P(CallBack, LeavesTheCallersEnvironmentWhereItThrows) {
  std::vector<Box2> boxes = stair(3000);
  const InEnvironment in(GetParam());
  Witness witness;
  LimitedCollector full(0);
  EXPECT_THROW(find_pairs(boxes, full), SinkIsFull);
  witness.look();
  Tracker<2> tracker("quadtree");
  EXPECT_THROW(tracker.update({.boxes = boxes, .changed = {}}, full, full), SinkIsFull);
  witness.look();
  boxes[9].min[0] = 100;
  EXPECT_THROW(static_cast<void>(find_pairs(boxes)), InvalidInput);
  EXPECT_TRUE(witness.is_content());
}

std::string name_of(const testing::TestParamInfo<Environment>& tested) {
  std::string name = tested.param.name;
  std::erase(name, ',');
  std::ranges::replace(name, ' ', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, CallBack, testing::ValuesIn(environments().begin(), environments().end()),
                         name_of);

}  // namespace
}  // namespace broadside::laws
