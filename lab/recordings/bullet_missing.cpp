// What stands in for the recordings of Bullet where it was missing at configure time.
#include "lab/recordings/recordings.hpp"

namespace broadside::lab::recordings {

std::vector<Scene> bullet() {
  std::vector<Scene> scenes;
  for (const char* name : {"bullet_free_fall", "bullet_brownian", "bullet_moving_gravity"})
    scenes.push_back(
        {.name = name,
         .summary = "",
         .source = "Bullet",
         .kind = SceneKind::recorded,
         .missing = "libbullet-dev was missing at configure time; install it and configure again"});
  return scenes;
}

}  // namespace broadside::lab::recordings
