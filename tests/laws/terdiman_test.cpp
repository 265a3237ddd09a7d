// Terdiman's published scene, whose number of pairs is known: 11,811 of 10,000 boxes in 3D, 1,144,045 of
// 100,000.
#include <cstddef>
#include <cstdint>

#include <gtest/gtest.h>

#include "broadside/sinks.hpp"

#include "lab/scenes/scene.hpp"
#include "law_case.hpp"

namespace broadside::laws {
namespace {

std::uint64_t pairs_of(const Algorithm& algorithm, std::size_t boxes) {
  const lab::NamedScene terdiman = lab::find_scene("terdiman");
  const auto history = lab::make_history<3>(terdiman.scene, terdiman.spec, {.boxes = boxes});
  PairCounter counter;
  Finder<3>(algorithm, {algorithm.name, {}}).find(history.boxes, counter);
  return counter.count();
}

class TerdimanScene : public Law {};

TEST_P(TerdimanScene, HasThePairsOfTenThousandBoxes) { EXPECT_EQ(pairs_of(algorithm(), 10'000), 11'811u); }

class LargeTerdimanScene : public Law {};

TEST_P(LargeTerdimanScene, HasThePairsOfAHundredThousandBoxes) {
  EXPECT_EQ(pairs_of(algorithm(), 100'000), 1'144'045u);
}

bool is_3d(const LawCase& law_case) { return law_case.dimension == 3; }

/// Whether it takes less than quadratic time, and is no peer: those are held to the same boxes, fewer of
/// them. Under a sanitizer, the literature's are as well.
bool takes_many(const LawCase& law_case) {
  return is_3d(law_case) && !is_peer(law_case) && !law_case.algorithm->name.ends_with("brute_force") &&
         (is_own(law_case) || !sanitized);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, TerdimanScene, testing::ValuesIn(law_cases_if(is_3d)), case_name);
INSTANTIATE_TEST_SUITE_P(Catalogue, LargeTerdimanScene, testing::ValuesIn(law_cases_if(takes_many)),
                         case_name);

}  // namespace
}  // namespace broadside::laws
