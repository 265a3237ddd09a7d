// Which cases a comparison consists of. The two plans are the two tables below.
#include "lab/measure/plan.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <limits>
#include <string_view>

#include "broadside/error.hpp"

#include "lab/scenes/scene.hpp"

namespace broadside::lab {
namespace {

constexpr std::size_t standard_boxes = 10'000;
constexpr std::size_t standard_frames = 20;
constexpr double standard_moving = 0.1;

/// A line of a plan: stands for both dimensions, where the scene has them.
struct Row {
  std::string_view scene;
  std::size_t boxes;  // 0: the scene's own
  double moving = 0;
  std::size_t frames = 0;
};

constexpr std::array quick_rows = {
    Row{"uniform", 1'000},
    Row{"uniform", 10'000},
    Row{"uniform", 100'000},
    Row{"power_law", 10'000},
    Row{"mixed", 10'000},
    Row{"clustered", 10'000},
    Row{"one_point", 2'000},
    Row{"one_line", 10'000},
    Row{"lattice", 10'000},
    Row{"integers", 10'000},
    Row{"thin", 10'000},
    Row{"terdiman", 10'000},
    Row{"uniform", 10'000, 0.1, 20},
    Row{"clustered", 10'000, 0.1, 20},
    Row{"churn", 1'000, 0, 20},
    Row{"box2d_rain", 1'000, 0, 30},
    Row{"box2d_pyramid", 1'000, 0, 30},
    Row{"bullet_free_fall", 1'000, 0, 30},
    Row{"bunny", 0},
};

constexpr std::array long_rows = {
    Row{"uniform", 1'000},
    Row{"uniform", 10'000},
    Row{"uniform", 100'000},
    Row{"uniform", 1'000'000},
    Row{"power_law", 1'000},
    Row{"power_law", 10'000},
    Row{"power_law", 100'000},
    Row{"power_law", 1'000'000},
    Row{"mixed", 1'000},
    Row{"mixed", 10'000},
    Row{"mixed", 100'000},
    Row{"mixed", 1'000'000},
    Row{"clustered", 1'000},
    Row{"clustered", 10'000},
    Row{"clustered", 100'000},
    Row{"clustered", 1'000'000},
    Row{"one_point", 1'000},
    Row{"one_point", 5'000},
    Row{"one_line", 1'000},
    Row{"one_line", 10'000},
    Row{"one_line", 100'000},
    Row{"lattice", 1'000},
    Row{"lattice", 10'000},
    Row{"lattice", 100'000},
    Row{"integers", 10'000},
    Row{"integers", 100'000},
    Row{"thin", 1'000},
    Row{"thin", 10'000},
    Row{"thin", 100'000},
    Row{"terdiman", 10'000},
    Row{"terdiman", 100'000},
    Row{"uniform", 10'000, 0.01, 20},
    Row{"uniform", 10'000, 0.1, 20},
    Row{"uniform", 10'000, 0.5, 20},
    Row{"uniform", 10'000, 1, 20},
    Row{"uniform", 100'000, 0.01, 20},
    Row{"uniform", 100'000, 0.1, 20},
    Row{"uniform", 100'000, 0.5, 20},
    Row{"uniform", 100'000, 1, 20},
    Row{"clustered", 10'000, 0.01, 20},
    Row{"clustered", 10'000, 0.1, 20},
    Row{"clustered", 10'000, 0.5, 20},
    Row{"clustered", 10'000, 1, 20},
    Row{"clustered", 100'000, 0.01, 20},
    Row{"clustered", 100'000, 0.1, 20},
    Row{"clustered", 100'000, 0.5, 20},
    Row{"clustered", 100'000, 1, 20},
    Row{"churn", 1'000, 0, 50},
    Row{"churn", 10'000, 0, 50},
    Row{"box2d_rain", 1'000, 0, 60},
    Row{"box2d_rain", 5'000, 0, 60},
    Row{"box2d_tumbler", 1'000, 0, 60},
    Row{"box2d_tumbler", 5'000, 0, 60},
    Row{"box2d_pyramid", 1'000, 0, 60},
    Row{"box2d_pyramid", 5'000, 0, 60},
    Row{"bullet_free_fall", 1'000, 0, 60},
    Row{"bullet_free_fall", 5'000, 0, 60},
    Row{"bullet_brownian", 1'000, 0, 60},
    Row{"bullet_brownian", 5'000, 0, 60},
    Row{"bullet_moving_gravity", 1'000, 0, 60},
    Row{"bullet_moving_gravity", 5'000, 0, 60},
    Row{"bunny", 0},
};

/// What a scene is known to have, before it is made. A scene that is not there is thought to have both
/// dimensions, so that it is reported once it is to be compared.
bool has_dimension(const std::string& scene, int dimension) {
  try {
    return find_scene(scene).scene.has_dimension(dimension);
  } catch (const std::exception&) {
    return dimension == 2;
  }
}

std::vector<CaseRequest> plan_from(std::span<const Row> rows) {
  std::vector<CaseRequest> plan;
  for (const Row& row : rows) {
    for (const int dimension : {2, 3}) {
      const std::string scene(row.scene);
      if (has_dimension(scene, dimension))
        plan.push_back({scene, dimension, row.boxes, row.moving, row.frames, false});
    }
  }
  return plan;
}

template <typename Value>
std::vector<Value> or_standard(std::vector<Value> values, std::initializer_list<Value> standard) {
  return values.empty() ? std::vector<Value>(standard) : std::move(values);
}

bool moves_by_itself(const Scene& scene, int dimension) {
  return dimension == 2 ? bool(scene.history_2d) : bool(scene.history_3d);
}

}  // namespace

std::vector<CaseRequest> quick_plan() { return plan_from(quick_rows); }

std::vector<CaseRequest> long_plan() { return plan_from(long_rows); }

Effort long_effort() {
  return {.budget_seconds = 60,
          .share_seconds = 1,
          .least_samples = 5,
          .most_samples = 400,
          .single_sample_seconds = 5};
}

std::vector<CaseRequest> plan_of(const Wishes& wishes) {
  const bool named = !wishes.scenes.empty();
  std::vector<std::string> scenes = wishes.scenes;
  if (!named) {
    for (const Scene& scene : lab::scenes()) {
      if (scene.kind == SceneKind::generated) scenes.push_back(scene.name);
    }
  }
  const auto counts = or_standard(wishes.boxes, {standard_boxes});
  const auto dimensions = or_standard(wishes.dimensions, {2, 3});
  const auto fractions = or_standard(wishes.moving, {wishes.frames > 0 ? standard_moving : 0.0});

  std::vector<CaseRequest> plan;
  for (const std::string& name : scenes) {
    const Scene scene = find_scene(name).scene;
    const std::size_t before = plan.size();
    for (const int dimension : dimensions) {
      if (!scene.has_dimension(dimension)) continue;
      const bool moves = moves_by_itself(scene, dimension);
      const std::size_t all =
          scene.kind == SceneKind::file && moves ? std::numeric_limits<std::size_t>::max() : standard_frames;
      const std::size_t frames = wishes.frames > 0 ? wishes.frames : all;
      for (const std::size_t count : counts) {
        for (const double moving : fractions) {
          plan.push_back({name, dimension, scene.fixed_count ? 0 : count, moves ? 0 : moving,
                          moves || moving > 0 ? frames : 0, named});
          if (moves) break;
        }
        if (scene.fixed_count) break;
      }
    }
    if (named && plan.size() == before) {
      throw InvalidSpec("scene '" + name +
                        "' does not exist in the dimensions asked for; expected dimension " +
                        (scene.has_dimension(2) ? "2" : "3"));
    }
  }
  return plan;
}

std::vector<CaseRequest> in_dimensions(std::vector<CaseRequest> plan, std::span<const int> dimensions) {
  std::erase_if(plan, [&](const CaseRequest& request) {
    return std::ranges::find(dimensions, request.dimension) == dimensions.end();
  });
  return plan;
}

}  // namespace broadside::lab
