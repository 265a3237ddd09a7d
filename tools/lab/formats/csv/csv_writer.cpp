// Writes boxes as a table: one line per box, or one line per box that changes in a frame.
#include "lab/formats/csv/csv_writer.hpp"

#include <array>
#include <charconv>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/csv/csv_text.hpp"
#include "lab/formats/format.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab::readers {
namespace {

template <int D, typename Real>
class CsvWriter final : public FrameWriter<D, Real> {
 public:
  explicit CsvWriter(std::ostream& stream) : stream_(stream) {}

  void use_ids(const std::vector<std::string>& ids) override { ids_ = &ids; }

  void first(std::span<const Box<D, Real>> boxes) override {
    boxes_.assign(boxes.begin(), boxes.end());
    places_ = boxes.size();
  }

  void next(const Step<D, Real>& step) override {
    if (frame_ == 0) {
      text_ += "frame,box,";
      write_names();
      for (std::size_t i = 0; i < boxes_.size(); ++i) write_row(i, boxes_[i]);
      if (boxes_.empty()) write_frame_alone();
    }
    ++frame_;
    // The boxes that change, those removed because the array ends before them, and those added as absent.
    std::map<std::size_t, Box<D, Real>> rows;
    for (std::size_t i = 0; i < step.changed.size(); ++i) {
      if (index(step.changed[i]) < step.size) rows.insert_or_assign(index(step.changed[i]), step.boxes[i]);
    }
    for (std::size_t i = step.size; i < boxes_.size(); ++i) {
      if (!is_absent(boxes_[i])) rows.emplace(i, absent_box<D, Real>());
    }
    for (std::size_t i = places_; i < step.size; ++i) rows.emplace(i, absent_box<D, Real>());
    for (const auto& [place, box] : rows) write_row(place, box);
    if (rows.empty()) write_frame_alone();
    lab::apply(step, boxes_);
    places_ = std::max(places_, boxes_.size());
  }

  void finish() override {
    if (frame_ == 0) {
      write_names();
      for (std::size_t i = 0; i < boxes_.size(); ++i) {
        write_id(i);
        write_bounds(boxes_[i]);
      }
    }
    flush();
  }

 private:
  template <typename Number>
  void write_number(Number number) {
    std::array<char, 32> digits;
    text_.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr);
  }

  void write_names() {
    if (ids_ != nullptr) text_ += "id,";
    text_ += D == 2 ? "min_x,min_y,max_x,max_y\n" : "min_x,min_y,min_z,max_x,max_y,max_z\n";
  }

  void write_id(std::size_t place) {
    if (ids_ == nullptr) return;
    if (place < ids_->size()) {
      const std::string& id = (*ids_)[place];
      if (id.find_first_of("\r\n") != std::string::npos)
        throw FileError(
            fmt::format("id {} of box {} has a line break, which a table cannot hold; expected one line",
                        shown(id), place));
      append_csv_field(text_, id);
    }
    text_ += ',';
  }

  void write_bounds(const Box<D, Real>& box) {
    const bool absent = is_absent(box);
    for (int i = 0; i < 2 * D; ++i) {
      if (!absent) write_number(static_cast<double>(i < D ? box.min[i] : box.max[i - D]));
      text_ += i + 1 < 2 * D ? ',' : '\n';
    }
    constexpr std::size_t max_kept = std::size_t{1} << 16;
    if (text_.size() > max_kept) flush();
  }

  void write_row(std::size_t place, const Box<D, Real>& box) {
    write_number(frame_);
    text_ += ',';
    write_number(place);
    text_ += ',';
    write_id(place);
    write_bounds(box);
  }

  void write_frame_alone() {
    write_number(frame_);
    text_.append(ids_ != nullptr ? 2 * D + 2 : 2 * D + 1, ',');
    text_ += '\n';
  }

  void flush() {
    stream_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
    text_.clear();
  }

  std::ostream& stream_;
  std::string text_;  // not yet written
  const std::vector<std::string>* ids_ = nullptr;
  std::vector<Box<D, Real>> boxes_;
  std::size_t places_ = 0;  // in the file, where the array never shrinks
  std::size_t frame_ = 0;
};

}  // namespace

AnyFrameWriter write_csv(std::ostream& stream, int dimension, Precision precision) {
  return for_boxes_of(dimension, precision, [&]<int D, typename Real>() -> AnyFrameWriter {
    return std::make_unique<CsvWriter<D, Real>>(stream);
  });
}

}  // namespace broadside::lab::readers
