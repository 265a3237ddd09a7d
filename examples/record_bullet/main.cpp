// Records a game on Bullet for Broadside. Usage: example_record_bullet [FILE]
//
// Then: broadside compare FILE
#include <cstdint>
#include <cstdio>

#include <broadside/recorder.hpp>
#include <btBulletDynamicsCommon.h>

#include "game.hpp"

int main(int argc, char** argv) {
  const char* const path = argc > 1 ? argv[1] : "bullet.btrace";
  Game game;
  // Bullet's scalars are floats or doubles; a trace can hold either.
  broadside::Recorder<3, btScalar> recorder;
  recorder.open(path);
  for (int frame = 0; frame < 600; ++frame) {
    game.step();
    for (std::uint32_t slot = 0; slot < game.slots(); ++slot) {
      btVector3 min;
      btVector3 max;
      if (game.bounds(slot, min, max))
        recorder.set(slot, min, max);
      else
        recorder.remove(slot);
    }
    recorder.end_frame();
  }
  if (!recorder.close()) {
    std::fprintf(stderr, "%s\n", recorder.error().c_str());
    return 1;
  }
  std::printf("%s\n", path);
}
