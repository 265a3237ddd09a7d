// What stands in for the recordings of Box2D where it was missing at configure time.
#include "lab/recordings/recordings.hpp"

namespace broadside::lab::recordings {

std::vector<Scene> box2d() {
  std::vector<Scene> scenes;
  for (const char* name : {"box2d_rain", "box2d_tumbler", "box2d_pyramid"})
    scenes.push_back(
        {.name = name,
         .summary = "",
         .source = "Box2D",
         .kind = SceneKind::recorded,
         .missing = "libbox2d-dev was missing at configure time; install it and configure again"});
  return scenes;
}

}  // namespace broadside::lab::recordings
