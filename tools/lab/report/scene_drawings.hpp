// The scenes of a report, drawn with what our own algorithms and the paper's lay over them.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "lab/catalogue.hpp"
#include "lab/measure/compare.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// A scene that is to be drawn.
struct SceneToDraw {
  std::string scene;  ///< as a spec
  int dimension = 2;
  std::size_t boxes = 0;  ///< that it is said to have
};

/// The scenes of a comparison, each once in a dimension, with the most boxes that it had.
std::vector<SceneToDraw> scenes_of(const Comparison& comparison);

/// A list of scenes as JSON, as lab/report/drawing.hpp draws them, in some milliseconds each. Layers are
/// those of the entries that are our own or the paper's and lay something over the boxes. Scenes that
/// cannot be made are left out; so are those that come when the list has grown to some 1.2 MB, that pages
/// stay small.
std::string drawings_of(std::span<const SceneToDraw> scenes, const FindScene& find,
                        std::span<const Entry> entries);

}  // namespace broadside::lab
