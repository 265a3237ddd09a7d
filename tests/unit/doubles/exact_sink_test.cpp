// ExactSink against the definition in double, where floats cannot tell many boxes apart.
#include "doubles/exact_sink.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/model.hpp"

namespace broadside::core {
namespace {

TEST(ExactSink, PassesOnInOrderWhatOverlapsInDouble) {
  in_each_dimension([]<int D>() {
    Rng rng(1);
    for (const std::size_t left_count : {0, 100}) {
      // About 2^24 + 60, where a float has steps of 2: many that lie apart touch as floats.
      std::vector<Box<D, double>> boxes(260);
      std::vector<Box<D>> floats(boxes.size());
      std::vector<std::uint32_t> ids(boxes.size());
      std::iota(ids.begin(), ids.end(), 0);
      rng.shuffle(ids);
      for (std::size_t place = 0; place < ids.size(); ++place) {
        const Box<D> drawn = random_box<D>(rng, {.most_extent = 25, .infinite_one_in = 0});
        for (int axis = 0; axis < D; ++axis) {
          boxes[ids[place]].min[axis] = 0x1p24 + drawn.min[axis] / 2;
          boxes[ids[place]].max[axis] = 0x1p24 + drawn.max[axis] / 2;
          floats[place].min[axis] = static_cast<float>(boxes[ids[place]].min[axis]);
          floats[place].max[axis] = static_cast<float>(boxes[ids[place]].max[axis]);
        }
      }
      std::vector<Pair> pairs = overlapping_pairs(floats, left_count);
      rng.shuffle(pairs);
      std::vector<Pair> expected;
      for (const Pair pair : pairs) {
        const std::uint32_t a = ids[index(pair.first)];
        const std::uint32_t b = ids[index(pair.second)];
        if (overlap(boxes[a], boxes[b])) expected.push_back(ordered(a, b));
      }
      ASSERT_LT(expected.size(), pairs.size());
      ASSERT_GT(expected.size(), PairSink::max_room) << "more than a chunk";
      // Of two sets, a pair's ids count from the beginning of each.
      for (Pair& pair : pairs) pair.second = BoxId(index(pair.second) - left_count);
      const RoundedBoxes<D> rounded{boxes, ids, floats, left_count, false};
      EXPECT_EQ(written_pairs([&](PairSink& target) { ExactSink<D>(rounded, target).put(pairs); }), expected);
    }
  });
}

}  // namespace
}  // namespace broadside::core
