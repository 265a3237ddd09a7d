// The plain searches against the definition, whatever is left out.
#include "paper/plain/plain.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/executor.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

#include "tests/support/model.hpp"
#include "tests/support/scattered.hpp"

namespace broadside::plain {
namespace {

/// All combinations of the algorithm's switches.
std::vector<Spec> all_specs(const Algorithm& algorithm) {
  std::vector<Spec> specs = {{algorithm.name, {}}};
  for (const Tunable& tunable : algorithm.tunables) {
    const std::size_t count = specs.size();
    for (std::size_t i = 0; i < count; ++i) {
      specs.push_back(specs[i]);
      specs.back().values.emplace_back(tunable.name, "no");
    }
  }
  return specs;
}

template <int D>
std::vector<Pair> pairs_by(const Algorithm& algorithm, const Spec& spec, const std::vector<Box<D>>& boxes) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  Finder<D>(algorithm, spec).find(boxes, collector);
  std::ranges::sort(pairs);
  return pairs;
}

template <int D>
std::vector<Pair> pairs_by_definition(const std::vector<Box<D>>& boxes) {
  std::vector<Pair> pairs;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
      if (overlap(boxes[i], boxes[j])) pairs.push_back({BoxId{i}, BoxId{j}});
    }
  }
  return pairs;
}

TEST(PlainSearches, FindEachPairOnceWhateverIsLeftOut) {
  in_each_dimension([]<int D>() {
    // Few and many, sparse and crowded, large ones among small ones, and all at one place.
    std::vector<std::vector<Box<D>>> inputs = {{},
                                               scattered_boxes<D>(1),
                                               scattered_boxes<D>(17),
                                               scattered_boxes<D>(700, 60),
                                               scattered_boxes<D>(700, 12)};
    inputs.push_back(scattered_boxes<D>(400, 40));
    for (std::size_t i = 0; i < inputs.back().size(); i += 40) inputs.back()[i].max.fill(50);
    inputs.emplace_back(40, scattered_boxes<D>(1)[0]);
    for (const Algorithm& algorithm : {plain_grid(), plain_bvh()}) {
      for (const Spec& spec : all_specs(algorithm)) {
        for (const std::vector<Box<D>>& boxes : inputs)
          ASSERT_EQ(pairs_by<D>(algorithm, spec, boxes), pairs_by_definition<D>(boxes))
              << spec.text() << ", " << boxes.size() << " boxes in " << D << "D";
      }
    }
  });
}

TEST(PlainSearches, HoldTheLibraryBackForOneSearch) {
  const std::string before = instruction_set();
  const std::vector<Box2> boxes = scattered_boxes<2>(300);
  for (const std::string& set : instruction_sets())
    EXPECT_EQ(pairs_by<2>(held_back(), {"held_back", {{"simd", set}}}, boxes), pairs_by_definition<2>(boxes));
  EXPECT_EQ(instruction_set(), before);
}

}  // namespace
}  // namespace broadside::plain
