// Fuzzes the reader of traces: whatever the bytes, it reads or refuses them, and what it reads can be
// recorded and read again.
#include <cstdint>
#include <cstdlib>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "broadside/recorder.hpp"

#include "lab/formats/format.hpp"
#include "lab/formats/trace/trace.hpp"
#include "tests/fuzz/sealed_trace.hpp"

namespace broadside::lab {
namespace {

/// Ends the program, which is how a fuzzer learns of a fault.
void expect(bool holds) {
  if (!holds) std::abort();
}

using Bounds = std::vector<double>;

/// The boxes of each frame as they came from the file; those that were removed are absent ones.
struct Played {
  int dimension = 0;
  int coordinate_bytes = 0;
  std::vector<std::vector<Bounds>> frames;
};

/// As many frames as are kept: enough for what can go wrong, in little memory.
constexpr std::size_t max_frames = 50;

Played play(const std::string& bytes) {
  Played played;
  try {
    std::istringstream stream(bytes);
    TraceReader reader(stream, "fuzz");
    played.dimension = reader.dimension();
    played.coordinate_bytes = reader.coordinate_bytes();
    std::vector<Bounds> boxes;
    while (reader.next_frame()) {
      // The memory that a claim takes is paid for in bytes.
      expect(4 * std::uint64_t{reader.slots()} <= bytes.size());
      const std::size_t before = boxes.size();
      boxes.resize(reader.slots());
      for (std::size_t i = 0; i < reader.changed().size(); ++i) {
        const std::span<const double> bounds = reader.bounds(i);
        boxes.at(index(reader.changed()[i])).assign(bounds.begin(), bounds.end());
      }
      for (std::size_t slot = before; slot < boxes.size(); ++slot) expect(!boxes[slot].empty());
      if (played.frames.size() < max_frames) played.frames.push_back(boxes);
    }
  } catch (const FileError&) {
    // Refused: the frames before were right.
  }
  return played;
}

template <int D, typename Real>
std::string record(const Played& played) {
  std::string bytes;
  Recorder<D, Real> recorder;
  recorder.open_with([&](const void* more, std::size_t count) {
    bytes.append(static_cast<const char*>(more), count);
    return true;
  });
  for (const std::vector<Bounds>& frame : played.frames) {
    std::vector<Real> boxes;
    for (const Bounds& box : frame) {
      for (const double bound : box) boxes.push_back(static_cast<Real>(bound));
    }
    recorder.set_boxes(boxes.data(), frame.size());
    recorder.end_frame();
  }
  expect(recorder.close());
  return bytes;
}

std::string record(const Played& played) {
  const bool is_float = played.coordinate_bytes == 4;
  if (played.dimension == 2) return is_float ? record<2, float>(played) : record<2, double>(played);
  return is_float ? record<3, float>(played) : record<3, double>(played);
}

void check(const std::string& bytes) {
  const Played played = play(bytes);
  if (!played.frames.empty()) expect(play(record(played)).frames == played.frames);
}

}  // namespace
}  // namespace broadside::lab

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  broadside::lab::check(bytes);
  // Few random bytes have the right checksums: what lies behind them is tried as well.
  broadside::lab::check(broadside::lab::sealed_trace(bytes));
  return 0;
}
