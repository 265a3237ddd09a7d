// Snapshots where memory runs out: a call that throws has changed nothing, and the next updates tell what
// they would have told.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/world.hpp"

#include "failing_allocation.hpp"

namespace broadside::laws {
namespace {

using SnapshotBytes = std::vector<std::byte>;

Box2 at(int x) {
  const auto begin = static_cast<float>(x);
  return {{begin, 0}, {begin + 1.5F, 1}};
}

struct Kind {
  std::string name;
  std::string algorithm = "brute_force";
  double margin = 0;
  bool keep_pairs = true;
  bool has_predicate = false;
  bool has_own_tracker = true;
};

std::vector<Kind> kinds() {
  return {{.name = "plain"},
          {.name = "margin", .margin = 0.5},
          {.name = "predicate", .has_predicate = true},
          {.name = "no pairs kept", .keep_pairs = false},
          {.name = "a tracker of the caller's", .has_own_tracker = false},
          {.name = "grid", .algorithm = "grid"},
          {.name = "bvh", .algorithm = "bvh"}};
}

World2 world_of(const Kind& kind) {
  WorldOptions options;
  options.algorithm = kind.algorithm;
  options.margin = kind.margin;
  options.keep_pairs = kind.keep_pairs;
  World2 world = kind.has_own_tracker ? World2(options) : World2(Tracker<2>(kind.algorithm), options);
  if (kind.has_predicate) world.set_predicate([](Handle a, Handle b) { return (a.slot + b.slot) % 3 != 0; });
  return world;
}

/// Two moments of one world, far apart, each between changes and the update that tells of them.
std::pair<SnapshotBytes, SnapshotBytes> two_moments(const Kind& kind) {
  World2 world = world_of(kind);
  std::vector<Handle> handles;
  for (int i = 0; i < 12; ++i) handles.push_back(world.add(at(i)));
  world.ignore(handles[1], handles[2]);
  world.update();
  world.move(handles[3], at(30));
  world.remove(handles[5]);
  std::pair<SnapshotBytes, SnapshotBytes> moments;
  moments.first = world.snapshot();
  for (std::size_t i = 6; i < 12; ++i) world.move(handles[i], at(static_cast<int>(i) % 3));
  world.set_filter(handles[0], {.group = -1});
  world.unignore(handles[1], handles[2]);
  world.update();
  for (int i = 0; i < 5; ++i) world.add(at(100 + i));
  world.update();
  world.move(handles[7], at(5));
  moments.second = world.snapshot();
  return moments;
}

/// What the next two updates tell.
std::vector<std::vector<HandlePair>> future(World2& world) {
  std::vector<std::vector<HandlePair>> told;
  const auto update = [&] {
    const Events events = world.update();
    told.emplace_back(events.begun.begin(), events.begun.end());
    told.emplace_back(events.ended.begin(), events.ended.end());
  };
  update();
  world.add(at(2));
  update();
  return told;
}

/// Whether a query about each box's place finds it, and one about all places as many as there are.
bool finds_all(const World2& world) {
  std::size_t found = 0;
  std::size_t found_again = 0;
  world.overlapping({{-1e6F, -1e6F}, {1e6F, 1e6F}}, [&](Handle handle) {
    ++found;
    world.containing(world.box(handle).max, [&](Handle other) { found_again += handle == other ? 1 : 0; });
  });
  return found == world.size() && found_again == found;
}

/// Calls `call` with every allocation failing, once and from then on, until one needs no more of them. `make`
/// makes the object for the call anew; `check` looks at it, and at whether the call threw, when there is
/// memory again. Returns how many calls threw.
template <typename Make, typename Call, typename Check>
int fail_everywhere(Make make, Call call, Check check) {
  int thrown = 0;
  for (const FailureKind kind : {FailureKind::once, FailureKind::from_then_on}) {
    for (std::uint64_t number = 0;; ++number) {
      const std::int64_t before = blocks_held();
      bool has_failed = false;
      {
        auto object = make();
        bool has_thrown = false;
        {
          const FailingAllocation failing(number, kind);
          try {
            call(object);
          } catch (const std::bad_alloc&) {
            has_thrown = true;
          }
          has_failed = FailingAllocation::failures() > 0;
        }
        thrown += has_thrown ? 1 : 0;
        check(object, has_thrown);
      }
      EXPECT_EQ(blocks_held(), before) << "allocation " << number << " leaks";
      if (!has_failed || testing::Test::HasFailure()) break;
    }
  }
  return thrown;
}

TEST(RestoreOutOfMemory, LeavesTheWorldAsItWas) {
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(kind.name);
    const auto [was, to] = two_moments(kind);
    const auto world_at = [&](const SnapshotBytes& bytes) {
      World2 world = world_of(kind);
      world.restore(bytes);
      EXPECT_TRUE(finds_all(world));  // from now on it has an index, which a restore takes over
      return world;
    };
    World2 was_world = world_at(was);
    World2 to_world = world_at(to);
    const auto after_was = future(was_world);
    const auto after_to = future(to_world);
    const int thrown = fail_everywhere([&, &was = was] { return world_at(was); },
                                       [&to = to](World2& world) { world.restore(to); },
                                       [&, &was = was, &to = to](World2& world, bool has_thrown) {
                                         EXPECT_EQ(world.snapshot(), has_thrown ? was : to);
                                         EXPECT_TRUE(finds_all(world));
                                         EXPECT_EQ(future(world), has_thrown ? after_was : after_to);
                                       });
    EXPECT_GT(thrown, 20);
  }
}

TEST(RestoreOutOfMemory, CanBeTriedAgainAtOnce) {
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(kind.name);
    const auto [was, to] = two_moments(kind);
    World2 expected = world_of(kind);
    expected.restore(to);
    const auto after = future(expected);
    fail_everywhere(
        [&, &was = was] {
          World2 world = world_of(kind);
          world.restore(was);
          return world;
        },
        [&to = to](World2& world) { world.restore(to); },
        [&, &to = to](World2& world, bool) {
          world.restore(to);
          EXPECT_EQ(world.snapshot(), to);
          EXPECT_EQ(future(world), after);
        });
  }
}

TEST(SnapshotOutOfMemory, ThrowsAndChangesNothing) {
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(kind.name);
    const SnapshotBytes bytes = two_moments(kind).second;
    World2 expected = world_of(kind);
    expected.restore(bytes);
    const auto after = future(expected);
    fail_everywhere(
        [&] {
          World2 world = world_of(kind);
          world.restore(bytes);
          return world;
        },
        [](const World2& world) { static_cast<void>(world.snapshot()); },
        [&](World2& world, bool) {
          EXPECT_EQ(world.snapshot(), bytes);
          EXPECT_EQ(future(world), after);
        });
  }
}

}  // namespace
}  // namespace broadside::laws
