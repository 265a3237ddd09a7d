// The cases of a comparison: the quick plan, the long plan, and the cases that a user asks for.
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
  std::string scene;  ///< a spec, or the path of a file
  int dimension = 2;
  std::size_t boxes = 0;   ///< ignored by a scene with its own number of boxes
  double moving = 0;       ///< the fraction that moves; 0 for a scene with its own motion
  std::size_t frames = 0;  ///< 0: a still scene
  double left = 0;  ///< not 0: search between two sets; this fraction, drawn at random, is the left one
  /// Whether boxes get the filters of a game: a third of them, drawn at random, is static, a third bodies, a
  /// sixth debris, which ignores its like and sensors, and a sixth sensors, which see bodies alone. Two
  /// thirds of the overlapping pairs are left.
  bool filtered = false;
  double drift = SceneRequest{}.drift;        ///< as in SceneRequest
  double teleport = SceneRequest{}.teleport;  ///< likewise
  bool required = true;                       ///< whether it is an error if the scene does not exist

  bool operator==(const CaseRequest&) const = default;
};

/// Whether the scene has its own motion in that dimension.
bool moves_by_itself(const Scene& scene, int dimension);

/// The cases of `make compare`, and the effort for each: a minute and a half with all algorithms.
std::vector<CaseRequest> quick_plan();
Effort quick_effort();

/// The cases of `make bench`, and the effort for each.
std::vector<CaseRequest> long_plan();
Effort long_effort();

/// The cases that a user asks for. An empty list means its default: every generated scene, 10,000 boxes, both
/// dimensions, at rest.
struct ComparePlanOptions {
  std::vector<std::string> scenes{};
  std::vector<std::size_t> boxes{};
  std::vector<int> dimensions{};
  std::vector<double> moving{};
  double left = 0;         ///< as in CaseRequest; only the first frame of scenes that move is then searched
  bool filtered = false;   ///< likewise
  std::size_t frames = 0;  ///< 0: 20 if boxes are set moving, all if they move in a file
  double drift = SceneRequest{}.drift;
  double teleport = SceneRequest{}.teleport;
  FindScene find = [](std::string_view text) { return find_scene(text); };
};

/// All combinations that exist. Leaves out dimensions that a scene does not have, and numbers or moving
/// fractions for scenes with their own. Throws InvalidSpec if a scene is unknown or has none of the
/// dimensions, and the exceptions of a file's reader.
std::vector<CaseRequest> plan_of(const ComparePlanOptions& options);

/// The cases of `plan` in one of the dimensions.
std::vector<CaseRequest> in_dimensions(std::vector<CaseRequest> plan, std::span<const int> dimensions);

}  // namespace broadside::lab
