// The search of sweep and prune, along each axis and in stripes.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/algorithms/searched.hpp"

namespace broadside::algorithm {
namespace {

TEST(SweepAndPrune, FindsThePairsOfTheDefinitionAlongEachAxis) {
  on_each_instruction_set([]<int D>() {
    Rng rng(1);
    const std::vector<Box<D>> boxes = random_boxes<D>(rng, 700);
    for (const char axis : std::string(D == 2 ? "xy" : "xyz")) {
      for (const char* const axes : {"1", "2", "auto"})
        expect_definition(std::string("sweep_and_prune:axis=") + axis + ":axes=" + axes, boxes);
    }
  });
}

TEST(SweepAndPrune, TakesTheAxisWithTheFewestTests) {
  in_each_dimension([]<int D>() {
    for (int along = 0; along < D; ++along) {
      std::vector<Box<D>> line(2000);
      for (std::size_t i = 0; i < line.size(); ++i) {
        line[i].min[along] = static_cast<float>(2 * i);
        line[i].max[along] = line[i].min[along] + 1;
      }
      const auto statistics = expect_definition(Spec("sweep_and_prune"), line);
      ASSERT_TRUE(statistics);
      EXPECT_LT(statistics->tests, 40 * line.size()) << "along axis " << along;
    }
  });
}

}  // namespace
}  // namespace broadside::algorithm
