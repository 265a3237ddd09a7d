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
#include <utility>

#include <fmt/format.h>

#include "lab/formats/descriptions.hpp"
#include "lab/formats/late_header.hpp"

namespace broadside::lab::readers {
namespace {

constexpr std::size_t name_bytes = 128;
constexpr std::size_t bounds_bytes = 32;
constexpr std::size_t header_bytes = 2 * name_bytes + 16 + bounds_bytes;
constexpr std::uint32_t most_of_anything = std::numeric_limits<std::int32_t>::max();

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
  if (counts.boxes > most_of_anything || counts.steps > most_of_anything) {
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

/// Whether every box of every frame lies in the plane z = 0, as when boxes in 2D were written.
bool is_flat(std::string_view bytes) {
  for (std::size_t at = header_bytes; at < bytes.size(); at += bounds_bytes) {
    const Box3 box = read_bounds(&bytes[at]);
    if (box.min[2] != 0 || box.max[2] != 0) return false;
  }
  return bytes.size() > header_bytes;
}

class BroadmarkFrames final : public FrameReader<3, float> {
 public:
  BroadmarkFrames(std::unique_ptr<Input> input, Counts counts) : input_(std::move(input)), counts_(counts) {}

  std::vector<Box3> first() override {
    boxes_.reserve(counts_.boxes);
    for (std::size_t i = 0; i < counts_.boxes; ++i) boxes_.push_back(box(i));
    return boxes_;
  }

  bool next(Step<3, float>& step) override {
    if (frame_ == counts_.steps) return false;
    ++frame_;
    step = {boxes_.size(), {}, {}};
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const Box3 now = box(i);
      if (now == boxes_[i]) continue;
      boxes_[i] = now;
      step.changed.push_back(BoxId(i));
      step.boxes.push_back(now);
    }
    return true;
  }

 private:
  /// A box of the frame that is being read.
  Box3 box(std::size_t i) {
    const std::size_t at = header_bytes + (frame_ * counts_.boxes + i) * bounds_bytes;
    const Box3 box = read_bounds(&input_->bytes()[at]);
    if (!is_present(box))
      throw FileError(
          fmt::format("{}: frame {}, box {} has min ({}) and max ({}); expected numbers with min <= max",
                      input_->name(), frame_, i, fmt::join(box.min, ", "), fmt::join(box.max, ", ")));
    input_->passed(at);
    return box;
  }

  std::unique_ptr<Input> input_;
  Counts counts_;
  std::size_t frame_ = 0;
  std::vector<Box3> boxes_;  // of that frame
};

AnyFrameReader open_broadmark(std::unique_ptr<Input> input, const ReadOptions& options) {
  const Counts counts = read_counts(*input);
  const bool flat = options.dimension != 3 && is_flat(input->bytes());
  AnyFrameReader frames = std::make_unique<BroadmarkFrames>(std::move(input), counts);
  return flat ? flattened(std::move(frames)) : std::move(frames);
}

/// The header tells how many frames there are and what bounds them all: it is written last.
template <int D>
class BroadmarkWriter final : public FrameWriter<D, float> {
 public:
  explicit BroadmarkWriter(std::ostream& stream) : file_(stream, header_bytes) {}

  void first(std::span<const Box<D>> boxes) override {
    if (boxes.size() > most_of_anything)
      throw FileError(
          fmt::format("{} boxes; expected at most {} in an .aabbs file", boxes.size(), most_of_anything));
    for (std::size_t i = 0; i < boxes.size(); ++i) take(BoxId(i), boxes[i]);
    boxes_.assign(boxes.begin(), boxes.end());
    write_frame();
  }

  void next(const Step<D>& step) override {
    if (frame_ == most_of_anything)
      throw FileError(fmt::format("more steps; expected at most {} in an .aabbs file", most_of_anything));
    ++frame_;
    if (step.size != boxes_.size())
      throw FileError(fmt::format(
          "frame {} has {} boxes and the first {}; expected as many in every frame of an .aabbs file", frame_,
          step.size, boxes_.size()));
    for (std::size_t i = 0; i < step.changed.size(); ++i) take(step.changed[i], step.boxes[i]);
    lab::apply(step, boxes_);
    write_frame();
  }

  void finish() override {
    std::string header = "Broadside";
    header.resize(name_bytes);
    header += "Box";
    header.resize(2 * name_bytes);
    append_word(header, static_cast<std::uint32_t>(boxes_.size()));
    append_word(header, static_cast<std::uint32_t>(frame_));
    append_word(header, 0);
    append_word(header, 0);
    append_bounds(header, boxes_.empty() ? Box<D>{} : world_);
    file_.finish(header);
  }

 private:
  void take(BoxId id, const Box<D>& box) {
    if (!is_present(box))
      throw FileError(fmt::format(
          "frame {}, box {} is absent; expected every box of an .aabbs file to be there", frame_, index(id)));
    world_ = merged(world_, box);
  }

  void write_frame() {
    std::string bytes;
    bytes.reserve(boxes_.size() * bounds_bytes);
    for (const Box<D>& box : boxes_) append_bounds(bytes, box);
    file_.write(bytes);
  }

  LateHeader file_;
  std::size_t frame_ = 0;
  std::vector<Box<D>> boxes_;  // of that frame
  Box<D> world_ = absent_box<D>();
};

AnyFrameWriter create_broadmark(std::ostream& stream, int dimension, Precision precision) {
  if (precision != Precision::float32)
    throw FileError("boxes of doubles; expected floats, which is what an .aabbs file holds");
  if (dimension == 2) return std::make_unique<BroadmarkWriter<2>>(stream);
  return std::make_unique<BroadmarkWriter<3>>(stream);
}

/// A header has no magic bytes: but two names that end in zeros, two counts, two zeros, and bounds.
bool is_broadmark(std::string_view bytes, std::string_view extension) {
  if (extension == ".aabbs") return true;
  if (bytes.size() < header_bytes) return false;
  for (const std::string_view name : {bytes.substr(0, name_bytes), bytes.substr(name_bytes, name_bytes)}) {
    const std::size_t end = name.find('\0');
    if (end == 0 || end == std::string_view::npos) return false;
    if (std::ranges::any_of(name.substr(0, end), [](char c) { return static_cast<unsigned char>(c) < ' '; }))
      return false;
  }
  const auto word = [&bytes](std::size_t i) { return read_word(&bytes[2 * name_bytes + 4 * i]); };
  return word(0) <= most_of_anything && word(1) <= most_of_anything && word(2) == 0 && word(3) == 0 &&
         is_present(read_bounds(&bytes[2 * name_bytes + 16]));
}

}  // namespace

Format broadmark() {
  return {
      .name = "broadmark",
      .summary = "Broadmark's frames of boxes",
      .extensions = {".aabbs"},
      .recognises = is_broadmark,
      .open = open_broadmark,
      .create = create_broadmark,
      .has_doubles = false,
  };
}

}  // namespace broadside::lab::readers
