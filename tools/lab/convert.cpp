// Converts files of boxes to another format.
#include "lab/convert.hpp"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "lab/numbers.hpp"

namespace broadside::lab {
namespace {

/// Passes frames on and counts their boxes.
template <int D, typename Real>
class CountingFrames final : public FrameReader<D, Real> {
 public:
  CountingFrames(std::unique_ptr<FrameReader<D, Real>> frames, Converted& counts)
      : frames_(std::move(frames)), counts_(counts) {}

  std::vector<Box<D, Real>> first() override {
    std::vector<Box<D, Real>> boxes = frames_->first();
    count(boxes, boxes.size());
    return boxes;
  }

  bool next(Step<D, Real>& step) override {
    if (!frames_->next(step)) {
      counts_.warning = frames_->warning();
      return false;
    }
    count(step.boxes, step.size);
    return true;
  }

  std::string warning() const override { return frames_->warning(); }
  std::string_view importer() const override { return frames_->importer(); }
  const RecordedPairs* recorded() const override { return frames_->recorded(); }

  std::shared_ptr<const BoxLabels> labels() const override { return frames_->labels(); }

 private:
  void count(const std::vector<Box<D, Real>>& boxes, std::size_t size) {
    ++counts_.frames;
    counts_.boxes = std::max(counts_.boxes, size);
    if (counts_.precision == Precision::float32) counts_.rounding.count(std::span<const Box<D, Real>>(boxes));
  }

  std::unique_ptr<FrameReader<D, Real>> frames_;
  Converted& counts_;
};

}  // namespace

Converted convert(BoxFile from, const std::filesystem::path& path, const Format& format,
                  std::optional<Precision> precision) {
  Converted converted;
  converted.dimension = dimension_of(from.frames);
  converted.importer = importer_of(from.frames);
  converted.precision = precision.value_or(precision_of_frames(from.frames));
  if (has_recorded_pairs(from.frames)) {
    if (!format.keeps_pairs)
      converted.left_out_pairs = fmt::format("format {} holds boxes alone", format.name);
    else if (converted.precision < precision_of_frames(from.frames))
      converted.left_out_pairs = "they are those of the boxes in double";
  }
  AnyFrameReader counted = std::visit(
      [&]<int D, typename Real>(std::unique_ptr<FrameReader<D, Real>>& frames) -> AnyFrameReader {
        if (const auto labels = frames->labels()) converted.left_out = labels->unread;
        return std::make_unique<CountingFrames<D, Real>>(std::move(frames), converted);
      },
      from.frames);
  write_frames(with_precision(std::move(counted), converted.precision), path, format);
  return converted;
}

std::string text_of(const Converted& converted, const std::filesystem::path& path, const Format& format) {
  return fmt::format("{}: {} of {} in {}D, {}, in format {}{}",
                     path == "-" ? "standard output" : path.string(),
                     counted(converted.frames, "frame", "frames"), counted(converted.boxes, "box", "boxes"),
                     converted.dimension, precision_text(converted.precision, converted.importer),
                     format.name, converted.rounding.rounded > 0 ? "; " + converted.rounding.text() : "");
}

std::string text_of_left_out(const Converted& converted, const Format& format) {
  constexpr std::size_t max_names = 20;
  const std::vector<std::string>& names = converted.left_out;
  if (!converted.left_out_pairs.empty())  // from a trace, which is not a table
    return "left out the recorded pairs: " + converted.left_out_pairs;
  if (names.empty()) return {};
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), max_names); ++i)
    list += fmt::format("{}'{}'", i == 0 ? "" : ", ", names[i]);
  if (names.size() > max_names) list += fmt::format(" and {} more", names.size() - max_names);
  return fmt::format("left out {} {}: format {} holds bounds{}",
                     names.size() == 1 ? "the column" : "the columns", list, format.name,
                     format.keeps_ids ? " and ids (--ids)" : " alone");
}

}  // namespace broadside::lab
