// The recording that examples/record_box2d leaves behind is the game that it played.
#include <cstddef>

#include <gtest/gtest.h>

#include "examples/record_box2d/game.hpp"
#include "recording.hpp"

namespace broadside::lab {
namespace {

Boxes boxes_of(const Game& game) {
  Boxes boxes(game.slots());
  for (std::size_t slot = 0; slot < boxes.size(); ++slot) {
    b2AABB box;
    if (game.bounds(slot, box))
      boxes[slot] = {box.lowerBound.x, box.lowerBound.y, box.upperBound.x, box.upperBound.y};
  }
  return boxes;
}

TEST(RecordBox2d, HoldsEveryFrameOfTheGame) {
  const Played played = play(bytes_of(RECORDING));
  EXPECT_EQ(played.warning, "");
  expect_frames_of_game<Game>(played.frames, boxes_of);
}

}  // namespace
}  // namespace broadside::lab
