// The law on every scene of the lab, still and moving.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hard_inputs.hpp"
#include "lab/scenes/scene.hpp"
#include "law_case.hpp"
#include "smallest_failure.hpp"

namespace broadside::laws {
namespace {

class SceneLaw : public Law {
 protected:
  static bool is_recorded(const lab::Scene& scene) { return scene.kind == lab::SceneKind::recorded; }

  /// Large data, and what an engine has to simulate first: others than ours see those in the comparison,
  /// which verifies what they find.
  static bool is_left_out(const lab::Scene& scene) {
    return (scene.fixed_count || is_recorded(scene)) && !is_own(GetParam());
  }

  /// The scene's history, or nothing where it does not exist in D dimensions or is beyond the algorithm's
  /// declared limits.
  template <int D>
  std::optional<lab::History<D>> history_of(const lab::Scene& scene, const lab::SceneRequest& request) const {
    if (!scene.has_dimension(D)) return std::nullopt;
    lab::History<D> history = lab::make_history<D>(scene, {scene.name, {}}, request);
    const auto beyond = [&](const Box<D>& box) { return is_beyond(algorithm(), box); };
    if (std::ranges::any_of(history.boxes, beyond)) return std::nullopt;
    for (const lab::Step<D>& step : history.steps) {
      if (std::ranges::any_of(step.boxes, beyond)) return std::nullopt;
    }
    return history;
  }
};

TEST_P(SceneLaw, FindsEachOverlappingPairOnce) {
  in_dimension([&]<int D>() {
    std::vector<std::size_t> counts = {0, 1, 3, 200, reduced(1000)};
    if (is_peer(GetParam())) counts = {3, 200};
    for (const lab::Scene& scene : lab::scenes()) {
      if (is_left_out(scene)) continue;
      std::uint64_t seed = 0;
      for (const std::size_t count : counts) {
        // Few boxes of a hard scene are like any other's.
        if ((scene.hard && count < 200) || (is_recorded(scene) && count != 200)) continue;
        const auto history = history_of<D>(scene, {.boxes = count, .seed = ++seed});
        if (!history) continue;
        EXPECT_TRUE(finds_the_pairs<D>(algorithm(), spec(), history->boxes))
            << scene.name << ", " << count << " boxes, seed " << seed;
        if (scene.fixed_count) break;
      }
    }
  });
}

TEST_P(SceneLaw, TracksMovingBoxes) {
  in_dimension([&]<int D>() {
    const std::size_t boxes = reduced(200);
    for (const lab::Scene& scene : lab::scenes()) {
      // Those are large, and move like all others.
      if (is_left_out(scene) || (scene.fixed_count && sanitized)) continue;
      for (const lab::SceneRequest& request :
           {lab::SceneRequest{.boxes = boxes, .frames = 12, .moving = 0.1},
            lab::SceneRequest{.boxes = boxes, .seed = 2, .frames = 12, .moving = 1, .drift = 0.5},
            lab::SceneRequest{.boxes = boxes, .seed = 3, .frames = 12, .moving = 0.5, .teleport = 0.3}}) {
        if (is_peer(GetParam()) && request.teleport == 0) continue;
        const auto history = history_of<D>(scene, request);
        if (!history) continue;
        EXPECT_TRUE(tracks_the_pairs<D>(algorithm(), spec(), *history))
            << scene.name << ", seed " << request.seed;
        // Those are large; a recording moves as it was recorded.
        if (scene.fixed_count || is_recorded(scene)) break;
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, SceneLaw, testing::ValuesIn(law_cases()), case_name);

}  // namespace
}  // namespace broadside::laws
