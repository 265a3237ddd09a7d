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

/// Algorithms that compare about every box with every other, or move it past every other: too slow for
/// 100,000 boxes.
constexpr std::array<std::string_view, 3> quadratic = {"brute_force", "paper_brute_force",
                                                       "bullet_axis_sweep"};

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
  if (std::ranges::count(quadratic, algorithm().name) > 0)
    GTEST_SKIP() << algorithm().name << " is quadratic";
  EXPECT_EQ(pairs_of(algorithm(), 100'000), 1'144'045u);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, TerdimanScene, testing::ValuesIn(law_cases_in(3)), case_name);

}  // namespace
}  // namespace broadside::laws
