// Terdiman's published scene, whose number of pairs is known: 11,811 of 10,000 boxes in 3D, 1,144,045 of
// 100,000.
#include <algorithm>
#include <array>
#include <string_view>

#include <gtest/gtest.h>

#include "broadside/sinks.hpp"

#include "lab/scenes/scene.hpp"
#include "law_case.hpp"

namespace broadside::laws {
namespace {

/// Algorithms that are too slow for 100,000 boxes: they compare a box with many others, move it past them, or
/// remember them.
constexpr std::array<std::string_view, 9> slow = {"brute_force", "paper_brute_force", "bullet_axis_sweep",
                                                  "ode_sap",     "ode_hash",          "ode_quadtree",
                                                  "fcl_ssap",    "fcl_sap",           "fcl_spatial_hash"};

std::uint64_t pairs_of(const Algorithm& algorithm, std::size_t boxes) {
  const lab::NamedScene terdiman = lab::find_scene("terdiman");
  const auto history = lab::make_history<3>(terdiman.scene, terdiman.spec, {.boxes = boxes});
  PairCounter counter;
  make_finder<3>(algorithm, {algorithm.name, {}})->find(history.boxes, counter);
  return counter.count();
}

class TerdimanScene : public Law {};

TEST_P(TerdimanScene, HasThePairsOfTenThousandBoxes) { EXPECT_EQ(pairs_of(algorithm(), 10'000), 11'811u); }

TEST_P(TerdimanScene, HasThePairsOfAHundredThousandBoxes) {
  if (std::ranges::count(slow, algorithm().name) > 0) GTEST_SKIP() << algorithm().name << " is slow";
  EXPECT_EQ(pairs_of(algorithm(), 100'000), 1'144'045u);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, TerdimanScene, testing::ValuesIn(law_cases_in(3)), case_name);

}  // namespace
}  // namespace broadside::laws
