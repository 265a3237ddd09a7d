// Golden hashes: the pairs and events of scenes built from integers, the same whatever algorithm, compiler or
// machine; and the order of our own finders' pairs, the same whatever compiler and machine.
//
// A hash of pairs never changes unless its scene does. A hash of an order changes when the algorithm reports
// in another order: then the test's message says the new one, which must be the same under the presets
// `release` and `clang`.
#include <algorithm>
#include <array>
#include <cstdint>
#include <ios>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/sinks.hpp"

#include "lab/scenes/scene.hpp"
#include "law_case.hpp"
#include "law_sinks.hpp"

namespace broadside::laws {
namespace {

struct GoldenScene {
  std::string_view scene;
  int dimension;
  std::uint64_t pairs;   ///< of the first frame
  std::uint64_t hash;    ///< of those
  std::uint64_t events;  ///< hash of all events, of the first frame and of those in motion
};

constexpr std::array<GoldenScene, 6> golden_scenes = {{
    {"lattice", 2, 7733, 0x5a91e78e965e147dU, 0x131cc4a661d0ebd4U},
    {"lattice", 3, 21954, 0xeb16de0c7a823206U, 0x5d1d57fb9cd3b5a4U},
    {"integers", 2, 3757, 0x4a15172cc2d0baddU, 0x31353a5b23daab33U},
    {"integers", 3, 3226, 0x428241f99d2d0572U, 0xfea20921a992f16eU},
    {"terdiman", 2, 7949, 0x65a4aad6a4df8d34U, 0x704fe9d8c2fd08b6U},
    {"terdiman", 3, 473, 0xa27437f56e244058U, 0x9ceca02540b7bedbU},
}};

struct GoldenOrder {
  std::string_view algorithm;
  int dimension;
  std::uint64_t hash;
};

constexpr auto golden_orders = std::to_array<GoldenOrder>({
    {"auto", 2, 0xe6634f59d2ef9559U},
    {"auto", 3, 0x015017327fed702eU},
    {"brute_force", 2, 0x79bebaf2ce36ffbdU},
    {"brute_force", 3, 0x14940631e712ac4aU},
    {"grid", 2, 0xe6634f59d2ef9559U},
    {"grid", 3, 0x015017327fed702eU},
    {"sweep_and_prune", 2, 0xc9247fb29c7ca839U},
    {"sweep_and_prune", 3, 0xb56e0b088d97bcdeU},
    {"quadtree", 2, 0x85c4c8674de5ec01U},
    {"quadtree", 3, 0x4e4907df8b50316aU},
    {"bvh", 2, 0x84e8fe29d048d7edU},
    {"bvh", 3, 0xa5ece44084832406U},
});

template <int D>
lab::History<D> history_of(std::string_view name) {
  const lab::NamedScene named = lab::find_scene(name);
  EXPECT_TRUE(named.scene.integers) << name;
  return lab::make_history<D>(named.scene, named.spec,
                              {.boxes = 2000, .seed = 1, .frames = 5, .moving = 0.2, .teleport = 0.1});
}

class GoldenHashes : public Law {};

TEST_P(GoldenHashes, OfPairsAreTheSame) {
  in_dimension([&]<int D>() {
    for (const GoldenScene& golden : golden_scenes) {
      if (golden.dimension != D) continue;
      const lab::History<D> history = history_of<D>(golden.scene);
      PairHasher hasher;
      Finder<D>(algorithm(), spec()).find(history.boxes, hasher);
      EXPECT_EQ(hasher.count(), golden.pairs) << golden.scene;
      EXPECT_EQ(hasher.hash(), golden.hash) << golden.scene;
    }
  });
}

TEST_P(GoldenHashes, OfEventsAreTheSame) {
  in_dimension([&]<int D>() {
    for (const GoldenScene& golden : golden_scenes) {
      if (golden.dimension != D) continue;
      lab::History<D> history = history_of<D>(golden.scene);
      Tracker<D> tracker(algorithm(), spec());
      OrderHasher hasher;  // events come sorted, so that their order is golden as well
      tracker.update({history.boxes, {}}, hasher, hasher);
      for (const lab::Step<D>& step : history.steps) {
        lab::apply(step, history.boxes);
        tracker.update({history.boxes, step.changed}, hasher, hasher);
      }
      EXPECT_EQ(hasher.hash, golden.events) << golden.scene;
    }
  });
}

class GoldenOrders : public Law {};

TEST_P(GoldenOrders, AreTheSame) {
  in_dimension([&]<int D>() {
    OrderHasher hasher;
    Finder<D>(algorithm(), spec()).find(history_of<D>("integers").boxes, hasher);
    const auto golden = std::ranges::find_if(golden_orders, [&](const GoldenOrder& order) {
      return order.algorithm == algorithm().name && order.dimension == D;
    });
    ASSERT_NE(golden, golden_orders.end())
        << "add {\"" << algorithm().name << "\", " << D << ", 0x" << std::hex << hasher.hash << "U},";
    EXPECT_EQ(hasher.hash, golden->hash)
        << "if the order was meant to change, write 0x" << std::hex << hasher.hash << "U";
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, GoldenHashes, testing::ValuesIn(law_cases()), case_name);
INSTANTIATE_TEST_SUITE_P(Catalogue, GoldenOrders, testing::ValuesIn(law_cases_if(is_own)), case_name);

}  // namespace
}  // namespace broadside::laws
