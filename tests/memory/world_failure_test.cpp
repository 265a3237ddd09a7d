// Worlds that run out of memory: a call that throws std::bad_alloc has changed nothing, and an update that
// has failed can be tried again.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <new>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/world.hpp"

#include "failing_allocation.hpp"
#include "injection.hpp"
#include "memory_case.hpp"
#include "tests/support/world_history.hpp"

namespace broadside::laws {
namespace {

TEST(WorldFailureExample, KeepsItsFiltersWhereSettingOneFails) {
  bool has_failed = true;
  for (std::uint64_t number = 0; has_failed; ++number) {
    World2 world;
    const Handle handle = world.add({{0, 0}, {1, 1}});
    world.add({{0, 0}, {1, 1}});
    static_cast<void>(world.update());
    world.shrink_to_fit();
    const std::vector<std::byte> before = world.snapshot();
    has_failed = false;
    try {
      const FailingAllocation failing(number, FailureKind::once);
      world.set_filter(handle, {.category = 2});
    } catch (const std::bad_alloc&) {
      has_failed = true;
    }
    EXPECT_EQ(world.snapshot() == before, has_failed) << "allocation " << number;
  }
}

TEST(WorldFailureExample, TellsWhatAFailedUpdateOwesOfMovedBoxesAndIgnoredPairs) {
  for (std::uint64_t k = 0, failures = 1; failures > 0; ++k) {
    World2 world;
    const Box2 near{{0, 0}, {1, 1}};
    const Handle a = world.add(near);
    const Handle b = world.add(near);
    world.add({{5, 5}, {6, 6}});
    world.update();
    const Handle c = world.add(near);
    world.move(a, {{5, 5}, {6, 6}});
    world.ignore(b, c);
    Injector injector(k, FailureKind::once);
    Events events;
    while (!injector.attempt([&] { events = world.update(); })) {
    }
    EXPECT_EQ(events.begun.size(), 1U) << "allocation " << k;
    EXPECT_EQ(events.ended.size(), 1U) << "allocation " << k;
    failures = injector.failures();
  }
}

TEST(WorldFailureExample, WritesASnapshotThatCanBeRestoredAfterAFailedUpdate) {
  for (const WorldOptions& options : {WorldOptions{}, WorldOptions{.shadow = true}}) {
    for (std::uint64_t k = 0, failures = 1; failures > 0; ++k) {
      World2 world(options);
      const Box2 near{{0, 0}, {1, 1}};
      const Handle a = world.add(near);
      world.add(near);
      world.update();
      world.move(a, {{5, 5}, {6, 6}});
      world.add(near);
      Injector injector(k, FailureKind::once);
      if (injector.attempt([&] { world.update(); })) world.move(a, near);
      failures = injector.failures();
      World2 restored(options);
      restored.restore(world.snapshot());
      const Events expected = world.update();
      const Events events = restored.update();
      EXPECT_TRUE(std::ranges::equal(events.begun, expected.begun)) << "allocation " << k;
      EXPECT_TRUE(std::ranges::equal(events.ended, expected.ended)) << "allocation " << k;
    }
  }
}

class WorldFailure : public MemoryTest {
 protected:
  /// Ends with an update that comes to its end.
  template <int D, typename Real>
  static void play(WorldHistory<D, Real> history, Rng& rng, std::size_t steps) {
    for (std::size_t i = 0; i < steps; ++i) {
      const std::size_t what = rng.below(15);
      if (what < 10)
        history.change();
      else if (what < 13)
        history.update();
      else if (what == 13)
        history.look();
      else
        history.go_back();
      history.check();
    }
    while (!history.update()) {
    }
    history.look();
  }

  /// Plays histories with each allocation failing, and many with some failing at random.
  template <int D, typename Real>
  void check(const WorldOptions& options) {
    std::uint64_t failures = 0;
    const std::int64_t blocks = blocks_held();
    const auto run = [&](std::size_t steps, std::size_t max_boxes, std::uint64_t seed, Injector injector) {
      Rng rng(seed);
      WorldCourse<D, Real> course;
      course.options = options;
      course.box = [max_boxes](Choices& choices) { return lattice_box<D, Real>(max_boxes, choices); };
      course.has_predicate = seed % 3 == 1;
      course.max_some = max_boxes;
      course.attempt = [&](const std::function<void()>& call) { return injector.attempt(call); };
      play(WorldHistory<D, Real>(rng, course), rng, steps);
      failures += injector.failures();
      return injector.failures() > 0;
    };
    for (const FailureKind kind : {FailureKind::once, FailureKind::from_then_on}) {
      for (std::uint64_t k = 0; run(30, 8, 1, {k, kind}); k = next_number(k)) {
      }
    }
    for (std::uint64_t seed = 0; seed < 2 * random_histories(); ++seed)
      run(60, seed % 5 == 0 ? 200 : 12, seed, Injector(seed));
    ASSERT_EQ(blocks_held(), blocks) << "leaks";
    RecordProperty("failures", std::to_string(failures));
  }
};

TEST_P(WorldFailure, CanTryAgain) {
  in_case([&]<int D, typename Real>() { check<D, Real>({.algorithm = algorithm().name}); });
}

TEST_P(WorldFailure, CanTryAgainWithAMargin) {
  in_case([&]<int D, typename Real>() { check<D, Real>({.algorithm = algorithm().name, .margin = 0.75}); });
}

TEST_P(WorldFailure, IsNotAccusedByItsShadow) {
  in_case([&]<int D, typename Real>() { check<D, Real>({.algorithm = algorithm().name, .shadow = true}); });
}

INSTANTIATE_TEST_SUITE_P(Library, WorldFailure, testing::ValuesIn(memory_cases()), case_name);

}  // namespace
}  // namespace broadside::laws
