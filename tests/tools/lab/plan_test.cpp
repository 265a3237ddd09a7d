// Plans: what a comparison consists of.
#include "lab/measure/plan.hpp"

#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/error.hpp"

#include "lab/scenes/scene.hpp"

namespace broadside::lab {
namespace {

/// Whether the plan has the scene in that dimension.
bool has(const std::vector<CaseRequest>& plan, const Scene& scene, int dimension) {
  return std::ranges::any_of(plan, [&](const CaseRequest& request) {
    return request.scene == scene.name && request.dimension == dimension;
  });
}

TEST(LongPlan, HasEveryGeneratedSceneInEveryDimensionItHas) {
  for (const Scene& scene : scenes()) {
    if (scene.kind != SceneKind::generated || scene.hard) continue;
    for (const int dimension : {2, 3})
      EXPECT_EQ(has(long_plan(), scene, dimension), scene.has_dimension(dimension)) << scene.name;
  }
}

TEST(QuickPlan, IsAtLeastAThirdRealOrRecorded) {
  const std::vector<CaseRequest> plan = quick_plan();
  const auto given = std::ranges::count_if(plan, [](const CaseRequest& request) {
    const std::string name = request.scene.substr(0, request.scene.find(':'));
    for (const Scene& scene : scenes()) {
      if (scene.name == name) return scene.kind != SceneKind::generated;
    }
    return true;  // a scene that this build lacks is a recorded one
  });
  EXPECT_GE(3 * given, std::ssize(plan));
}

TEST(QuickPlan, EndsEachCaseInTime) {
  EXPECT_LT(quick_effort().case_seconds * static_cast<double>(quick_plan().size()), 120);
}

TEST(Plans, HaveJoinsOfTwoSets) {
  for (const auto& plan : {quick_plan(), long_plan()})
    EXPECT_GE(std::ranges::count_if(plan, [](const CaseRequest& request) { return request.left > 0; }), 2);
}

TEST(Plans, HaveFilteredCases) {
  for (const auto& plan : {quick_plan(), long_plan()})
    EXPECT_GE(std::ranges::count_if(plan, &CaseRequest::filtered), 2);
}

TEST(Plans, RequireNothingThatMayBeMissing) {
  for (const auto& plan : {quick_plan(), long_plan()}) {
    EXPECT_TRUE(std::ranges::none_of(plan, &CaseRequest::required));
  }
}

TEST(PlanOf, IsEveryCombination) {
  const auto plan = plan_of(
      {.scenes = {"uniform", "mixed:scale=10"}, .boxes = {100, 200}, .dimensions = {3}, .moving = {0, 0.5}});
  ASSERT_EQ(plan.size(), 8u);
  EXPECT_EQ(plan[0].scene, "uniform");
  EXPECT_EQ(plan[0].frames, 0u);
  EXPECT_EQ(plan[1].moving, 0.5);
  EXPECT_EQ(plan[1].frames, 20u);
  EXPECT_EQ(plan[7].scene, "mixed:scale=10");
  EXPECT_EQ(plan[7].boxes, 200u);
  EXPECT_TRUE(std::ranges::all_of(plan, [](const CaseRequest& r) { return r.dimension == 3 && r.required; }));
}

TEST(PlanOf, HasWhatIsNamedTwiceOnce) {
  EXPECT_EQ(plan_of({.scenes = {"uniform", "uniform"}, .boxes = {100, 100}, .dimensions = {2, 2}}).size(),
            1u);
}

TEST(PlanOf, IsEveryGeneratedSceneStillWhereNothingIsSaid) {
  std::set<std::string> names;
  for (const CaseRequest& request : plan_of({})) {
    names.insert(request.scene);
    EXPECT_EQ(request.boxes, 10'000u);
    if (!find_scene(request.scene).scene.history_2d) {
      EXPECT_EQ(request.frames, 0u) << request.scene;
    }
  }
  EXPECT_GE(names.size(), 8u);
}

TEST(PlanOf, MovesATenthWhereOnlyFramesAreSaid) {
  const auto plan = plan_of({.scenes = {"uniform"}, .dimensions = {2}, .frames = 7});
  ASSERT_EQ(plan.size(), 1u);
  EXPECT_EQ(plan[0].moving, 0.1);
  EXPECT_EQ(plan[0].frames, 7u);
}

TEST(PlanOf, RefusesAnUnknownScene) { EXPECT_THROW(plan_of({.scenes = {"nowhere"}}), InvalidSpec); }

TEST(InDimensions, KeepsOnlyThose) {
  const auto plan = in_dimensions(quick_plan(), std::vector{3});
  EXPECT_FALSE(plan.empty());
  EXPECT_TRUE(std::ranges::all_of(plan, [](const CaseRequest& request) { return request.dimension == 3; }));
}

}  // namespace
}  // namespace broadside::lab
