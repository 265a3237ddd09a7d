// clustering() of boxes that are spread evenly and of others.
#include "algorithms/auto/clustering.hpp"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/model.hpp"

namespace broadside::algorithm {
namespace {

TEST(Clustering, TellsClustersFromBoxesThatAreSpreadEvenly) {
  in_each_dimension([]<int D>() {
    Rng rng(3);
    const std::vector<Box<D>> even = random_boxes<D>(rng, 5000, {.places = 1000, .infinite_one_in = 0});
    std::vector<Box<D>> clustered = even;
    for (Box<D>& box : clustered) box.min.fill(static_cast<float>(rng.whole(0, 7) * 120 + rng.whole(0, 20)));
    std::array<float, D> reach;
    reach.fill(60);
    EXPECT_LT(clustering<D>(even, reach), 2);
    EXPECT_GT(clustering<D>(clustered, reach), 3);
  });
}

}  // namespace
}  // namespace broadside::algorithm
