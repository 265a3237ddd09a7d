// Scenes of real motion, recorded by running physics engines headless. Engines' headers are seen only here.
#pragma once

#include <vector>

#include "lab/scenes/scene.hpp"

namespace broadside::lab::recordings {

/// Three scenes of Box2D's, in 2D. Where it was missing when this was built, they say so and make nothing.
std::vector<Scene> box2d();

/// Broadmark's three scenes, in Bullet, in 3D; likewise.
std::vector<Scene> bullet();

}  // namespace broadside::lab::recordings
