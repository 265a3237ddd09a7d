// Reads the frames of a table.
//
// With columns frame and box, frame 0 lists every box in order, and a later frame the boxes that change; a
// box one beyond the last is new. Empty coordinates, or min = inf and max = -inf, stand for an absent box,
// and a line with nothing but a frame for a frame in which nothing changes. With tracks instead of column
// box, see tracks.hpp.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/csv/csv.hpp"
#include "lab/formats/csv/rows.hpp"

namespace broadside::lab::readers {
namespace {

/// The one frame of a table without columns frame and box.
template <int D, typename Real>
class PlainCsv final : public FrameReader<D, Real> {
 public:
  explicit PlainCsv(CsvTable table) : rows_(std::move(table)) {}

  std::vector<Box<D, Real>> first() override {
    constexpr std::size_t sample = 1000;
    std::vector<Box<D, Real>> boxes;
    const std::size_t before = rows_.lines().bytes_left();
    while (rows_.next()) {
      rows_.read();
      boxes.push_back(rows_.box());
      rows_.keep_id(boxes.size() - 1);
      if (boxes.size() != sample) continue;
      // Lines that go on as they began; no more than there can be in the bytes that are there.
      const std::size_t left = rows_.lines().bytes_left();
      const std::size_t bytes_a_row = (before - left) / sample;
      boxes.reserve(sample + left / bytes_a_row + left / bytes_a_row / 32);
    }
    return boxes;
  }

  bool first_piece(std::vector<Box<D, Real>>& boxes) override {
    constexpr std::size_t rows_a_piece = std::size_t{1} << 16;
    boxes.clear();
    while (boxes.size() < rows_a_piece && rows_.next()) {
      rows_.read();
      boxes.push_back(rows_.box());
    }
    rows_.release();
    return !boxes.empty();
  }

  bool has_pieces() const override { return true; }

  bool take_slice(std::size_t slice, std::size_t slices) override { return rows_.take_slice(slice, slices); }

  bool next(Step<D, Real>&) override { return false; }

  std::string warning() const override { return rows_.warning(); }

  std::shared_ptr<const BoxLabels> labels() const override { return rows_.labels(); }

  bool is_computed() const override { return rows_.is_computed(); }

 private:
  CsvRows<D, Real> rows_;
};

/// The frames of a table that has columns frame and box.
template <int D, typename Real>
class FramedCsv final : public FrameReader<D, Real> {
 public:
  explicit FramedCsv(CsvTable table) : rows_(std::move(table)) {}

  std::vector<Box<D, Real>> first() override {
    std::vector<Box<D, Real>> boxes;
    for (std::size_t place = 0; next_change(place);) boxes.push_back(rows_.box());
    return boxes;
  }

  bool next(Step<D, Real>& step) override {
    if (!has_row_) return false;
    ++frame_;
    step = {};
    for (std::size_t place = 0; next_change(place);) {
      step.changed.push_back(BoxId(place));
      step.boxes.push_back(rows_.box());
    }
    step.size = last_change_.size();
    return true;
  }

  std::string warning() const override { return rows_.warning(); }

  std::shared_ptr<const BoxLabels> labels() const override { return rows_.labels(); }

  bool is_computed() const override { return rows_.is_computed(); }

 private:
  enum class Row { empty, change, of_next_frame };

  /// Whether this frame has another row with a box, whose number is then `place`.
  bool next_change(std::size_t& place) {
    while (true) {
      if (!std::exchange(has_row_, false)) {
        if (!rows_.next()) return false;
        if (!rows_.read()) continue;
      }
      // What frame and box a row is of must be right even where invalid boxes are skipped: others are
      // numbered by it.
      const Row row = check_row(place);
      if (row == Row::empty) continue;
      if (row == Row::of_next_frame) {
        has_row_ = true;
        return false;
      }
      rows_.keep_id(place);
      return true;
    }
  }

  Row check_row(std::size_t& place) {
    const std::size_t frame = rows_.whole_number(BoxColumns::frame);
    if (!has_begun_ && frame != 0) rows_.refuse(BoxColumns::frame, "0: frames are counted from there");
    has_begun_ = true;
    if (frame == frame_ + 1) return Row::of_next_frame;
    if (frame != frame_)
      rows_.refuse(BoxColumns::frame, fmt::format("{} or {}: frames follow one another", frame_, frame_ + 1));
    if (!rows_.has_box()) return Row::empty;
    const std::size_t box = rows_.whole_number(BoxColumns::box);
    // Nothing may be left out: a single line must not be able to ask for any amount of memory.
    if (box > last_change_.size())
      rows_.refuse(
          BoxColumns::box,
          fmt::format("a box from 0 to {}: new ones are numbered one after the other", last_change_.size()));
    if (box < last_change_.size() && last_change_[box] == frame_)
      rows_.refuse(BoxColumns::box, "each box once in a frame");
    if (box == last_change_.size()) last_change_.push_back(frame_);
    last_change_[box] = frame_;
    place = box;
    return Row::change;
  }

  CsvRows<D, Real> rows_;
  bool has_row_ = false;  // a row was read that belongs to the next frame
  bool has_begun_ = false;
  std::size_t frame_ = 0;
  std::vector<std::size_t> last_change_;  // for each box, the frame in which it was last listed
};

}  // namespace

AnyFrameReader read_csv(CsvTable table, Precision precision) {
  return for_boxes_of(table.columns.dimension, precision, [&]<int D, typename Real>() -> AnyFrameReader {
    if (table.columns.has_tracks) return read_tracks<D, Real>(std::move(table));
    if (table.columns.has_frames) return std::make_unique<FramedCsv<D, Real>>(std::move(table));
    return std::make_unique<PlainCsv<D, Real>>(std::move(table));
  });
}

}  // namespace broadside::lab::readers
