// Records a game on Box2D for Broadside. Usage: example_record_box2d [FILE]
//
// Then: broadside compare FILE
#include <cstdint>
#include <cstdio>

#include <box2d/box2d.h>
#include <broadside/recorder.hpp>

#include "game.hpp"

int main(int argc, char** argv) {
  const char* const path = argc > 1 ? argv[1] : "box2d.btrace";
  Game game;
  broadside::Recorder2 recorder;
  recorder.open(path);
  for (int frame = 0; frame < 600; ++frame) {
    game.step();
    for (std::uint32_t slot = 0; slot < game.slots(); ++slot) {
      b2AABB box;
      if (game.bounds(slot, box))
        recorder.set(slot, &box.lowerBound.x, &box.upperBound.x);
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
