// What World's header says about costs: that queries and updates pay for what changed, by counts at two
// sizes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/world.hpp"

#include "algorithms/bvh/bvh_index.hpp"
#include "tests/support/rng.hpp"

namespace broadside {
namespace {

/// Boxes of side 1, about one in each square of side 2, and what is done to them.
class Crowd {
 public:
  Crowd(World2 its_world, std::size_t boxes)
      : world(std::move(its_world)), side(2 * std::sqrt(static_cast<float>(boxes))) {
    for (std::size_t i = 0; i < boxes; ++i) add();
    world.update();
  }

  Box2 anywhere() {
    const float x = rng.between(0, side);
    const float y = rng.between(0, side);
    return {{x, y}, {x + 1, y + 1}};
  }

  Handle any() { return handles[rng.below(handles.size())]; }

  Box2 near(Handle handle) {
    Box2 box = world.box(handle);
    const float step = rng.between(-0.01F, 0.01F);
    box.min[0] += step;
    box.max[0] += step;
    return box;
  }

  void add() { handles.push_back(world.add(anywhere())); }
  void move_near() {
    const Handle handle = any();
    world.move(handle, near(handle));
  }
  void move_far() { world.move(any(), anywhere()); }
  void remove() {
    std::swap(handles[rng.below(handles.size())], handles.back());
    world.remove(handles.back());
    handles.pop_back();
  }

  /// One query, of each kind in turn.
  void query() {
    const auto go_on = [](auto&&...) { return true; };
    const Box2 box = anywhere();
    const Ray<2> ray{box.min, {1, 0}, 4};
    switch (queries_++ % 5) {
      case 0:
        return void(world.overlapping(box, go_on));
      case 1:
        return void(world.containing(box.min, go_on));
      case 2:
        return void(world.hits(ray, go_on));
      case 3:
        return void(world.first_hit(ray));
      default:
        std::vector<HandleNeighbour> found;
        world.nearest(box.min, 3, found);
    }
  }

  World2 world;
  std::vector<Handle> handles;
  Rng rng{7};
  float side;

 private:
  std::size_t queries_ = 0;
};

/// Counts the boxes that a world's own index takes, when it is built and when it is brought up to date.
class IndexMeter {
 public:
  /// Before a query: whether the next index counts from 0.
  void start(const World2& world) {
    if (world.statistics().bytes.queries == 0) last_ = 0;
  }

  /// After it.
  void read(const World2& world) {
    const auto& index = algorithm::BvhIndex<2, float>::of(world.box_index());
    const std::uint64_t now = index.tree().boxes_taken();
    taken_ += now - std::exchange(last_, now);
  }

  std::uint64_t taken() const { return taken_; }

 private:
  std::uint64_t last_ = 0;
  std::uint64_t taken_ = 0;
};

struct Turn {
  std::string name;
  std::size_t changes;  ///< boxes that change in a turn
  std::function<void(Crowd&)> before_query;
  std::function<void(Crowd&)> after_query{};
  WorldOptions options{};
};

std::vector<Turn> turns() {
  const auto update = [](Crowd& crowd) { crowd.world.update(); };
  WorldOptions exact;
  exact.margin = 0.5;
  WorldOptions enlarged = exact;
  enlarged.events = WorldEvents::enlarged;
  WorldOptions bvh;
  bvh.algorithm = "bvh:update=follow";
  const auto move_many = [](Crowd& crowd) {
    std::vector<Handle> moved;
    std::vector<Box2> boxes;
    for (int i = 0; i < 4; ++i) {
      moved.push_back(crowd.any());
      boxes.push_back(i % 2 == 0 ? crowd.anywhere() : crowd.near(moved.back()));
    }
    crowd.world.move(moved, boxes);
  };
  const auto filter = [](Crowd& crowd) {
    crowd.world.set_filter(crowd.any(), {.category = 1U << crowd.rng.below(9)});
  };
  const auto all = [filter](Crowd& crowd) {
    crowd.add();
    crowd.move_near();
    crowd.move_far();
    crowd.remove();
    filter(crowd);
  };
  const auto move_and_update = [update](Crowd& crowd) {
    crowd.move_far();
    update(crowd);
  };
  return {{"Added", 1, &Crowd::add},
          {"MovedNear", 1, &Crowd::move_near},
          {"MovedFar", 1, &Crowd::move_far},
          {"Removed", 1, &Crowd::remove},
          {"Filtered", 1, filter},
          {"MovedAtOnce", 4, move_many},
          {"ChangedInAllWays", 5, all},
          {"ChangedAndUpdated", 5, all, update},
          {"MovedWithinEnlargedOnes", 1, &Crowd::move_near, {}, enlarged},
          {"MovedOutOfEnlargedOnes", 1, &Crowd::move_far, {}, enlarged},
          {"MovedInExactOnes", 1, &Crowd::move_near, {}, exact},
          {"OfATrackersIndex", 5, all, {}, bvh},
          {"OfATrackersIndexAndUpdated", 2, &Crowd::move_far, move_and_update, bvh}};
}

class QueryCost : public testing::TestWithParam<Turn> {};

INSTANTIATE_TEST_SUITE_P(Turns, QueryCost, testing::ValuesIn(turns()),
                         [](const auto& turn) { return turn.param.name; });

TEST_P(QueryCost, IsForWhatChangedSinceTheLastQuery) {
  const Turn& turn = GetParam();
  for (const std::size_t size : {500U, 8000U}) {
    // As many turns as boxes, so that a build now and then, after a part of all have changed, is counted.
    Crowd crowd(World2(turn.options), turn.name == "Removed" ? 2 * size : size);
    IndexMeter meter;
    crowd.move_near();
    crowd.query();
    meter.read(crowd.world);
    const std::uint64_t first = meter.taken();
    for (std::size_t i = 0; i < size; ++i) {
      turn.before_query(crowd);
      meter.start(crowd.world);
      crowd.query();
      meter.read(crowd.world);
      if (turn.after_query) turn.after_query(crowd);
    }
    EXPECT_GE(meter.taken() - first, size * turn.changes * 3 / 4) << size << " boxes";
    EXPECT_LE(meter.taken() - first, size * turn.changes * 6) << size << " boxes";
    // Whatever happens, all memory is for the boxes there are, and not for what was done to them.
    EXPECT_LE(crowd.world.statistics().bytes.queries, 400 * crowd.world.slots() + 100'000);
  }
}

TEST(QueryCost, AfterARollbackIsForWhatDiffers) {
  for (const std::size_t size : {500U, 8000U}) {
    Crowd crowd(World2(), size);
    crowd.move_near();
    crowd.query();
    crowd.world.update();
    IndexMeter meter;
    meter.read(crowd.world);
    const std::vector<std::byte> snapshot = crowd.world.snapshot();
    for (int i = 0; i < 10; ++i) {
      crowd.move_far();
      crowd.query();
      crowd.world.update();
      crowd.add();
    }
    crowd.world.set_filter(crowd.any(), {.mask = 5});
    crowd.query();
    meter.read(crowd.world);
    const std::uint64_t before = meter.taken();
    crowd.world.restore(snapshot);
    crowd.query();
    meter.read(crowd.world);
    EXPECT_LE(meter.taken() - before, 40U) << size << " boxes";
  }
}

/// Counts the boxes that it is told to have changed.
class ChangeCounter final : public Follower<2> {
 public:
  std::optional<Statistics> follow(const Change<2>& change, PairSink&, PairSink&) override {
    changed = change.changed.size();
    return std::nullopt;
  }

  std::size_t changed = 0;
};

struct Deed {
  std::string name;
  std::size_t changed;  ///< boxes, however many there are
  std::function<void(Crowd&)> deed;
  WorldOptions options{};
};

std::vector<Deed> deeds() {
  WorldOptions exact;
  exact.margin = 0.5;
  WorldOptions enlarged = exact;
  enlarged.events = WorldEvents::enlarged;
  const auto move_twice = [](Crowd& crowd) {
    const Handle handle = crowd.any();
    crowd.world.move(handle, crowd.anywhere());
    crowd.world.move(handle, crowd.anywhere());
  };
  const auto filter = [](Crowd& crowd) {
    crowd.world.set_filter(crowd.any(), {.category = crowd.rng.bits() | 1});
  };
  const auto ignore = [](Crowd& crowd) { crowd.world.ignore(crowd.handles[1], crowd.handles[2]); };
  const auto all = [](Crowd& crowd) {
    crowd.world.move(crowd.handles[5], crowd.anywhere());
    crowd.world.set_filter(crowd.handles[6], {.category = crowd.rng.bits() | 1});
    crowd.world.remove(crowd.handles.back());
    crowd.handles.pop_back();
    crowd.add();
  };
  return {{"Nothing", 0, [](Crowd&) {}},
          {"Query", 0, &Crowd::query},
          {"Add", 1, &Crowd::add},
          {"Move", 1, &Crowd::move_near},
          {"MoveTwice", 1, move_twice},
          {"Remove", 1, &Crowd::remove},
          {"Filter", 1, filter},
          {"Ignore", 0, ignore},
          {"All", 4, all},
          {"MoveWithinEnlarged", 0, &Crowd::move_near, enlarged},
          {"MoveWithinExact", 0, &Crowd::move_near, exact},
          {"MoveOutOfEnlarged", 1, &Crowd::move_far, enlarged},
          {"MoveOutOfExact", 1, &Crowd::move_far, exact}};
}

class UpdateCost : public testing::TestWithParam<Deed> {};

INSTANTIATE_TEST_SUITE_P(Deeds, UpdateCost, testing::ValuesIn(deeds()),
                         [](const auto& deed) { return deed.param.name; });

TEST_P(UpdateCost, IsForWhatChangedSinceTheLastUpdate) {
  for (const std::size_t size : {100U, 10'000U}) {
    auto follower = std::make_unique<ChangeCounter>();
    const ChangeCounter& counted = *follower;
    Crowd crowd(World2(Tracker<2>(std::move(follower)), GetParam().options), size);
    crowd.world.set_filter(crowd.handles[0], {.category = 2});  // the first one takes all boxes for changed
    crowd.world.update();
    EXPECT_EQ(counted.changed, size);
    for (int i = 0; i < 3; ++i) {
      GetParam().deed(crowd);
      crowd.world.update();
      EXPECT_EQ(counted.changed, GetParam().changed) << size << " boxes";
    }
  }
}

TEST(UpdateCost, OfARollbackIsForWhatDiffers) {
  for (const std::size_t size : {100U, 10'000U}) {
    auto follower = std::make_unique<ChangeCounter>();
    const ChangeCounter& counted = *follower;
    Crowd crowd(World2(Tracker<2>(std::move(follower))), size);
    const std::vector<std::byte> snapshot = crowd.world.snapshot();
    for (const std::size_t place : {3U, 30U, 50U}) crowd.world.move(crowd.handles[place], crowd.anywhere());
    crowd.world.update();
    crowd.world.restore(snapshot);
    EXPECT_EQ(counted.changed, 3U) << size << " boxes";
  }
}

TEST(UpdateCost, OfFollowersIsTestsAroundWhatMoved) {
  for (const char* const spec : {"grid:update=follow", "quadtree:update=follow", "bvh:update=follow"}) {
    std::array<double, 2> tests{};
    for (const bool is_large : {false, true}) {
      Crowd crowd(World2(spec), is_large ? 32'000 : 2000);
      for (int i = 0; i < 100; ++i) {
        crowd.move_near();
        crowd.world.update();
        tests[is_large] += static_cast<double>(crowd.world.statistics().tracker->tests);
      }
    }
    EXPECT_GT(tests[0], 100) << spec;
    EXPECT_LT(tests[1], 3 * tests[0]) << spec;
  }
}

TEST(UpdateCost, AsksAPredicateAboutThePairsOfABoxThatIsRefiltered) {
  for (const int size : {100, 10'000}) {
    World2 world;
    std::vector<Handle> row;
    for (int i = 0; i < size; ++i) {
      const auto at = static_cast<float>(i);
      row.push_back(world.add({{at, 0}, {at + 1, 1}}));
    }
    std::size_t asked = 0;
    world.set_predicate([&asked](Handle, Handle) { return ++asked, true; });
    world.update();
    EXPECT_EQ(std::exchange(asked, 0), row.size() - 1);
    world.update();
    EXPECT_EQ(asked, 0U);
    world.refilter(row[50]);
    world.update();
    EXPECT_EQ(asked, 2U) << size << " boxes";
  }
}

TEST(MemoryCost, OfPairsIsAsMuchAPair) {
  for (const std::uint32_t size : {1000U, 30'000U}) {
    World2 world;
    std::vector<Handle> handles;
    for (std::uint32_t i = 0; i < size; ++i)
      handles.push_back(world.add({{0, 0}, {0, 0}}, {.filter = {.mask = 0}}));
    for (std::uint32_t i = 1; i < size; ++i) world.ignore(handles[i - 1], handles[i]);
    EXPECT_LE(world.statistics().bytes.filters / size, 160U) << size << " ignored pairs and filters";
    IgnoredPairs ignored;
    for (std::uint32_t i = 1; i < size; ++i) ignored.insert({BoxId{i - 1}, BoxId{i}});
    EXPECT_LE(ignored.bytes() / ignored.size(), 33U) << size << " ignored pairs";
  }
}

}  // namespace
}  // namespace broadside
