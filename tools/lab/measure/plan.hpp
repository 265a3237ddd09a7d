// Which cases a comparison consists of: the quick plan, the long one, and those a user asks for.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lab/measure/measurement.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// A case to measure.
struct CaseRequest {
  std::string scene;  ///< as a spec, or the path of a file
  int dimension = 2;
  std::size_t boxes = 0;                      ///< ignored by a scene that has a count of its own
  double moving = 0;                          ///< the fraction that moves, 0 for a scene that moves by itself
  std::size_t frames = 0;                     ///< 0: still
  double drift = SceneRequest{}.drift;        ///< as in SceneRequest
  double teleport = SceneRequest{}.teleport;  ///< likewise
  bool required = true;                       ///< whether it is an error if the scene is not there

  bool operator==(const CaseRequest&) const = default;
};

/// Whether the scene moves by itself in that dimension.
bool moves_by_itself(const Scene& scene, int dimension);

/// The cases of `make compare`: four and a half minutes on two cores, with all algorithms.
std::vector<CaseRequest> quick_plan();

/// The cases of `make bench`, and the effort each is worth.
std::vector<CaseRequest> long_plan();
Effort long_effort();

/// What a user asks for. An empty list stands for its default: every generated scene, 10,000 boxes, both
/// dimensions, still.
struct ComparePlanOptions {
  std::vector<std::string> scenes{};
  std::vector<std::size_t> boxes{};
  std::vector<int> dimensions{};
  std::vector<double> moving{};
  std::size_t frames = 0;  ///< 0: 20 where boxes move, all where they move in a file
  double drift = SceneRequest{}.drift;
  double teleport = SceneRequest{}.teleport;
  FindScene find = [](std::string_view text) { return find_scene(text); };
};

/// Every combination that exists; others are left out: a dimension that a scene does not have, a count or a
/// moving fraction where the scene has its own. Throws InvalidSpec if a scene is unknown or has none of the
/// dimensions, and what a file's reader throws.
std::vector<CaseRequest> plan_of(const ComparePlanOptions& options);

/// The cases of `plan` in one of the dimensions.
std::vector<CaseRequest> in_dimensions(std::vector<CaseRequest> plan, std::span<const int> dimensions);

}  // namespace broadside::lab
