// The cases of a comparison. The two plans are the two lists below.
#include "lab/measure/plan.hpp"

#include <algorithm>
#include <initializer_list>
#include <limits>

#include "broadside/error.hpp"

#include "lab/scenes/scene.hpp"

namespace broadside::lab {
namespace {

constexpr std::size_t default_boxes = 10'000;
constexpr std::size_t standard_frames = 20;
constexpr double default_moving = 0.1;

const std::vector<std::size_t> own_count = {0};  // of a scene with its own number of boxes

/// A part of a plan: all combinations, in those of the dimensions that the scene has.
struct PlanPart {
  std::vector<std::string> scenes;
  std::vector<std::size_t> boxes;
  std::vector<double> moving = {0};
  std::size_t frames = 0;
  std::vector<int> dimensions = {2, 3};
  double left = 0;
  bool filtered = false;
};

/// Sizes from a small game to a large simulation, densities of 1, 4 and 30 neighbours, and more than a third
/// real or recorded boxes. Two cases are joins of two sets, and in two boxes have filters.
std::vector<PlanPart> quick_parts() {
  return {
      {{"uniform"}, {100, 1'000, 10'000, 100'000}},
      {{"uniform"}, {300}, {0}, 0, {2}},
      {{"uniform"}, {3'000}, {0}, 0, {3}},
      {{"uniform:neighbours=1"}, {10'000}, {0}, 0, {3}},
      {{"uniform:neighbours=30"}, {10'000}, {0}, 0, {2}},
      {{"clustered"}, {10'000}, {0}, 0, {2}},
      {{"power_law"}, {10'000}, {0}, 0, {3}},
      {{"bunny", "counties", "counties:boxes=segments", "coastlines", "coastlines:boxes=segments"},
       own_count},
      {{"uniform"}, {10'000}, {0}, 0, {3}, 0.5},
      {{"uniform"}, {1'000}, {0}, 0, {2}, 0, true},
      {{"uniform"}, {10'000}, {0}, 0, {3}, 0, true},
      {{"counties"}, own_count, {0}, 0, {2}, 0.1},
      {{"uniform"}, {10'000}, {0.1}, 10, {2}},
      {{"uniform"}, {1'000}, {1}, 20, {3}},
      {{"box2d_rain", "box2d_tumbler", "box2d_pyramid", "bullet_free_fall", "bullet_moving_gravity"},
       {1'000},
       {0},
       30},
  };
}

std::vector<PlanPart> long_parts() {
  return {
      {{"uniform", "power_law", "mixed", "clustered"}, {1'000, 10'000, 100'000, 1'000'000}},
      {{"one_line", "lattice", "integers", "thin", "terdiman"}, {1'000, 10'000, 100'000}},
      {{"one_point"}, {1'000, 5'000}},
      {{"uniform", "clustered"}, {10'000, 100'000}, {0.01, 0.1, 0.5, 1}, 50},
      {{"churn", "jumps", "pile"}, {1'000, 10'000, 100'000}, {0}, 50},
      {{"box2d_rain", "box2d_tumbler", "box2d_pyramid"}, {1'000, 5'000}, {0}, 60},
      {{"bullet_free_fall", "bullet_brownian", "bullet_moving_gravity"}, {1'000, 5'000}, {0}, 60},
      {{"bunny", "counties", "counties:boxes=segments", "coastlines", "coastlines:boxes=segments"},
       own_count},
      {{"uniform", "clustered"}, {1'000, 10'000, 100'000, 1'000'000}, {0}, 0, {2, 3}, 0.5},
      {{"uniform", "clustered"}, {10'000, 1'000'000}, {0}, 0, {2, 3}, 0.1},
      {{"uniform", "clustered"}, {1'000, 10'000, 100'000}, {0}, 0, {2, 3}, 0, true},
      {{"bunny", "counties", "coastlines:boxes=segments"}, own_count, {0}, 0, {2, 3}, 0.1},
  };
}

/// Whether a scene has this dimension, before it is made. A missing scene is assumed to have both dimensions,
/// so that the comparison reports it.
bool has_dimension(const std::string& scene, int dimension) {
  try {
    return find_scene(scene).scene.has_dimension(dimension);
  } catch (const std::exception&) {
    return dimension == 2;
  }
}

std::vector<CaseRequest> plan_from(const std::vector<PlanPart>& parts) {
  std::vector<CaseRequest> plan;
  for (const PlanPart& part : parts) {
    for (const std::string& scene : part.scenes) {
      for (const std::size_t boxes : part.boxes) {
        for (const double moving : part.moving) {
          for (const int dimension : part.dimensions) {
            if (has_dimension(scene, dimension))
              plan.push_back({.scene = scene,
                              .dimension = dimension,
                              .boxes = boxes,
                              .moving = moving,
                              .frames = part.frames,
                              .left = part.left,
                              .filtered = part.filtered,
                              .required = false});
          }
        }
      }
    }
  }
  return plan;
}

template <typename Value>
std::vector<Value> or_default(std::vector<Value> values, std::initializer_list<Value> default_values) {
  return values.empty() ? std::vector<Value>(default_values) : std::move(values);
}

}  // namespace

bool moves_by_itself(const Scene& scene, int dimension) {
  return dimension == 2 ? bool(scene.history_2d) : bool(scene.history_3d);
}

std::vector<CaseRequest> quick_plan() { return plan_from(quick_parts()); }

Effort quick_effort() { return {.share_seconds = 0.05, .case_seconds = 3.5}; }

std::vector<CaseRequest> long_plan() { return plan_from(long_parts()); }

Effort long_effort() {
  return {.budget_seconds = 30,
          .history_seconds = 30,
          .share_seconds = 1,
          .min_rounds = 7,
          .max_rounds = 400,
          .slow_seconds = 5,
          .slow_history_seconds = 5,
          .slow_rounds = 5};
}

std::vector<CaseRequest> plan_of(const ComparePlanOptions& options) {
  const bool named = !options.scenes.empty();
  std::vector<std::string> scenes = options.scenes;
  if (!named) {
    for (const Scene& scene : lab::scenes()) {
      if (scene.kind == SceneKind::generated && !scene.hard) scenes.push_back(scene.name);
    }
  }
  const auto counts = or_default(options.boxes, {default_boxes});
  const auto dimensions = or_default(options.dimensions, {2, 3});
  const auto fractions = or_default(options.moving, {options.frames > 0 ? default_moving : 0.0});

  std::vector<CaseRequest> plan;
  for (const std::string& name : scenes) {
    const Scene scene = options.find(name).scene;
    const auto exists = [&scene](int dimension) { return scene.has_dimension(dimension); };
    if (named && std::ranges::none_of(dimensions, exists)) {
      throw InvalidSpec("scene '" + name +
                        "' does not exist in the dimensions asked for; expected dimension " +
                        (scene.has_dimension(2) ? "2" : "3"));
    }
    for (const int dimension : dimensions) {
      if (!exists(dimension)) continue;
      const bool moves = moves_by_itself(scene, dimension);
      const bool is_still = options.left > 0 || options.filtered;
      const std::size_t all =
          scene.kind == SceneKind::file && moves ? std::numeric_limits<std::size_t>::max() : standard_frames;
      const std::size_t frames = options.frames > 0 ? options.frames : all;
      for (const std::size_t count : counts) {
        for (const double moving : fractions) {
          const CaseRequest request{.scene = name,
                                    .dimension = dimension,
                                    .boxes = scene.fixed_count ? 0 : count,
                                    .moving = moves || is_still ? 0 : moving,
                                    .frames = !is_still && (moves || moving > 0) ? frames : 0,
                                    .left = options.left,
                                    .filtered = options.filtered,
                                    .drift = options.drift,
                                    .teleport = options.teleport,
                                    .required = named};
          if (std::ranges::find(plan, request) == plan.end()) plan.push_back(request);
          if (moves) break;
        }
        if (scene.fixed_count) break;
      }
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
