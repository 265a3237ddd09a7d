// Broadmark's .aabbs (Serpa and Rodrigues 2019): every box of every frame, in little-endian binary.
//
// Scene name char[128], object type char[128], i32 boxes N, i32 steps F, two i32 = 0, the world's bounds,
// then (F + 1) x N bounds. Bounds are eight f32: min x y z 0, max x y z 0.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <ostream>

#include <fmt/format.h>

#include "lab/readers/descriptions.hpp"

namespace broadside::lab::readers {
namespace {

constexpr std::size_t name_bytes = 128;
constexpr std::size_t bounds_bytes = 32;
constexpr std::size_t header_bytes = 2 * name_bytes + 16 + bounds_bytes;

std::uint32_t read_word(const char* bytes) {
  std::uint32_t word = 0;
  for (int i = 3; i >= 0; --i) word = word << 8 | static_cast<unsigned char>(bytes[i]);
  return word;
}

void append_word(std::string& bytes, std::uint32_t word) {
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(word >> 8 * i & 0xff);
}

Box3 read_bounds(const char* bytes) {
  Box3 box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::bit_cast<float>(read_word(bytes + 4 * axis));
    box.max[axis] = std::bit_cast<float>(read_word(bytes + 4 * axis + bounds_bytes / 2));
  }
  return box;
}

template <int D>
void append_bounds(std::string& bytes, const Box<D>& box) {
  for (const std::array<float, D>& corner : {box.min, box.max}) {
    for (int axis = 0; axis < 4; ++axis)
      append_word(bytes, std::bit_cast<std::uint32_t>(axis < D ? corner[axis] : 0.0F));
  }
}

/// N and F, checked against the file's size before anything is allocated for them.
struct Counts {
  std::uint32_t boxes;
  std::uint32_t steps;
};

Counts read_counts(Input& input) {
  const std::string_view bytes = input.bytes();
  const std::uintmax_t size = bytes.size();
  if (size < header_bytes) {
    throw FileError(
        fmt::format("{}: has {} bytes; expected a header of {} bytes", input.name(), size, header_bytes));
  }
  const Counts counts = {read_word(&bytes[2 * name_bytes]), read_word(&bytes[2 * name_bytes + 4])};
  constexpr std::uint32_t most = std::numeric_limits<std::int32_t>::max();
  if (counts.boxes > most || counts.steps > most) {
    throw FileError(fmt::format("{}: claims {} boxes and {} steps; expected neither to be negative",
                                input.name(), static_cast<std::int32_t>(counts.boxes),
                                static_cast<std::int32_t>(counts.steps)));
  }
  const std::uintmax_t bounds = std::uintmax_t{counts.boxes} * (std::uintmax_t{counts.steps} + 1);
  // Compared as numbers of bounds: in bytes, the claim may be more than 64 bits can say.
  const std::uintmax_t rest = size - header_bytes;
  if (rest % bounds_bytes != 0 || rest / bounds_bytes != bounds) {
    throw FileError(fmt::format(
        "{}: has {} bytes and claims {} boxes and {} steps; expected {} + {} x boxes x (steps + 1) bytes",
        input.name(), size, counts.boxes, counts.steps, header_bytes, bounds_bytes));
  }
  // Without boxes the size bounds no number of steps.
  return {counts.boxes, counts.boxes == 0 ? 0 : counts.steps};
}

std::vector<Box3> read_frame(Input& input, std::size_t count, std::size_t frame) {
  const std::size_t begin = header_bytes + frame * count * bounds_bytes;
  std::vector<Box3> boxes(count);
  for (std::size_t i = 0; i < count; ++i) {
    boxes[i] = read_bounds(&input.bytes()[begin + i * bounds_bytes]);
    if (is_present(boxes[i])) continue;
    throw FileError(
        fmt::format("{}: frame {}, box {} has min ({}) and max ({}); expected numbers with min <= max",
                    input.name(), frame, i, fmt::join(boxes[i].min, ", "), fmt::join(boxes[i].max, ", ")));
  }
  input.passed(begin + count * bounds_bytes);
  return boxes;
}

/// Whether every box lies in the plane z = 0, as when a 2D history was written.
bool is_flat(const History<3>& history) {
  const auto flat = [](const Box3& box) { return box.min[2] == 0 && box.max[2] == 0; };
  return !history.boxes.empty() && std::ranges::all_of(history.boxes, flat) &&
         std::ranges::all_of(history.steps,
                             [&](const Step<3>& step) { return std::ranges::all_of(step.boxes, flat); });
}

AnyFrameReader open(std::unique_ptr<Input> input, const ReadOptions& options) {
  const Counts counts = read_counts(*input);
  History<3> history{read_frame(*input, counts.boxes, 0), {}};
  std::vector<Box3> before = history.boxes;
  for (std::uint32_t frame = 1; frame <= counts.steps; ++frame) {
    std::vector<Box3> now = read_frame(*input, counts.boxes, frame);
    Step<3> step{now.size(), {}, {}};
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (now[i] == before[i]) continue;
      step.changed.push_back(BoxId(i));
      step.boxes.push_back(now[i]);
    }
    history.steps.push_back(std::move(step));
    before = std::move(now);
  }
  const bool flat = options.dimension != 3 && is_flat(history);
  AnyFrameReader frames = std::make_unique<HistoryReader<3, float>>(std::move(history));
  return flat ? flattened(std::move(frames)) : std::move(frames);
}

/// Calls `visit` with the boxes of each frame.
template <int D, typename Visit>
void for_each_frame(const History<D>& history, Visit visit) {
  std::vector<Box<D>> boxes = history.boxes;
  visit(std::size_t{0}, boxes);
  for (std::size_t frame = 1; frame <= history.steps.size(); ++frame) {
    lab::apply(history.steps[frame - 1], boxes);
    visit(frame, boxes);
  }
}

template <int D>
void write(const History<D>& history, std::ostream& stream) {
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
  const std::size_t count = history.boxes.size();
  if (count > most || history.steps.size() > most)
    throw FileError(fmt::format("{} boxes and {} steps; expected at most {} in an .aabbs file", count,
                                history.steps.size(), most));

  Box<D> world = absent_box<D>();
  for_each_frame(history, [&](std::size_t frame, const std::vector<Box<D>>& boxes) {
    if (boxes.size() != count)
      throw FileError(fmt::format(
          "frame {} has {} boxes and the first {}; expected as many in every frame of an .aabbs file", frame,
          boxes.size(), count));
    for (std::size_t i = 0; i < count; ++i) {
      if (!is_present(boxes[i]))
        throw FileError(fmt::format(
            "frame {}, box {} is absent; expected every box of an .aabbs file to be there", frame, i));
      for (int axis = 0; axis < D; ++axis) {
        world.min[axis] = std::min(world.min[axis], boxes[i].min[axis]);
        world.max[axis] = std::max(world.max[axis], boxes[i].max[axis]);
      }
    }
  });

  std::string bytes = "Broadside";
  bytes.resize(name_bytes);
  bytes += "Box";
  bytes.resize(2 * name_bytes);
  append_word(bytes, static_cast<std::uint32_t>(count));
  append_word(bytes, static_cast<std::uint32_t>(history.steps.size()));
  append_word(bytes, 0);
  append_word(bytes, 0);
  append_bounds(bytes, count > 0 ? world : Box<D>{});
  for_each_frame(history, [&](std::size_t, const std::vector<Box<D>>& boxes) {
    for (const Box<D>& box : boxes) append_bounds(bytes, box);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.clear();
  });
}

/// The header tells how many frames there are: all are kept until the last one is known.
template <int D>
class BroadmarkWriter final : public FrameWriter<D, float> {
 public:
  explicit BroadmarkWriter(std::ostream& stream) : stream_(stream) {}

  void first(std::span<const Box<D>> boxes) override { history_.boxes.assign(boxes.begin(), boxes.end()); }
  void next(const Step<D>& step) override { history_.steps.push_back(step); }
  void finish() override { write(history_, stream_); }

 private:
  std::ostream& stream_;
  History<D> history_;
};

AnyFrameWriter create(std::ostream& stream, int dimension, Precision precision) {
  if (precision != Precision::float32)
    throw FileError("boxes of doubles; expected floats, which is what an .aabbs file holds");
  if (dimension == 2) return std::make_unique<BroadmarkWriter<2>>(stream);
  return std::make_unique<BroadmarkWriter<3>>(stream);
}

}  // namespace

Format broadmark() {
  return {
      .name = "broadmark",
      .summary = "Broadmark's frames of boxes",
      .extensions = {".aabbs"},
      .recognises = [](std::string_view, std::string_view extension) { return extension == ".aabbs"; },
      .open = open,
      .create = create,
      .has_doubles = false,
  };
}

}  // namespace broadside::lab::readers
