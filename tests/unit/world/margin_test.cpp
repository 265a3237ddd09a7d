// World with a margin: the tracker sees enlarged boxes, and the pairs are those of the boxes themselves.
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/world.hpp"

#include "tests/support/boxes.hpp"
#include "tests/support/message.hpp"
#include "tests/unit/world/handle_pairs.hpp"

namespace broadside {
namespace {

WorldOptions with_margin(double margin) {
  WorldOptions options;
  options.algorithm = "brute_force";
  options.margin = margin;
  return options;
}

/// Counts what it is told has changed.
class CountingTracker final : public PairTracker<2> {
 public:
  explicit CountingTracker(std::size_t& changes) : changes_(&changes), tracker_(make_finder<2>("bvh")) {}

 private:
  void update_valid(const Change<2>& change, PairSink& begun, PairSink& ended) override {
    *changes_ += change.changed.size();
    this->update_with(tracker_, change, begun, ended);
  }

  std::size_t* changes_;
  DiffTracker<2> tracker_;
};

class WorldMarginTest : public testing::Test {
 protected:
  std::size_t changes_ = 0;
  World2 world_{std::make_unique<CountingTracker>(changes_), with_margin(0.5)};
};

TEST_F(WorldMarginTest, ReportsThePairsOfTheBoxesThemselvesInTheSameUpdate) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(1.25F));
  EXPECT_TRUE(world_.update().begun.empty()) << "only the enlarged boxes overlap";
  EXPECT_EQ(world_.statistics().enlarged_pairs, 1u);
  world_.move(b, at(1));
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, b}}));
  world_.move(b, at(1.125F));
  EXPECT_EQ(listed(world_.update().ended), (HandlePairs{{a, b}}));
  world_.move(b, at(1));
  world_.move(a, at(-0.25F));
  EXPECT_TRUE(world_.update().begun.empty());
  EXPECT_EQ(world_.box(a), at(-0.25F));
}

TEST_F(WorldMarginTest, TellsTheTrackerOnlyOfBoxesThatLeaveTheirEnlargedOnes) {
  const Handle a = world_.add(at(0));
  world_.update();
  EXPECT_EQ(changes_, 1u);
  for (const float x : {0.5F, -0.5F, 0.0F, 0.25F}) {
    world_.move(a, at(x));
    world_.update();
  }
  EXPECT_EQ(changes_, 1u);
  world_.move(a, at(0.625F));
  world_.update();
  EXPECT_EQ(changes_, 2u);
  world_.move(a, at(1.125F));
  world_.update();
  EXPECT_EQ(changes_, 2u) << "the new one is around the new place";
}

TEST_F(WorldMarginTest, ReplacesAnEnlargedBoxThatHasBecomeFarTooLarge) {
  const Handle a = world_.add({{-100, -100}, {100, 100}});
  world_.add(at(50));
  world_.update();
  world_.move(a, at(0));
  EXPECT_EQ(world_.update().ended.size(), 1u);
  EXPECT_EQ(world_.statistics().enlarged_pairs, 0u);
}

TEST_F(WorldMarginTest, TakesInfiniteBoxesAndRemovals) {
  const Handle whole = world_.add({{-infinity, -infinity}, {infinity, infinity}});
  const Handle a = world_.add(at(0));
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{whole, a}}));
  world_.remove(whole);
  EXPECT_EQ(listed(world_.update().ended), (HandlePairs{{whole, a}}));
  EXPECT_EQ(world_.statistics().enlarged_pairs, 0u);
}

TEST_F(WorldMarginTest, AsksThePredicateAboutBoxesThatOverlapAndNoOthers) {
  int asked = 0;
  world_.set_predicate([&](Handle, Handle) {
    ++asked;
    return true;
  });
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(1.25F));
  world_.update();
  world_.refilter();
  world_.update();
  EXPECT_EQ(asked, 0);
  world_.move(b, at(1));
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, b}}));
  EXPECT_EQ(asked, 1);
}

TEST_F(WorldMarginTest, FollowsFiltersAndIgnoredPairs) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(0));
  world_.ignore(a, b);
  EXPECT_TRUE(world_.update().begun.empty());
  world_.unignore(a, b);
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, b}}));
  world_.set_filter(a, {.mask = 0});
  EXPECT_EQ(listed(world_.update().ended), (HandlePairs{{a, b}}));
  world_.set_filter(a, {});
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, b}}));
}

TEST_F(WorldMarginTest, MovesEnlargedBoxesWithTheOrigin) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(1));
  world_.update();
  world_.shift_origin({50, 0});
  EXPECT_TRUE(world_.update().ended.empty());
  world_.move(a, at(-50.25F));
  EXPECT_EQ(listed(world_.update().ended), (HandlePairs{{a, b}}));
  EXPECT_EQ(changes_, 4u);
}

TEST_F(WorldMarginTest, RefusesAMarginThatIsNone) {
  EXPECT_EQ(message_of<std::invalid_argument>([] { World2(with_margin(-1)); }),
            "the margin of a world is -1.000000; expected a finite number of at least 0");
  EXPECT_THROW(World2(with_margin(std::numeric_limits<double>::quiet_NaN())), std::invalid_argument);
  EXPECT_THROW(World2(with_margin(1e300)), std::invalid_argument) << "infinite as a float";
}

}  // namespace
}  // namespace broadside
