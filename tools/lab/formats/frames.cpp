// Converts frames to another precision, or to 2D.
#include "lab/formats/frames.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "lab/numbers.hpp"

namespace broadside::lab {
namespace {

template <int D, typename Real, int OldD, typename OldReal>
Box<D, Real> converted(const Box<OldD, OldReal>& box) {
  // An absent box stays absent without z.
  Box<D, Real> result;
  for (int axis = 0; axis < D; ++axis) {
    result.min[axis] = static_cast<Real>(box.min[axis]);
    result.max[axis] = static_cast<Real>(box.max[axis]);
  }
  return result;
}

/// The frames of another reader, with each box converted.
template <int D, typename Real, int OldD, typename OldReal>
class ConvertedFrames final : public FrameReader<D, Real> {
 public:
  explicit ConvertedFrames(std::unique_ptr<FrameReader<OldD, OldReal>> frames, std::string name = {})
      : frames_(std::move(frames)), name_(std::move(name)) {}

  std::vector<Box<D, Real>> first() override { return converted_boxes(frames_->first()); }

  bool first_piece(std::vector<Box<D, Real>>& boxes) override {
    if (!frames_->first_piece(old_piece_)) return false;
    boxes = converted_boxes(old_piece_);
    return true;
  }

  bool has_pieces() const override { return frames_->has_pieces(); }

  /// Slices are converted apart, so no slice can report the total number of rounded coordinates.
  bool take_slice(std::size_t slice, std::size_t slices) override {
    return (keeps_numbers || slices == 1) && frames_->take_slice(slice, slices);
  }

  std::uint64_t estimated_boxes() const override { return frames_->estimated_boxes(); }

  bool next(Step<D, Real>& step) override {
    if (!frames_->next(old_)) return false;
    step = {old_.size, std::move(old_.changed), converted_boxes(old_.boxes)};
    return true;
  }

  std::string warning() const override {
    std::string warning = frames_->warning();
    const auto add = [&](std::string_view what) {
      warning += fmt::format("{}{}: {}", warning.empty() ? "" : "\n", name_, what);
    };
    if (rounding_.rounded > 0) add(rounding_.text());
    if (!keeps_pairs && frames_->recorded() != nullptr)
      add(fmt::format("left out the recorded pairs: they are those of boxes in {}D, in {}", OldD,
                      lab::name(precision_of<OldReal>)));
    return warning;
  }

  const RecordedPairs* recorded() const override { return keeps_pairs ? frames_->recorded() : nullptr; }

  std::string_view importer() const override { return frames_->importer(); }

  bool is_computed() const override { return frames_->is_computed(); }

  std::shared_ptr<const BoxLabels> labels() const override { return frames_->labels(); }

 private:
  // Rounded boxes, or boxes without z, may overlap where the original ones do not.
  static constexpr bool keeps_numbers = sizeof(Real) >= sizeof(OldReal);
  static constexpr bool keeps_pairs = D == OldD && keeps_numbers;

  std::vector<Box<D, Real>> converted_boxes(const std::vector<Box<OldD, OldReal>>& boxes) {
    if constexpr (std::is_same_v<Real, float> && std::is_same_v<OldReal, double>)
      rounding_.count(std::span<const Box<OldD, OldReal>>(boxes));
    std::vector<Box<D, Real>> result;
    result.reserve(boxes.size());
    std::transform(boxes.begin(), boxes.end(), std::back_inserter(result), converted<D, Real, OldD, OldReal>);
    return result;
  }

  std::unique_ptr<FrameReader<OldD, OldReal>> frames_;
  std::string name_;  // of the file
  Rounding rounding_;
  Step<OldD, OldReal> old_;
  std::vector<Box<OldD, OldReal>> old_piece_;
};

template <typename Real, int D, typename OldReal>
AnyFrameReader with_coordinates_of(std::unique_ptr<FrameReader<D, OldReal>> frames, std::string name) {
  if constexpr (std::is_same_v<Real, OldReal>)
    return frames;
  else
    return std::make_unique<ConvertedFrames<D, Real, D, OldReal>>(std::move(frames), std::move(name));
}

template <int D, typename Real>
AnyFrameReader flat(std::unique_ptr<FrameReader<D, Real>> frames, std::string name) {
  if constexpr (D == 2)
    return frames;
  else
    return std::make_unique<ConvertedFrames<2, Real, 3, Real>>(std::move(frames), std::move(name));
}

}  // namespace

std::string_view name(Precision precision) noexcept {
  return precision == Precision::float32 ? "float" : "double";
}

std::string precision_text(Precision precision, std::string_view importer) {
  if (importer.empty()) return fmt::format("as {}s", name(precision));
  return fmt::format("as {}s (read by {} in float)", name(precision), importer);
}

std::string Rounding::text() const {
  std::string text =
      fmt::format("{} of {} {} rounded to float", grouped(rounded),
                  counted(coordinates, "coordinate", "coordinates"), rounded == 1 ? "was" : "were");
  if (lost > 0)
    text += fmt::format(", {} of them to infinity or zero, since floats end at 3.4e38 and 1.4e-45",
                        grouped(lost));
  return text;
}

int dimension_of(const AnyFrameReader& frames) noexcept { return frames.index() % 2 == 0 ? 2 : 3; }

Precision precision_of_frames(const AnyFrameReader& frames) noexcept {
  return frames.index() < 2 ? Precision::float32 : Precision::float64;
}

std::string_view importer_of(const AnyFrameReader& frames) {
  return std::visit([](const auto& reader) { return reader->importer(); }, frames);
}

bool has_recorded_pairs(const AnyFrameReader& frames) {
  return std::visit([](const auto& reader) { return reader->recorded() != nullptr; }, frames);
}

AnyFrameReader with_precision(AnyFrameReader frames, Precision precision, std::string name) {
  return std::visit(
      [&](auto& reader) {
        return precision == Precision::float32
                   ? with_coordinates_of<float>(std::move(reader), std::move(name))
                   : with_coordinates_of<double>(std::move(reader), std::move(name));
      },
      frames);
}

AnyFrameReader flattened(AnyFrameReader frames, std::string name) {
  return std::visit([&](auto& reader) { return flat(std::move(reader), std::move(name)); }, frames);
}

}  // namespace broadside::lab
