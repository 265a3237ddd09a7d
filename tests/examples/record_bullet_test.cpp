// The recording that examples/record_bullet leaves behind is the game that it played, as far as it goes.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "examples/record_bullet/game.hpp"
#include "lab/scenes/random.hpp"
#include "recording.hpp"
#include "tests/fuzz/sealed_trace.hpp"

namespace broadside::lab {
namespace {

Boxes boxes_of(const Game& game) {
  Boxes boxes(game.slots());
  for (std::size_t slot = 0; slot < boxes.size(); ++slot) {
    btVector3 min;
    btVector3 max;
    if (game.bounds(slot, min, max)) boxes[slot] = {min.x(), min.y(), min.z(), max.x(), max.y(), max.z()};
  }
  return boxes;
}

/// Where the header ends, and each frame.
std::vector<std::size_t> ends_of(const std::string& bytes) {
  std::vector<std::size_t> ends = {trace::header_bytes};
  const std::size_t bytes_per_box = 4 + 6 * static_cast<std::size_t>(bytes[13]);
  while (ends.back() < bytes.size()) {
    const std::size_t removed = trace_word(bytes, ends.back() + 8);
    const std::size_t set = trace_word(bytes, ends.back() + 12);
    ends.push_back(ends.back() + trace::header_bytes + 4 * removed + bytes_per_box * set +
                   trace::checksum_bytes);
  }
  return ends;
}

TEST(RecordBullet, HoldsEveryFrameOfTheGame) {
  const Played played = play(bytes_of(RECORDING));
  EXPECT_EQ(played.warning, "");
  expect_frames_of_game<Game>(played.frames, boxes_of);
}

TEST(RecordBullet, IsReadUpToTheLastWholeFrameWhereverItIsCutOff) {
  const std::string bytes = bytes_of(RECORDING);
  const std::vector<Boxes> frames = play(bytes).frames;
  const std::vector<std::size_t> ends = ends_of(bytes);
  ASSERT_EQ(ends.back(), bytes.size());
  ASSERT_EQ(ends.size(), frames.size() + 1);
  Random random(7);
  for (int cut = 0; cut < 10; ++cut) {
    const std::size_t size =
        trace::header_bytes + static_cast<std::size_t>(random.below(bytes.size() - trace::header_bytes));
    const Played played = play(bytes.substr(0, size));
    const auto whole = std::ranges::upper_bound(ends, size) - ends.begin() - 1;
    const std::vector<Boxes> expected(frames.begin(), frames.begin() + whole);
    EXPECT_TRUE(played.frames == expected) << "cut off at byte " << size;
    const bool is_between = ends[static_cast<std::size_t>(whole)] == size;
    EXPECT_EQ(played.warning.empty(), is_between) << "cut off at byte " << size << ": " << played.warning;
  }
}

}  // namespace
}  // namespace broadside::lab
