// Motion recorded by running physics engines.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/scenes/scene.hpp"

namespace broadside::lab::recordings {

/// Three scenes of Box2D, in 2D. Without Box2D in this build, the scenes say so and make nothing.
std::vector<Scene> box2d();

/// Broadmark's three scenes, in Bullet, in 3D; likewise.
std::vector<Scene> bullet();

/// The history of `world.boxes()` over `frames` steps, after `warm_up` calls of world.step(). Throws
/// std::runtime_error if the engine gives an invalid box.
template <int D, typename World>
History<D> record(World& world, std::size_t warm_up, std::size_t frames) {
  const auto boxes_at = [&world](std::size_t step) {
    std::vector<Box<D>> boxes = world.boxes();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (is_present(boxes[i])) continue;
      throw std::runtime_error(fmt::format(
          "recording: the engine's box {} after step {} has min ({}) and max ({}); expected min <= max", i,
          step, fmt::join(boxes[i].min, ", "), fmt::join(boxes[i].max, ", ")));
    }
    return boxes;
  };
  for (std::size_t i = 0; i < warm_up; ++i) world.step();

  return history_of_frames<D>(frames, [&](std::size_t frame) {
    if (frame > 0) world.step();
    return boxes_at(warm_up + frame);
  });
}

}  // namespace broadside::lab::recordings
