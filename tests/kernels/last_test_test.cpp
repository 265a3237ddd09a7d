// The last test in double, against the definition.
#include "kernels/last_test.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "tests/support/model.hpp"

namespace broadside::kernels {
namespace {

TEST(LastTest, DropsOfTheMarkedPairsThoseThatAreApartAndPutsTheOthersInOrder) {
  in_each_dimension([]<int D>() {
    Rng rng(1);
    for (int round = 0; round < 200; ++round) {
      std::vector<Box<D, double>> boxes;
      for (int i = 0; i < 100; ++i) boxes.push_back(near_double(rng, random_box<D>(rng, {.places = 8})));
      const std::size_t marked_one_in = 1 + rng.below(20);
      std::vector<Pair> pairs;
      std::vector<Pair> expected;
      for (std::size_t count = rng.below(PairSink::max_room + 1); count > 0; --count) {
        const auto a = static_cast<std::uint32_t>(rng.below(boxes.size()));
        const auto b = static_cast<std::uint32_t>(rng.below(boxes.size()));
        if (!rng.one_in(marked_one_in)) {
          pairs.push_back(ordered(a, b));
          expected.push_back(ordered(a, b));
          continue;
        }
        pairs.push_back({BoxId{a}, BoxId{b | touching_bit}});
        if (overlap(boxes[a], boxes[b])) expected.push_back(ordered(a, b));
      }
      const Pair* const end = keep_overlapping(boxes.data(), pairs.data(), pairs.data() + pairs.size());
      pairs.resize(static_cast<std::size_t>(end - pairs.data()));
      ASSERT_EQ(pairs, expected) << "round " << round;
    }
  });
}

}  // namespace
}  // namespace broadside::kernels
