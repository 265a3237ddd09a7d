// Reads traces (docs/trace-format.md), which a Recorder wrote inside a user's engine, frame by frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <istream>
#include <span>
#include <string>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"
#include "broadside/recorder.hpp"

#include "lab/formats/recorded_pairs.hpp"

namespace broadside::lab {

/// Reads a trace frame by frame. Memory: the changes of one frame and, if an engine's pairs were recorded,
/// the pairs of a frame, however long the trace. Never more than the actual bytes justify, whatever the trace
/// claims.
///
/// Invalid data throw a FileError (lab/formats/format.hpp) with the frame and the byte. Use from one thread
/// at a time.
class TraceReader {
 public:
  /// Reads the header of a trace from a stream, which must outlive the reader. Errors call it `name`.
  TraceReader(std::istream& stream, std::string name);

  TraceReader(const TraceReader&) = delete;
  TraceReader& operator=(const TraceReader&) = delete;

  int dimension() const noexcept { return dimension_; }

  /// 4 if the trace holds floats, 8 if it holds doubles.
  int coordinate_bytes() const noexcept { return coordinate_bytes_; }

  /// Whether there was another complete frame; the functions below then refer to it. After the end, always
  /// false.
  bool next_frame();

  /// How many frames have been read.
  std::uint64_t frames() const noexcept { return frames_; }

  /// The number of slots, which is the size of the array, from this frame on.
  std::uint32_t slots() const noexcept { return slots_; }

  /// The slots that this frame names, ascending; includes every new slot.
  std::span<const BoxId> changed() const noexcept { return changed_; }

  /// The new box in changed()[i], exactly as in the file: the minima on all axes, then the maxima; those of
  /// the absent box if the slot became empty.
  std::span<const double> bounds(std::size_t i) const noexcept {
    const auto axes = static_cast<std::size_t>(dimension_);
    return std::span(bounds_).subspan(2 * axes * i, 2 * axes);
  }

  /// The same as a box, for D = dimension(). With Real = float, doubles are rounded to the nearest float.
  template <int D, typename Real>
  Box<D, Real> box(std::size_t i) const noexcept {
    const std::span<const double> from = bounds(i);
    Box<D, Real> box;
    for (std::size_t axis = 0; axis < D; ++axis) {
      box.min[axis] = static_cast<Real>(from[axis]);
      box.max[axis] = static_cast<Real>(from[D + axis]);
    }
    return box;
  }

  /// The frame's changes to the pairs that the engine reported, checked; before the first frame, only the
  /// margin. Null if the trace holds no pairs.
  const RecordedPairs* recorded() const noexcept { return has_pairs_ ? &recorded_ : nullptr; }

  /// After the last frame: where the trace was cut off; empty if it was not.
  const std::string& warning() const noexcept { return warning_; }

 private:
  /// A frame's header and position.
  struct FrameHeader {
    std::uint64_t byte;
    std::uint32_t slots;
    std::uint32_t removed;
    std::uint32_t set;
    std::array<std::uint32_t, 5> pairs;  // filters; ended, begun; ignored ones ended, begun
  };

  void read_header();
  std::size_t frame_header_bytes() const noexcept;
  bool read_frame_header(FrameHeader& header);
  void take(const FrameHeader& header);
  void take_box(std::uint32_t slot, std::size_t at);

  void take_pairs(const FrameHeader& header, std::size_t at);
  void take_filters(const FrameHeader& header, std::size_t at);
  void take_pair_list(std::size_t at, std::uint32_t count, bool may_repeat, std::vector<Pair>& pairs) const;
  void check_held(std::size_t at, const std::vector<Pair>& ended, const std::vector<Pair>& held) const;
  void check_boxes(const FrameHeader& header) const;

  bool read(std::uint64_t count);
  bool read_on(std::uint64_t count);
  std::uint32_t word(std::size_t at) const noexcept;
  std::uint64_t long_word(std::size_t at) const noexcept;
  double coordinate(std::size_t at) const noexcept;
  void check_sum(std::size_t count);
  bool cut_off(std::uint64_t frame_byte, const std::string& found);
  [[noreturn]] void refuse(std::uint64_t byte, const std::string& found, const std::string& expected) const;

  std::istream& stream_;
  std::string name_;
  int dimension_ = 0;
  int coordinate_bytes_ = 0;

  std::uint64_t frames_ = 0;
  std::uint32_t slots_ = 0;
  std::vector<BoxId> changed_;
  std::vector<double> bounds_;  // of each changed slot, in sequence
  std::string warning_;
  bool ended_ = false;

  bool has_pairs_ = false;
  RecordedPairs recorded_;
  RecordedFrame pairs_;        // the pairs of this frame
  std::vector<bool> has_box_;  // by slot; kept only if there are pairs

  trace::Checksum checksum_;
  std::vector<unsigned char> bytes_;  // the bytes read last ...
  std::uint64_t begin_ = 0;           // ... and their position in the file
};

}  // namespace broadside::lab
