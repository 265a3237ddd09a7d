// OwnerPairs against the definition: two owners touch while boxes of theirs do.
#include "broadside/owners.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/find_pairs.hpp"
#include "broadside/keys.hpp"
#include "broadside/tracker.hpp"
#include "broadside/world.hpp"

#include "tests/support/rng.hpp"

namespace broadside {
namespace {

Box2 any_box(Rng& rng) {
  const auto x = static_cast<float>(rng.below(30));
  const auto y = static_cast<float>(rng.below(30));
  return {{x, y}, {x + static_cast<float>(rng.below(4)), y + static_cast<float>(rng.below(4))}};
}

using OwnerSet = std::set<OwnerPair>;

OwnerSet by_definition(const std::vector<Box2>& boxes, const std::vector<std::uint64_t>& owners) {
  OwnerSet pairs;
  for (std::size_t a = 0; a < boxes.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (is_present(boxes[a]) && is_present(boxes[b]) && overlap(boxes[a], boxes[b]) &&
          owners[a] != owners[b])
        pairs.insert({std::min(owners[a], owners[b]), std::max(owners[a], owners[b])});
    }
  }
  return pairs;
}

/// Adds what began and removes what ended, each of which must be new, and sorted.
void take(OwnerSet& held, OwnerEvents events) {
  EXPECT_TRUE(std::ranges::is_sorted(events.begun));
  EXPECT_TRUE(std::ranges::is_sorted(events.ended));
  for (const OwnerPair& pair : events.begun) EXPECT_TRUE(held.insert(pair).second);
  for (const OwnerPair& pair : events.ended) EXPECT_EQ(held.erase(pair), 1U);
}

TEST(OwnerPairsTest, FollowATracker) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Rng rng(seed);
    const std::size_t count = 2 + rng.below(150);
    std::vector<Box2> boxes(count);
    for (Box2& box : boxes) box = any_box(rng);
    std::vector<std::uint64_t> owners(count);
    const std::size_t kinds = 1 + rng.below(40);
    for (std::uint64_t& owner : owners) owner = (std::uint64_t{1} << 40) + rng.below(kinds);
    const bool is_filtered = rng.one_in(2);
    const std::vector<Filter> filters = filters_of_keys(KeyRule::different, owners);
    Tracker<2> tracker;
    OwnerPairs bodies;
    OwnerSet held;
    std::vector<BoxId> all;
    for (std::size_t i = 0; i < count; ++i) all.push_back(BoxId(i));
    for (int frame = 0; frame < 20; ++frame) {
      for (Box2& box : boxes) {
        if (rng.one_in(8)) box = rng.one_in(4) ? absent_box<2>() : any_box(rng);
      }
      std::vector<Pair> begun;
      std::vector<Pair> ended;
      tracker.update(
          {.boxes = boxes,
           .changed = all,
           .filters = is_filtered ? std::span<const Filter>(filters) : std::span<const Filter>()},
          [&](Pair pair) { begun.push_back(pair); }, [&](Pair pair) { ended.push_back(pair); });
      take(held, bodies.update(begun, ended, owners));
      const OwnerSet expected = by_definition(boxes, owners);
      EXPECT_EQ(held, expected) << seed;
      EXPECT_TRUE(std::ranges::equal(bodies.pairs(), expected)) << seed;
      OwnerPairs anew;
      EXPECT_TRUE(std::ranges::equal(anew.update(find_pairs(boxes), {}, owners).begun, expected)) << seed;
    }
  }
}

TEST(OwnerPairsTest, FollowAWorldWhoseBodiesAreRemoved) {
  Rng rng(3);
  World2 world;
  OwnerPairs bodies;
  OwnerSet held;
  std::vector<Handle> handles;
  std::vector<Box2> boxes;
  std::vector<std::uint64_t> owners;
  for (std::uint64_t owner = 1; owner <= 30; ++owner) {
    for (int i = 0; i < 4; ++i) {
      boxes.push_back(any_box(rng));
      owners.push_back(owner);
      handles.push_back(world.add(boxes.back(), {.user_data = owner}));
    }
  }
  for (int frame = 0; frame < 15; ++frame) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (!is_present(boxes[i]) || !rng.one_in(5)) continue;
      boxes[i] = any_box(rng);
      world.move(handles[i], boxes[i]);
    }
    const std::size_t removed = 4 * rng.below(30);
    for (std::size_t i = removed; i < removed + 4 && is_present(boxes[i]); ++i) {
      boxes[i] = absent_box<2>();
      world.remove(handles[i]);
    }
    const Events events = world.update();
    take(held, bodies.update(events.begun_data, events.ended_data));
    EXPECT_EQ(held, by_definition(boxes, owners)) << frame;
  }
  EXPECT_EQ(bodies.size(), held.size());
}

TEST(OwnerPairsTest, RefuseWhatNeverBeganAndChangeNothing) {
  const std::array owners = {std::uint64_t{7}, std::uint64_t{7}, std::uint64_t{9}, std::uint64_t{4}};
  const std::vector<Pair> both = {{BoxId(0), BoxId(2)}, {BoxId(1), BoxId(2)}};
  const std::vector<Pair> other = {{BoxId(0), BoxId(3)}};
  const std::vector<Pair> beyond = {{BoxId(2), BoxId(3)}, {BoxId(3), BoxId(4)}};
  OwnerPairs bodies;
  EXPECT_EQ(bodies.update(both, {}, owners).begun.size(), 1U);
  const auto refusal = [&](std::span<const Pair> begun, std::span<const Pair> ended) -> std::string {
    try {
      bodies.update(begun, ended, owners);
    } catch (const InvalidFrame& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(refusal(beyond, {}), testing::HasSubstr("owners has 4 elements, and box 4 is in a pair"));
  EXPECT_THAT(refusal(std::span(beyond).first(1), other),
              testing::HasSubstr("owners 4 and 7 have 0 pairs, and 1 more end than begin"));
  EXPECT_THAT(bodies.pairs(), testing::ElementsAre(OwnerPair{7, 9}));
  EXPECT_TRUE(bodies.update({}, std::span(both).first(1), owners).ended.empty()) << "another one holds";
  EXPECT_EQ(bodies.update({}, std::span(both).last(1), owners).ended.size(), 1U);
  EXPECT_EQ(bodies.size(), 0U);
}

}  // namespace
}  // namespace broadside
