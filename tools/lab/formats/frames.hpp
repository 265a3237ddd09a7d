// Boxes as files hold them: frame after frame, in 2D or 3D, as floats or as doubles.
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

/// Counts coordinates that no float holds exactly.
struct Rounding {
  std::uint64_t coordinates = 0;
  std::uint64_t rounded = 0;
  std::uint64_t lost = 0;  ///< rounded beyond a float's range, to infinity or zero

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

  /// "2 of 1,000 coordinates were rounded to float", and how many of them to infinity or zero.
  std::string text() const;
};

/// What a file says of its boxes besides their bounds.
struct BoxLabels {
  bool has_ids = false;
  std::vector<std::string> ids{};     ///< the user's, by place, as far as frames have been read; any text
  std::vector<std::string> unread{};  ///< the names of a table's columns that nothing is read from
};

/// Gives the frames of a file, one after the other. Throws FileError (lab/formats/format.hpp) where the file
/// is wrong, which may be in a later frame. One thread at a time.
template <int D, typename Real>
class FrameReader {
 public:
  virtual ~FrameReader() = default;

  /// The boxes of the first frame. Called once, before next().
  virtual std::vector<Box<D, Real>> first() = 0;

  /// In the stead of first(), for more boxes than memory holds: puts the next ones into `boxes`, however
  /// many, instead of those of the last call; false where there are no more. All at once unless has_pieces().
  virtual bool first_piece(std::vector<Box<D, Real>>& boxes) {
    if (std::exchange(has_given_first_, true)) return false;
    boxes = first();
    return true;
  }

  /// Whether first_piece() gives a few boxes at a time, and memory is needed for no others.
  virtual bool has_pieces() const { return false; }

  /// Has first() and first_piece(), which have not been called, give one of `slices` slices of the first
  /// frame's boxes alone: slices are about as long, and one behind the other they are all boxes. False where
  /// nothing but reading from the beginning tells which boxes these are.
  virtual bool take_slice(std::size_t slice, std::size_t slices) {
    static_cast<void>(slice);
    return slices == 1;
  }

  /// About how many boxes the first frame has; 0 where that is not known before it is read.
  virtual std::uint64_t estimated_boxes() const { return 0; }

  /// Whether there was another frame; `step` then leads to it from the one before.
  virtual bool next(Step<D, Real>& step) = 0;

  /// Valid after the last frame: what a damaged file lacks, and where, and how many coordinates were rounded;
  /// empty if nothing.
  virtual std::string warning() const { return {}; }

  /// Filled as frames are read; null where the file has none.
  virtual std::shared_ptr<const BoxLabels> labels() const { return nullptr; }

  /// The library that read the file, where it may have rounded the file's numbers to float: pairs of these
  /// boxes are not exact. Empty otherwise.
  virtual std::string_view importer() const { return {}; }

  /// What the frame read last changes of the pairs that an engine reported, where they were recorded; before
  /// first(), their margin alone. Null otherwise. Valid as long as the reader, and changed by each frame.
  virtual const RecordedPairs* recorded() const { return nullptr; }

  /// Whether bounds are computed, in double, from a centre and a size: pairs of these boxes are not exact
  /// either.
  virtual bool is_computed() const { return false; }

 private:
  bool has_given_first_ = false;
};

/// Takes the frames of a file that is being written. Throws FileError if the format cannot hold them.
template <int D, typename Real>
class FrameWriter {
 public:
  virtual ~FrameWriter() = default;

  /// Called before first() where the boxes have ids and the format keeps them (Format::keeps_ids): the ids by
  /// place. The list outlives the writer, and grows before each call that brings new boxes.
  virtual void use_ids(const std::vector<std::string>& ids) { static_cast<void>(ids); }

  /// Called before first() where pairs were recorded with the boxes and the format keeps them
  /// (Format::keeps_pairs). They outlive the writer, and are those of each frame when it is written.
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

/// Calls `make.template operator()<D, Real>()` for this dimension, 2 or 3, and this precision.
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

/// The frames of a file whose reader has all its boxes in memory.
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

/// Frames whose boxes have nothing to do with those of the frame before, and are numbered anew.
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

  /// With the ids of the frame that was read last.
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

/// The same frames with coordinates of another type: rounded to the nearest, and the infinite beyond the
/// largest. Their warning says how many of the file of this name were rounded. Recorded pairs are those of
/// the exact boxes: where boxes are rounded, they are left out, and the warning says so.
AnyFrameReader with_precision(AnyFrameReader frames, Precision precision, std::string name = {});

/// The same frames in 2D: 3D boxes seen along the z axis. Recorded pairs are left out, with a warning.
AnyFrameReader flattened(AnyFrameReader frames, std::string name = {});

}  // namespace broadside::lab
