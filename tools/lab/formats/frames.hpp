// Frames of boxes as files hold them: in 2D or 3D, as floats or doubles.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "broadside/box.hpp"

#include "lab/formats/recorded_pairs.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// The type of a file's coordinates: float or double.
enum class Precision : std::uint8_t { float32, float64 };

/// "float" or "double".
std::string_view name(Precision precision) noexcept;

/// "as floats", or "as floats (read by assimp in float)".
std::string precision_text(Precision precision, std::string_view importer);

template <typename Real>
constexpr Precision precision_of = std::is_same_v<Real, float> ? Precision::float32 : Precision::float64;

/// Counts coordinates that are not exactly representable as floats.
struct Rounding {
  std::uint64_t coordinates = 0;
  std::uint64_t rounded = 0;
  std::uint64_t lost = 0;  ///< beyond a float's range, rounded to infinity or zero

  template <int D, typename Real>
  void count(std::span<const Box<D, Real>> boxes) {
    const auto count_one = [this](Real number) {
      const auto near = static_cast<float>(number);
      const bool is_rounded = static_cast<Real>(near) != number;
      rounded += std::uint64_t{is_rounded};
      lost += std::uint64_t{is_rounded && (std::isinf(near) || near == 0)};
    };
    coordinates += 2 * D * boxes.size();
    for (const Box<D, Real>& box : boxes) {
      for (std::size_t axis = 0; axis < D; ++axis) {
        count_one(box.min[axis]);
        count_one(box.max[axis]);
      }
    }
  }

  Rounding& operator+=(const Rounding& other) noexcept {
    coordinates += other.coordinates;
    rounded += other.rounded;
    lost += other.lost;
    return *this;
  }

  /// "2 of 1,000 coordinates were rounded to float", followed by the number rounded to infinity or zero.
  std::string text() const;
};

/// Labels of boxes in a file.
struct BoxLabels {
  bool has_ids = false;
  std::vector<std::string> ids{};     ///< the user's ids by place, for the frames read so far; any text
  std::vector<std::string> unread{};  ///< the names of a table's columns that are not read
  std::size_t across_date_line = 0;   ///< boxes that were read as across it, of the frames read so far
};

/// Reads the frames of a file in sequence. Throws FileError (lab/formats/format.hpp) if the file is invalid,
/// possibly only at a later frame. Use from one thread at a time.
template <int D, typename Real>
class FrameReader {
 public:
  virtual ~FrameReader() = default;

  /// The boxes of the first frame. Called once, before next().
  virtual std::vector<Box<D, Real>> first() = 0;

  /// Alternative to first(), for more boxes than fit in memory: replaces `boxes` by the next ones, however
  /// many; false if there are no more. Gives all at once unless has_pieces().
  virtual bool first_piece(std::vector<Box<D, Real>>& boxes) {
    if (std::exchange(has_given_first_, true)) return false;
    boxes = first();
    return true;
  }

  /// Whether first_piece() gives a few boxes at a time and needs memory for these only.
  virtual bool has_pieces() const { return false; }

  /// Restricts first() and first_piece(), neither of which has been called yet, to one of `slices` slices of
  /// the first frame. Slices are about equally long and cover all boxes in order. False if the slice can only
  /// be found by reading from the beginning.
  virtual bool take_slice(std::size_t slice, std::size_t slices) {
    static_cast<void>(slice);
    return slices == 1;
  }

  /// The approximate number of boxes in the first frame; 0 if unknown before reading it.
  virtual std::uint64_t estimated_boxes() const { return 0; }

  /// Whether there was another frame. If so, `step` leads to it from the previous frame.
  virtual bool next(Step<D, Real>& step) = 0;

  /// Valid after the last frame: the missing parts of a damaged file with their place, and the number of
  /// coordinates rounded; empty if there is nothing to report.
  virtual std::string warning() const { return {}; }

  /// Filled while frames are read; null for a file without labels.
  virtual std::shared_ptr<const BoxLabels> labels() const { return nullptr; }

  /// The library that read the file, if it may have rounded the file's numbers to float: pairs of these boxes
  /// are not exact. Otherwise empty.
  virtual std::string_view importer() const { return {}; }

  /// The changes of the frame read last to the pairs that an engine reported; before first(), only their
  /// margin. Null if no pairs were recorded. Valid as long as the reader; each frame changes it.
  virtual const RecordedPairs* recorded() const { return nullptr; }

  /// Whether bounds are computed, in double, from a centre and a size: pairs of these boxes are not exact
  /// either.
  virtual bool is_computed() const { return false; }

 private:
  bool has_given_first_ = false;
};

/// Writes the frames of a file. Throws FileError if the format cannot hold them.
template <int D, typename Real>
class FrameWriter {
 public:
  virtual ~FrameWriter() = default;

  /// Called before first() if the boxes have ids and the format stores them (Format::keeps_ids): the ids by
  /// place. The list outlives the writer, and grows before each call that brings new boxes.
  virtual void use_ids(const std::vector<std::string>& ids) { static_cast<void>(ids); }

  /// Called before first() if pairs were recorded and the format stores them (Format::keeps_pairs). The
  /// object outlives the writer, and holds each frame's pairs while that frame is written.
  virtual void use_recorded(const RecordedPairs& recorded) { static_cast<void>(recorded); }

  /// The boxes of the first frame. Called once, before next().
  virtual void first(std::span<const Box<D, Real>> boxes) = 0;

  virtual void next(const Step<D, Real>& step) = 0;

  /// Called after the last frame. The caller checks the stream.
  virtual void finish() {}
};

/// A reader or writer of any dimension and precision.
template <template <int, typename> typename T>
using AnyOf = std::variant<std::unique_ptr<T<2, float>>, std::unique_ptr<T<3, float>>,
                           std::unique_ptr<T<2, double>>, std::unique_ptr<T<3, double>>>;
using AnyFrameReader = AnyOf<FrameReader>;
using AnyFrameWriter = AnyOf<FrameWriter>;

/// Calls `make.template operator()<D, Real>()` for this dimension (2 or 3) and precision.
template <typename Make>
auto for_boxes_of(int dimension, Precision precision, const Make& make) {
  const bool is_float = precision == Precision::float32;
  if (dimension == 2)
    return is_float ? make.template operator()<2, float>() : make.template operator()<2, double>();
  return is_float ? make.template operator()<3, float>() : make.template operator()<3, double>();
}

int dimension_of(const AnyFrameReader& frames) noexcept;
Precision precision_of_frames(const AnyFrameReader& frames) noexcept;

/// FrameReader::importer() of the reader.
std::string_view importer_of(const AnyFrameReader& frames);

/// Whether an engine's pairs were recorded with the boxes.
bool has_recorded_pairs(const AnyFrameReader& frames);

/// Frames whose boxes are all in memory.
template <int D, typename Real>
class HistoryReader final : public FrameReader<D, Real> {
 public:
  explicit HistoryReader(History<D, Real> history, std::shared_ptr<const BoxLabels> labels = nullptr,
                         std::string warning = {}, bool is_computed = false)
      : history_(std::move(history)),
        labels_(std::move(labels)),
        warning_(std::move(warning)),
        is_computed_(is_computed) {}

  std::vector<Box<D, Real>> first() override { return std::move(history_.boxes); }

  bool next(Step<D, Real>& step) override {
    if (next_ == history_.steps.size()) return false;
    step = std::move(history_.steps[next_++]);
    return true;
  }

  std::string warning() const override { return warning_; }

  std::shared_ptr<const BoxLabels> labels() const override { return labels_; }

  bool is_computed() const override { return is_computed_; }

 private:
  History<D, Real> history_;
  std::shared_ptr<const BoxLabels> labels_;
  std::string warning_;
  bool is_computed_;
  std::size_t next_ = 0;
};

/// Frames whose boxes are unrelated to those of the previous frame, and are numbered anew.
template <int D>
class SeparateFrames final : public FrameReader<D, double> {
 public:
  struct Frame {
    std::vector<Box<D, double>> boxes{};
    std::vector<std::string> ids{};
  };

  SeparateFrames(std::vector<Frame> frames, bool has_ids, bool is_computed, std::string warning)
      : frames_(std::move(frames)), is_computed_(is_computed), warning_(std::move(warning)) {
    labels_->has_ids = has_ids;
  }

  std::vector<Box<D, double>> first() override {
    return frames_.empty() ? std::vector<Box<D, double>>() : take();
  }

  bool next(Step<D, double>& step) override {
    if (next_ >= frames_.size()) return false;
    step = {};
    step.boxes = take();
    step.size = step.boxes.size();
    for (std::size_t i = 0; i < step.size; ++i) step.changed.push_back(BoxId(i));
    return true;
  }

  std::string warning() const override { return warning_; }

  /// Holds the ids of the frame read last.
  std::shared_ptr<const BoxLabels> labels() const override { return labels_; }

  bool is_computed() const override { return is_computed_; }

 private:
  std::vector<Box<D, double>> take() {
    Frame& frame = frames_[next_++];
    labels_->ids = std::move(frame.ids);
    return std::move(frame.boxes);
  }

  std::vector<Frame> frames_;
  bool is_computed_;
  std::string warning_;
  std::size_t next_ = 0;
  std::shared_ptr<BoxLabels> labels_ = std::make_shared<BoxLabels>();
};

/// Reads the remaining frames into memory.
template <int D, typename Real>
History<D, Real> read_all(FrameReader<D, Real>& frames) {
  History<D, Real> history{frames.first(), {}};
  for (Step<D, Real> step; frames.next(step);) history.steps.push_back(std::move(step));
  return history;
}

/// The same frames with coordinates of another type: rounded to nearest, or to infinity beyond the largest
/// number. Their warning gives the number of rounded coordinates in the file called `name`. Recorded pairs
/// belong to the exact boxes: if boxes are rounded, they are left out, and the warning says so.
AnyFrameReader with_precision(AnyFrameReader frames, Precision precision, std::string name = {});

/// The same frames in 2D: 3D boxes projected along the z axis. Recorded pairs are left out, with a warning.
AnyFrameReader flattened(AnyFrameReader frames, std::string name = {});

}  // namespace broadside::lab
