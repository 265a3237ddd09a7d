// Draws the scenes of a report, with the structures of Broadside's algorithms and the paper's.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "lab/catalogue.hpp"
#include "lab/measure/compare.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// A scene to draw.
struct SceneToDraw {
  std::string scene;  ///< a spec
  int dimension = 2;
  std::size_t boxes = 0;  ///< the number to state
};

/// The scenes of a comparison, each once per dimension, with the maximum number of boxes it was measured
/// with.
std::vector<SceneToDraw> scenes_of(const Comparison& comparison);

/// A list of scenes as JSON, as made by lab/report/drawing.hpp, in a few milliseconds each. Layers are those
/// of Broadside's or the paper's entries that have an outline. Leaves out scenes that cannot be made, and
/// those that come after the list has grown to about 1.2 MB, so that pages stay small.
std::string drawings_of(std::span<const SceneToDraw> scenes, const FindScene& find,
                        std::span<const Entry> entries);

}  // namespace broadside::lab
