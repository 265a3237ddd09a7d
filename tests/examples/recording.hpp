// What the tests of recorded games share: the boxes of a game, and those of its recording.
#pragma once

#include <cstddef>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "lab/formats/trace/trace.hpp"
#include "tests/support/text_of.hpp"

namespace broadside::lab {

/// The bounds of the box in each slot, minima before maxima; empty where there is none.
using Boxes = std::vector<std::vector<double>>;

/// What was read of a recording.
struct Played {
  std::vector<Boxes> frames;
  std::string warning;
};

inline std::string bytes_of(const std::string& path) {
  EXPECT_TRUE(std::filesystem::exists(path)) << path << " is missing; ctest has it made by the example";
  return text_of(path);
}

inline Played play(const std::string& bytes) {
  Played played;
  std::istringstream stream(bytes);
  TraceReader reader(stream, "recording");
  const auto dimension = static_cast<std::size_t>(reader.dimension());
  Boxes boxes;
  while (reader.next_frame()) {
    boxes.resize(reader.slots());
    for (std::size_t i = 0; i < reader.changed().size(); ++i) {
      const std::span<const double> bounds = reader.bounds(i);
      const bool is_empty = bounds[0] > bounds[dimension];
      boxes[index(reader.changed()[i])].assign(bounds.begin(), is_empty ? bounds.begin() : bounds.end());
    }
    played.frames.push_back(boxes);
  }
  played.warning = reader.warning();
  return played;
}

/// Steps a game of the same kind alongside: it must have had the boxes of every frame, and boxes must have
/// come, gone and rested. `boxes_of` tells a game's boxes.
template <typename Game, typename BoxesOf>
void expect_frames_of_game(const std::vector<Boxes>& frames, BoxesOf boxes_of) {
  ASSERT_EQ(frames.size(), 600u);
  Game game;
  std::size_t came = 0;
  std::size_t went = 0;
  std::size_t rested = 0;
  Boxes before;
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    game.step();
    const Boxes now = boxes_of(game);
    ASSERT_EQ(frames[frame], now) << "frame " << frame;
    before.resize(now.size());
    for (std::size_t slot = 0; slot < now.size(); ++slot) {
      came += before[slot].empty() && !now[slot].empty() ? 1 : 0;
      went += !before[slot].empty() && now[slot].empty() ? 1 : 0;
      rested += !now[slot].empty() && before[slot] == now[slot] ? 1 : 0;
    }
    before = now;
  }
  EXPECT_GT(came, frames.back().size()) << "slots are used again";
  EXPECT_GT(went, 10u);
  EXPECT_GT(rested, frames.size());
}

}  // namespace broadside::lab
