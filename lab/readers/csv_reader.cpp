// Reads a table's rows straight from its bytes. No row takes memory.
//
// With columns frame and box, frame 0 lists every box in order, and a later frame those that change; a box
// one beyond the last is new. Empty coordinates, or min = inf and max = -inf, stand for an absent box, and a
// line with nothing but a frame for a frame in which nothing changes.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "lab/readers/csv.hpp"
#include "lab/readers/format.hpp"
#include "lab/readers/shown.hpp"

namespace broadside::lab::readers {
namespace {

/// The rows of a table, one after the other.
template <int D, typename Real>
class CsvRows {
 public:
  explicit CsvRows(CsvTable table) : table_(std::move(table)), is_computed_(table_.columns.is_computed()) {}

  /// Whether there was another row; what follows is then of that one.
  bool next() {
    if (!table_.lines.next()) return false;
    take();
    return true;
  }

  const CsvLines& lines() const noexcept { return table_.lines; }

  /// Whether there is more in the row than the number of a frame.
  bool has_box() const noexcept { return (filled_ & ~(1U << CsvColumns::frame)) != 0; }

  /// The whole number in column `place`.
  std::size_t whole_number(int place) const {
    if ((filled_ >> place & 1) == 0) refuse_number(place);
    return whole_[static_cast<std::size_t>(place)];
  }

  Box<D, Real> box() const {
    if ((filled_ & bounds) == 0) return absent_box<D, Real>();
    if ((filled_ & bounds) != bounds) refuse_empty();
    Box<D, Real> box;
    for (std::size_t axis = 0; axis < D; ++axis) {
      const auto [min, max] = bounds_of(table_.columns.forms[axis], values_[CsvColumns::first + axis],
                                        values_[CsvColumns::second + axis]);
      box.min[axis] = static_cast<Real>(min);
      box.max[axis] = static_cast<Real>(max);
    }
    if (!is_present(box) && !is_absent(box)) refuse_inverted(box);
    return box;
  }

  [[noreturn]] void refuse(int place, const std::string& expected) const {
    const std::vector<int>& places = table_.columns.places;
    refuse_column(static_cast<std::size_t>(std::ranges::find(places, place) - places.begin()), expected);
  }

 private:
  /// The bits in filled_ of the values that make a box.
  static constexpr unsigned bounds = ((1U << D) - 1) << CsvColumns::first | ((1U << D) - 1)
                                                                                << CsvColumns::second;

  void take() {
    const std::vector<int>& places = table_.columns.places;
    const std::string_view line = table_.lines.line();
    if (line.empty()) table_.lines.refuse("an empty line", "the columns " + plainly(table_.columns.wanted()));
    const char* at = line.data();
    const char* const end = at + line.size();
    bool more = true;
    filled_ = 0;
    for (std::size_t column = 0; column < places.size(); ++column) {
      if (!more) refuse_count();
      const int place = places[column];
      if (place < CsvColumns::first || !take_number(at, end, more, values_[static_cast<std::size_t>(place)]))
        take_field(column, at, end, more);
      else
        filled_ |= 1U << place;
    }
    if (more) refuse_count();
  }

  /// Takes a number as nearly all are written; anything else is left to take_field.
  bool take_number(const char*& at, const char* end, bool& more, double& value) {
    const Separator separator = table_.separator;
    const char* begin = at;
    while (begin != end && is_padding(*begin, separator)) ++begin;
    const auto [last, error] = parse(begin, end, value);
    // A NaN is no number, and nothing equals it.
    if (error != std::errc() || value != value || !is_held({begin, last}, value)) return false;
    const char* next = last;
    while (next != end && is_padding(*next, separator)) ++next;
    more = next != end;
    if (separator == Separator::blanks) {
      if (more && next == last) return false;
    } else if (more && *next++ != static_cast<char>(separator)) {
      return false;
    }
    at = next;
    return true;
  }

  std::from_chars_result parse(const char* begin, const char* end, double& value) {
    if constexpr (std::is_same_v<Real, float>) {
      // Rounded once: not to a double and then to a float.
      if (!is_computed_) {
        float number = 0;
        const std::from_chars_result result = std::from_chars(begin, end, number);
        value = static_cast<double>(number);
        return result;
      }
    }
    return std::from_chars(begin, end, value);
  }

  /// Whether `value` is what `text` says, if that is a whole number without exponent: so are identifiers and
  /// fixed-point coordinates written, in which nobody expects digits to be lost.
  bool is_held(std::string_view text, double value) const {
    constexpr double exact = 9007199254740992;  // 2^53: up to there every whole number is held
    if ((value < exact && value > -exact) || (std::is_same_v<Real, float> && !is_computed_)) return true;
    return is_whole_number_of(text, value);
  }

  void take_field(std::size_t column, const char*& at, const char* end, bool& more) {
    CsvFields fields(at, end, table_.separator);
    std::string_view field;
    fields.next(field);
    at = fields.at();
    more = fields.more();
    const int place = table_.columns.places[column];
    if (place == CsvColumns::ignored || field.empty()) return;
    const auto where = static_cast<std::size_t>(place);
    if (place < CsvColumns::first) {
      if (!parse_number(field, whole_[where])) refuse_number(place);
    } else if (std::is_same_v<Real, float> && !is_computed_) {
      float number = 0;
      if (!parse_number(field, number)) refuse_number(place);
      values_[where] = static_cast<double>(number);
    } else if (!parse_number(field, values_[where])) {
      refuse_number(place);
    } else if (!is_held(field, values_[where])) {
      refuse(place, "a whole number that a double holds exactly, as all up to 2^53 are");
    }
    filled_ |= 1U << place;
  }

  [[noreturn]] void refuse_number(int place) const {
    if (place < CsvColumns::first) refuse(place, "a whole number from 0 to 4294967295");
    refuse(place, fmt::format("a number that a {} can hold", name(precision_of<Real>)));
  }

  [[noreturn]] void refuse_empty() const {
    const std::vector<int>& places = table_.columns.places;
    const auto empty = std::ranges::find_if(
        places, [&](int place) { return place >= CsvColumns::first && (filled_ >> place & 1) == 0; });
    refuse_number(*empty);
  }

  [[noreturn]] void refuse_count() const {
    const std::size_t found = fields_of(table_.lines.line(), table_.separator).size();
    const std::size_t expected = table_.columns.places.size();
    table_.lines.refuse(fmt::format("{} column{}", found, found == 1 ? "" : "s"),
                        fmt::format("the {} columns {}", expected,
                                    plainly(fmt::to_string(fmt::join(table_.columns.names, ",")))));
  }

  [[noreturn]] void refuse_inverted(const Box<D, Real>& box) const {
    const auto is_nan = [](Real number) { return std::isnan(number); };
    if (std::ranges::any_of(box.min, is_nan) || std::ranges::any_of(box.max, is_nan))
      table_.lines.refuse("infinite numbers that add up to none", "bounds that can be computed");
    table_.lines.refuse(
        fmt::format("min ({}) and max ({})", fmt::join(box.min, ", "), fmt::join(box.max, ", ")),
        fmt::format("min <= max on every axis, {}or no coordinates for an absent box",
                    is_computed_ ? "that is sizes of 0 or more, " : ""));
  }

  [[noreturn]] void refuse_column(std::size_t column, const std::string& expected) const {
    const std::vector<std::string_view> fields = fields_of(table_.lines.line(), table_.separator);
    table_.lines.refuse(
        fmt::format("column {} is {}", plainly(table_.columns.names[column]), shown(fields[column], 100)),
        expected);
  }

  CsvTable table_;
  bool is_computed_;
  unsigned filled_ = 0;  // bit p: the row has a value at place p
  std::array<std::uint32_t, 2> whole_{};
  std::array<double, CsvColumns::places_of_a_row> values_{};
};

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
      boxes.push_back(rows_.box());
      if (boxes.size() != sample) continue;
      // Lines that go on as they began; no more than there can be in the bytes that are there.
      const std::size_t left = rows_.lines().bytes_left();
      const std::size_t bytes_a_row = (before - left) / sample;
      boxes.reserve(sample + left / bytes_a_row + left / bytes_a_row / 32);
    }
    return boxes;
  }

  bool next(Step<D, Real>&) override { return false; }

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

 private:
  /// Whether this frame has another row with a box, whose number is then `place`.
  bool next_change(std::size_t& place) {
    do {
      if (!std::exchange(has_row_, false) && !rows_.next()) return false;
      const std::size_t frame = rows_.whole_number(CsvColumns::frame);
      if (!std::exchange(has_begun_, true) && frame != 0)
        rows_.refuse(CsvColumns::frame, "0: frames are counted from there");
      if (frame == frame_ + 1) {
        has_row_ = true;
        return false;
      }
      if (frame != frame_)
        rows_.refuse(CsvColumns::frame,
                     fmt::format("{} or {}: frames follow one another", frame_, frame_ + 1));
    } while (!rows_.has_box());
    place = rows_.whole_number(CsvColumns::box);
    // Nothing may be left out: a single line must not be able to ask for any amount of memory.
    if (place > last_change_.size())
      rows_.refuse(
          CsvColumns::box,
          fmt::format("a box from 0 to {}: new ones are numbered one after the other", last_change_.size()));
    if (place == last_change_.size())
      last_change_.push_back(frame_);
    else if (last_change_[place] == frame_)
      rows_.refuse(CsvColumns::box, "each box once in a frame");
    last_change_[place] = frame_;
    return true;
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
    if (table.columns.has_frames) return std::make_unique<FramedCsv<D, Real>>(std::move(table));
    return std::make_unique<PlainCsv<D, Real>>(std::move(table));
  });
}

}  // namespace broadside::lab::readers
