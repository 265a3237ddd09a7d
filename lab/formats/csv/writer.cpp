// Writes boxes as a table: one line a box, or one line a box that changes in a frame.
#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/csv/csv.hpp"
#include "lab/formats/format.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab::readers {
namespace {

template <int D>
constexpr std::string_view bounds_columns =
    D == 2 ? "min_x,min_y,max_x,max_y\n" : "min_x,min_y,min_z,max_x,max_y,max_z\n";

/// Text on its way into a stream, gathered into large pieces.
class Buffer {
 public:
  explicit Buffer(std::ostream& stream) : stream_(stream), bytes_(std::size_t{1} << 16) {}

  template <typename Number>
  void number(Number value) {
    make_room();
    used_ = static_cast<std::size_t>(
        std::to_chars(bytes_.data() + used_, bytes_.data() + bytes_.size(), value).ptr - bytes_.data());
  }

  void text(std::string_view text) {
    while (!text.empty()) {
      make_room();
      const std::size_t size = std::min(text.size(), bytes_.size() - used_);
      std::memcpy(bytes_.data() + used_, text.data(), size);
      used_ += size;
      text.remove_prefix(size);
    }
  }

  void flush() {
    stream_.write(bytes_.data(), static_cast<std::streamsize>(used_));
    used_ = 0;
  }

 private:
  /// Room for any number.
  void make_room() {
    if (bytes_.size() - used_ < 100) flush();
  }

  std::ostream& stream_;
  std::vector<char> bytes_;
  std::size_t used_ = 0;
};

template <int D, typename Real>
void write_bounds(Buffer& buffer, const Box<D, Real>& box) {
  const bool absent = is_absent(box);
  for (int i = 0; i < 2 * D; ++i) {
    if (i > 0) buffer.text(",");
    if (!absent) buffer.number(static_cast<double>(i < D ? box.min[i] : box.max[i - D]));
  }
  buffer.text("\n");
}

/// What a file must list so that its boxes become those of `step`: the boxes that change, those that go
/// because the array ends before them, and those that come absent; sorted.
template <int D, typename Real>
std::vector<std::pair<BoxId, Box<D, Real>>> rows_of(const Step<D, Real>& step,
                                                    std::span<const Box<D, Real>> before,
                                                    std::size_t places) {
  std::vector<std::pair<BoxId, Box<D, Real>>> rows;
  for (std::size_t i = step.size; i < before.size(); ++i) {
    if (!is_absent(before[i])) rows.emplace_back(BoxId(i), absent_box<D, Real>());
  }
  for (std::size_t i = places; i < step.size; ++i) rows.emplace_back(BoxId(i), absent_box<D, Real>());
  for (std::size_t i = 0; i < step.changed.size(); ++i) {
    if (index(step.changed[i]) < step.size) rows.emplace_back(step.changed[i], step.boxes[i]);
  }
  // Of two rows for a box the later one, from the list of changes, holds.
  std::ranges::reverse(rows);
  std::ranges::stable_sort(rows, {}, &std::pair<BoxId, Box<D, Real>>::first);
  // Not std::ranges' version: clang 14 cannot compile what it returns.
  rows.erase(
      std::unique(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
      rows.end());
  return rows;
}

template <int D, typename Real>
class CsvWriter final : public FrameWriter<D, Real> {
 public:
  explicit CsvWriter(std::ostream& stream) : buffer_(stream) {}

  void use_ids(const std::vector<std::string>& ids) override { ids_ = &ids; }

  void first(std::span<const Box<D, Real>> boxes) override {
    boxes_.assign(boxes.begin(), boxes.end());
    places_ = boxes.size();
  }

  void next(const Step<D, Real>& step) override {
    if (frame_ == 0) {
      buffer_.text("frame,box,");
      write_names();
      for (std::size_t i = 0; i < boxes_.size(); ++i) write_row(i, boxes_[i]);
      if (boxes_.empty()) write_frame_alone();
    }
    ++frame_;
    const auto rows = rows_of<D, Real>(step, boxes_, places_);
    for (const auto& [id, box] : rows) write_row(index(id), box);
    if (rows.empty()) write_frame_alone();
    lab::apply(step, boxes_);
    places_ = std::max(places_, boxes_.size());
  }

  void finish() override {
    if (frame_ == 0) {
      write_names();
      for (std::size_t i = 0; i < boxes_.size(); ++i) {
        write_id(i);
        write_bounds(buffer_, boxes_[i]);
      }
    }
    buffer_.flush();
  }

 private:
  void write_names() {
    if (ids_ != nullptr) buffer_.text("id,");
    buffer_.text(bounds_columns<D>);
  }

  void write_id(std::size_t place) {
    if (ids_ == nullptr) return;
    if (place < ids_->size()) {
      quoted_.clear();
      append_csv_field(quoted_, (*ids_)[place]);
      if (quoted_.find_first_of("\r\n") != std::string::npos)
        throw FileError(
            fmt::format("id {} of box {} has a line break, which a table cannot hold; expected one line",
                        shown((*ids_)[place]), place));
      buffer_.text(quoted_);
    }
    buffer_.text(",");
  }

  void write_row(std::size_t place, const Box<D, Real>& box) {
    buffer_.number(frame_);
    buffer_.text(",");
    buffer_.number(place);
    buffer_.text(",");
    write_id(place);
    write_bounds(buffer_, box);
  }

  void write_frame_alone() {
    buffer_.number(frame_);
    if (ids_ != nullptr) buffer_.text(",");
    buffer_.text(D == 2 ? ",,,,,\n" : ",,,,,,,\n");
  }

  Buffer buffer_;
  const std::vector<std::string>* ids_ = nullptr;
  std::string quoted_;
  std::vector<Box<D, Real>> boxes_;
  std::size_t places_ = 0;  // in the file, where the array never becomes shorter
  std::size_t frame_ = 0;
};

}  // namespace

AnyFrameWriter write_csv(std::ostream& stream, int dimension, Precision precision) {
  return for_boxes_of(dimension, precision, [&]<int D, typename Real>() -> AnyFrameWriter {
    return std::make_unique<CsvWriter<D, Real>>(stream);
  });
}

}  // namespace broadside::lab::readers
