// The law of finders: exactly the overlapping pairs, each once, whatever the boxes and whatever came before.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/sinks.hpp"

#include "hard_inputs.hpp"
#include "law_case.hpp"
#include "smallest_failure.hpp"
#include "strained_specs.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

template <int D>
std::vector<Pair> pairs_of(Finder<D>& finder, std::span<const Box<D>> boxes) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  finder.find(boxes, collector);
  return pairs;
}

class FinderLaw : public Law {
 protected:
  /// The pairs, of which a peer does not promise any order.
  std::vector<Pair> compared(std::vector<Pair> pairs) const {
    if (algorithm().kind == AlgorithmKind::peer) std::ranges::sort(pairs);
    return pairs;
  }
};

TEST_P(FinderLaw, FindsEachOverlappingPairOnce) {
  in_dimension([&]<int D>() {
    for (const Input<D>& input : hard_inputs<D>(algorithm(), reduced(2000)))
      EXPECT_TRUE(finds_the_pairs<D>(algorithm(), spec(), input.boxes)) << input.name;
  });
}

TEST_P(FinderLaw, HasNoMemoryThatShows) {
  in_dimension([&]<int D>() {
    Finder<D> used(algorithm(), spec());
    std::vector<Input<D>> inputs = hard_inputs<D>(algorithm());
    for (int round = 0; round < 2; ++round) {
      for (const Input<D>& input : inputs) {
        Finder<D> fresh(algorithm(), spec());
        EXPECT_EQ(compared(pairs_of<D>(used, input.boxes)), compared(pairs_of<D>(fresh, input.boxes)))
            << input.name;
      }
      Rng(1).shuffle(inputs);
    }
  });
}

TEST_P(FinderLaw, FindsTheSamePairsInAnyOrderOfTheBoxes) {
  in_dimension([&]<int D>() {
    Rng rng(2);
    for (Input<D>& input : hard_inputs<D>(algorithm())) {
      rng.shuffle(input.boxes);
      EXPECT_TRUE(finds_the_pairs<D>(algorithm(), spec(), input.boxes)) << input.name << ", shuffled";
    }
  });
}

TEST_P(FinderLaw, FindsThePairsOfShiftedAndScaledBoxes) {
  in_dimension([&]<int D>() {
    Rng rng(3);
    for (const float scale : {1e-30f, 1e-3f, 1e3f, 1e30f}) {
      for (const float shift : {0.0f, -1.0f, 1000.0f}) {
        std::vector<Box<D>> boxes(200);
        for (Box<D>& box : boxes) {
          for (int axis = 0; axis < D; ++axis) {
            box.min[axis] = scale * (shift + rng.between(0, 10));
            box.max[axis] = box.min[axis] + scale * rng.between(0, 2);
          }
        }
        std::erase_if(boxes, [&](const Box<D>& box) { return is_beyond(algorithm(), box); });
        EXPECT_TRUE(finds_the_pairs<D>(algorithm(), spec(), boxes))
            << "scale " << scale << ", shift " << shift;
      }
    }
  });
}

TEST_P(FinderLaw, HoldsForEveryTunable) {
  in_dimension([&]<int D>() {
    const std::vector<Input<D>> inputs = hard_inputs<D>(algorithm(), reduced(is_own(GetParam()) ? 300 : 100));
    std::size_t turn = 0;
    for (const Spec& strained : strained_specs(GetParam())) {
      for (const Input<D>& input : inputs) {
        if (!is_own(GetParam()) && ++turn % 4 != 0) continue;  // others for the next value
        EXPECT_TRUE(finds_the_pairs<D>(algorithm(), strained, input.boxes)) << input.name;
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, FinderLaw, testing::ValuesIn(law_cases()), case_name);

}  // namespace
}  // namespace broadside::laws
