// The name that a message suggests for one that is not known.
#include "core/suggestion.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/error.hpp"
#include "broadside/finder.hpp"

namespace broadside {
namespace {

using testing::HasSubstr;
using testing::Property;
using testing::Throws;

const std::vector<std::string> names = {"grid", "bvh", "quadtree", "sweep_and_prune"};

TEST(DidYouMean, SuggestsTheNearestNameWithinTwoLetters) {
  EXPECT_EQ(core::did_you_mean("gird", names), " (did you mean 'grid'?)");
  EXPECT_EQ(core::did_you_mean("BVH", names), " (did you mean 'bvh'?)");
  EXPECT_EQ(core::did_you_mean("bhv", names), " (did you mean 'bvh'?)");
  EXPECT_EQ(core::did_you_mean("quatree", names), " (did you mean 'quadtree'?)");
  EXPECT_EQ(core::did_you_mean("sweep-and-prune", names), " (did you mean 'sweep_and_prune'?)");
  EXPECT_EQ(core::did_you_mean("sweep", names), " (did you mean 'sweep_and_prune'?)");
  EXPECT_EQ(core::did_you_mean("sap", names), " (did you mean 'sweep_and_prune'?)");
}

TEST(DidYouMean, PrefersANearNameToOneThatBeginsSo) {
  const std::vector<std::string> options = {"--no-progress", "-n"};
  EXPECT_EQ(core::did_you_mean("--n", options), " (did you mean '-n'?)");
}

TEST(DidYouMean, SuggestsNothingFarAway) {
  EXPECT_EQ(core::did_you_mean("octree", names), "");
  EXPECT_EQ(core::did_you_mean("gr", names), "");
  EXPECT_EQ(core::did_you_mean("x", names), "");
  EXPECT_EQ(core::did_you_mean("", names), "");
  EXPECT_EQ(core::did_you_mean(std::string(100'000, 'g'), names), "");
  EXPECT_EQ(core::did_you_mean("grid", {}), "");
}

TEST(DidYouMean, IsAskedForUnknownAlgorithmsAndTunables) {
  const auto says = [](const char* suggestion) {
    return Throws<InvalidSpec>(Property(&InvalidSpec::what, HasSubstr(suggestion)));
  };
  EXPECT_THAT([] { Finder<2>("gird"); }, says("unknown algorithm 'gird' (did you mean 'grid'?); expected"));
  EXPECT_THAT([] { Finder<2>("grid:cel=2"); },
              says("grid: unknown tunable 'cel' (did you mean 'cell'?); expected"));
}

}  // namespace
}  // namespace broadside
