// A recorder that keeps its trace in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/recorder.hpp"

namespace broadside {

template <int D, typename Real = float>
struct Tape {
  Tape() { recorder.open_with(write()); }

  /// A tape that also records pairs.
  explicit Tape(double margin) { recorder.open_with(write(), margin); }

  bool set(std::uint32_t slot, const std::vector<Real>& box) {
    return recorder.set(slot, box.data(), box.data() + D);
  }

  /// Ends the frame and returns its number of bytes.
  std::size_t end_frame() {
    const std::size_t before = bytes.size();
    EXPECT_TRUE(recorder.end_frame());
    ends.push_back(bytes.size());
    return bytes.size() - before;
  }

  std::string bytes;
  std::vector<std::size_t> ends;  // of each frame
  Recorder<D, Real> recorder;

 private:
  typename Recorder<D, Real>::Write write() {
    return [this](const void* more, std::size_t count) {
      bytes.append(static_cast<const char*>(more), count);
      return true;
    };
  }
};

/// Header at byte 0; frame 0 at byte 20, in which slots 0 and 2 get boxes and slot 1 is empty; frame 1 at
/// byte 88, in which slot 0 moves and slot 2 becomes empty. The example of docs/trace-format.md.
inline std::string small_trace() {
  Tape<2> tape;
  tape.set(0, {0, 0, 1, 1});
  tape.set(2, {2, 0.5F, 4, 3});
  tape.end_frame();
  tape.set(0, {0.25F, 0, 1.25F, 1});
  tape.recorder.remove(2);
  tape.end_frame();
  return tape.bytes;
}

/// With margin 0.5: header at byte 0; frame 0 at byte 28, in which slot 0 gets a filter (byte 128), the pairs
/// (0, 1) and (1, 2) are reported (bytes 156 and 164) and (0, 2) is ignored (byte 172); frame 1 at byte 184,
/// in which slot 1 moves, the pair (0, 1) is no longer reported and (1, 2) twice. The example with pairs of
/// docs/trace-format.md.
inline std::string small_trace_with_pairs() {
  Tape<2> tape(0.5);
  tape.set(0, {0, 0, 1, 1});
  tape.set(1, {1, 0, 2, 1});
  tape.set(2, {1, 1, 3, 2});
  tape.recorder.set_filter(0, 2, 5, -1, true);
  tape.recorder.add_pair(2, 1);
  tape.recorder.add_pair(0, 1);
  tape.recorder.ignore_pair(0, 2);
  tape.end_frame();
  tape.set(1, {2, 0, 3, 1});
  tape.recorder.add_pair(1, 2);
  tape.recorder.add_pair(1, 2);
  tape.end_frame();
  return tape.bytes;
}

}  // namespace broadside
