// Recordings with pairs, for tests of their analysis.
#pragma once

#include <cstddef>
#include <string>

#include "broadside/recorder.hpp"

namespace broadside {

/// A recording in 2D of six frames. Box 0 is the ground; box 1 falls onto it, touches it in frames 3 and 4,
/// and is 2 above it in frame 5; box 2 is far away. `report(recorder, frame)` records the engine's pairs.
template <typename Report>
std::string falling_box(const Report& report, double margin = 0.25) {
  std::string bytes;
  Recorder2 recorder;
  recorder.open_with(
      [&](const void* more, std::size_t count) {
        bytes.append(static_cast<const char*>(more), count);
        return true;
      },
      margin);
  const auto set = [&](std::uint32_t slot, float x, float y, float width) {
    const float min[] = {x, y};
    const float max[] = {x + width, y + 1};
    recorder.set(slot, min, max);
  };
  std::size_t frame = 0;
  for (const float height : {4.0F, 3.0F, 2.0F, 1.0F, 1.0F, 3.0F}) {
    set(0, -5, 0, 10);
    set(1, 0, height, 1);
    set(2, 20, 0, 1);
    report(recorder, frame++);
    recorder.end_frame();
  }
  recorder.close();
  return bytes;
}

/// Correct reports of an engine.
inline void report_rightly(Recorder2& recorder, std::size_t frame) {
  if (frame == 3 || frame == 4) recorder.add_pair(1, 0);
}

}  // namespace broadside
