// CGAL's box_self_intersection_d as an oracle that shares no code with us, not even the definition.
#include <algorithm>
#include <cstddef>
#include <vector>

#include <CGAL/box_intersection_d.h>
#include <gtest/gtest.h>

#include "broadside/sinks.hpp"

#include "lab/scenes/scene.hpp"
#include "lab/verify/verify.hpp"
#include "law_case.hpp"

namespace broadside::laws {
namespace {

/// The overlapping pairs as CGAL sees them, boxes closed; sorted.
template <int D>
std::vector<Pair> cgal_pairs(std::span<const Box<D>> boxes) {
  using CgalBox = CGAL::Box_intersection_d::Box_with_info_d<float, D, BoxId>;
  std::vector<CgalBox> all;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    float min[D];
    float max[D];
    std::ranges::copy(boxes[i].min, min);
    std::ranges::copy(boxes[i].max, max);
    all.emplace_back(min, max, BoxId(i));
  }
  // CGAL sorts what it is given, and a box's address is what it tells boxes apart by.
  std::vector<const CgalBox*> pointers;
  for (const CgalBox& box : all) pointers.push_back(&box);

  std::vector<Pair> pairs;
  const auto report = [&pairs](const CgalBox* a, const CgalBox* b) {
    pairs.push_back({std::min(a->info(), b->info()), std::max(a->info(), b->info())});
  };
  CGAL::box_self_intersection_d(pointers.begin(), pointers.end(), report, std::ptrdiff_t{10},
                                CGAL::Box_intersection_d::CLOSED);
  std::ranges::sort(pairs);
  return pairs;
}

class CgalOracle : public testing::TestWithParam<int> {};

template <int D>
void expect_agreement(const lab::Scene& scene) {
  // All pairs of 20,000 boxes at one point would be 200 million. The paper's listings and brute force are
  // quadratic, and any algorithm may be so on hard scenes.
  const bool is_hard = scene.hard || scene.name == "one_point";
  for (const bool is_large : {false, true}) {
    if (is_large && is_hard) continue;
    const auto history = lab::make_history<D>(scene, {scene.name, {}},
                                              {.boxes = is_large ? reduced(20'000) : 1000, .seed = 5});
    const std::vector<Pair> expected = cgal_pairs<D>(history.boxes);
    for (const LawCase& law_case : law_cases_without_peers()) {
      const bool is_fast = !is_hard && is_own(law_case) && law_case.algorithm->name != "brute_force";
      if (law_case.dimension != D || is_fast != is_large) continue;
      std::vector<Pair> found;
      PairCollector collector(found);
      Finder<D>(*law_case.algorithm, {law_case.algorithm->name, {}}).find(history.boxes, collector);
      const auto divergence = lab::compare_pairs(std::move(found), expected);
      EXPECT_FALSE(divergence) << scene.name << ", " << name(law_case) << ": " << divergence->text;
    }
  }
}

TEST_P(CgalOracle, AgreesOnEveryGeneratedScene) {
  for (const lab::Scene& scene : lab::scenes()) {
    if (scene.kind != lab::SceneKind::generated || !scene.has_dimension(GetParam())) continue;
    GetParam() == 2 ? expect_agreement<2>(scene) : expect_agreement<3>(scene);
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, CgalOracle, testing::Values(2, 3));

}  // namespace
}  // namespace broadside::laws
