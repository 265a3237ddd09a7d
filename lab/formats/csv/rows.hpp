// The rows of a table, straight from its bytes. No row takes memory.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/csv/csv.hpp"
#include "lab/formats/format.hpp"
#include "lab/formats/csv/geometry_text.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab::readers {

/// The rows of a table, one after the other.
template <int D, typename Real>
class CsvRows {
 public:
  explicit CsvRows(CsvTable table)
      : table_(std::move(table)),
        is_computed_(table_.columns.is_computed()),
        needed_(table_.columns.needed()) {}

  /// Whether there was another row; read() then reads the rest of it. Blank lines are not rows.
  bool next() {
    do {
      if (!table_.lines.next()) return false;
    } while (is_blank(table_.lines.line()));
    // Here, since no row to be skipped may hide that the rows after it are counted wrong.
    if (has_open_quote(table_.lines.line(), table_.separator))
      table_.lines.refuse("a quoted field that goes on in the next line",
                          "each row on one line; to remove quotes that are text: tr -d '\"'");
    return true;
  }

  /// Reads the row; what follows is then of that one. Where it is invalid and is to be left out, its box is
  /// absent, and the other columns say what they can; false if they are invalid as well.
  bool read() {
    return holds([this] { take(); }) || take_labels();
  }

  /// Whether `check()` finds nothing wrong that the row is to be left out for.
  template <typename Check>
  bool holds(const Check& check) {
    return table_.quarantine.holds(check);
  }

  const CsvLines& lines() const noexcept { return table_.lines; }

  /// Says that the rows up to here will not be looked at again.
  void release() { table_.input->release(table_.lines.passed_bytes()); }

  /// Leaves out the rows but those of a slice; false where invalid rows are left out, which are counted.
  bool take_slice(std::size_t slice, std::size_t slices) {
    if (table_.quarantine.leaves_out() && slices > 1) return false;
    table_.lines.take_slice(slice, slices);
    return true;
  }

  /// Whether bounds are computed from other numbers.
  bool is_computed() const noexcept { return is_computed_; }

  std::shared_ptr<const BoxLabels> labels() const { return table_.labels; }

  std::string warning() const {
    const std::string left_out = table_.quarantine.warning(table_.input->name());
    return table_.note + (table_.note.empty() || left_out.empty() ? "" : "\n") + left_out;
  }

  /// Keeps the row's id, if it has one, as that of the box at `place`.
  void keep_id(std::size_t place) {
    if (!table_.labels->has_ids) return;
    std::vector<std::string>& ids = table_.labels->ids;
    if (ids.size() <= place) ids.resize(place + 1);
    if (!id_.empty()) ids[place] = id_;
  }

  /// Whether there is more in the row than the number of a frame.
  bool has_box() const noexcept { return (filled_ & ~(1U << BoxColumns::frame)) != 0; }

  /// The whole number in column `place`.
  std::size_t whole_number(int place) const {
    if ((filled_ >> place & 1) == 0) refuse_number(place);
    return whole_[static_cast<std::size_t>(place)];
  }

  /// The row's box, absent where it is invalid and is to be left out.
  Box<D, Real> box() {
    Box<D, Real> box;
    // g++ 12 drops a value that `box` had before, where made_box() throws.
    return holds([&] { box = made_box(); }) ? box : absent_box<D, Real>();
  }

  const std::string& track() const {
    if (track_.empty()) refuse(BoxColumns::track, "an id");
    return track_;
  }

  const std::string& id() const noexcept { return id_; }

  bool has_column(int place) const noexcept {
    return std::ranges::find(table_.columns.places, place) != table_.columns.places.end();
  }

  /// The frame of a table with tracks: any number.
  double frame() const {
    if ((filled_ & 1U << BoxColumns::frame) == 0) refuse_number(BoxColumns::frame);
    return values_[BoxColumns::frame];
  }

  [[noreturn]] void refuse(int place, const std::string& expected) const {
    table_.lines.refuse(column_text(place), expected);
  }

 private:
  bool is_blank(std::string_view line) const {
    return line.empty() ||
           (is_padding(line.front(), table_.separator) &&
            std::ranges::all_of(line, [this](char c) { return is_padding(c, table_.separator); }));
  }

  Box<D, Real> made_box() const {
    if ((filled_ & needed_) == 0) return absent_box<D, Real>();
    if ((filled_ & needed_) != needed_) refuse_empty();
    Box<D, Real> box = text_box_;
    for (std::size_t axis = 0; axis < D && !table_.columns.has_geometry; ++axis) {
      const auto [min, max] = table_.columns.bounds(values_, axis);
      box.min[axis] = static_cast<Real>(min);
      box.max[axis] = static_cast<Real>(max);
    }
    if (is_absent(box)) return box;
    if (!is_present(box)) refuse_inverted(box);
    return box;
  }

  /// Reads what the row has besides its box, as far as it has columns. Whether that is right.
  bool take_labels() {
    const auto take_label = [this](int place, const char*& at, const char* end, bool& more) {
      const bool is_label =
          place != BoxColumns::geometry && (place < BoxColumns::first || place >= BoxColumns::id);
      take_field(is_label ? place : BoxColumns::ignored, at, end, more);
    };
    try {
      take_columns(take_label);
    } catch (const FileError&) {
      return false;
    }
    return true;
  }

  void take() {
    const auto take_value = [this](int place, const char*& at, const char* end, bool& more) {
      if (!is_value(place) || !take_number(at, end, more, values_[static_cast<std::size_t>(place)]))
        take_field(place, at, end, more);
      else
        filled_ |= 1U << place;
    };
    if (!take_columns(take_value)) refuse_count();
  }

  /// Takes the line's fields by `take(place, at, end, more)`. Whether there are as many as columns.
  template <typename Take>
  bool take_columns(const Take& take) {
    const std::string_view line = table_.lines.line();
    const char* at = line.data();
    const char* const end = at + line.size();
    bool more = true;
    filled_ = 0;
    id_.clear();
    track_.clear();
    for (const int place : table_.columns.places) {
      if (!more) return false;
      take(place, at, end, more);
    }
    return !more;
  }

  /// Whether a place is one of a number of a box.
  static constexpr bool is_value(int place) noexcept {
    return place >= BoxColumns::first && place < static_cast<int>(BoxColumns::places_of_a_row);
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
  /// fixed-point coordinates written, which must not lose digits.
  bool is_held(std::string_view text, double value) const {
    constexpr double exact = 9007199254740992;  // 2^53: up to there every whole number is held
    if ((value < exact && value > -exact) || (std::is_same_v<Real, float> && !is_computed_)) return true;
    return is_whole_number_of(text, value);
  }

  /// Takes a field in any way in which it may be written, for the place that it has in a row.
  void take_field(int place, const char*& at, const char* end, bool& more) {
    CsvFields fields(at, end, table_.separator);
    std::string_view field;
    fields.next(field);
    at = fields.at();
    more = fields.more();
    if (place == BoxColumns::ignored || field.empty()) return;
    filled_ |= 1U << place;
    if (place == BoxColumns::id || place == BoxColumns::track) {
      fields.read_text(field, place == BoxColumns::id ? id_ : track_);
      return;
    }
    if (place == BoxColumns::geometry) {
      take_geometry(field);
      return;
    }
    const auto where = static_cast<std::size_t>(place);
    if (place == BoxColumns::frame && table_.columns.has_tracks) {
      if (!parse_number(field, values_[where])) refuse_number(place);
    } else if (place < BoxColumns::first) {
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
  }

  void take_geometry(std::string_view field) {
    const GeometryFault fault = read_geometry_text(field, text_box_, table_.columns.geometry_form);
    if (!fault.found.empty())
      table_.lines.refuse(column_text(BoxColumns::geometry) + fault.found, fault.expected);
  }

  [[noreturn]] void refuse_number(int place) const {
    NumberFault fault = number_fault(field_of(place));
    if (fault.expected.empty())
      fault.expected = place == BoxColumns::frame && table_.columns.has_tracks ? "a number"
                       : place < BoxColumns::first
                           ? "a whole number from 0 to 4294967295"
                           : fmt::format("a number that a {} can hold", name(precision_of<Real>));
    table_.lines.refuse(column_text(place) + (fault.found.empty() ? "" : ", " + fault.found),
                        fault.expected + (place < BoxColumns::first ? "" : other_ways()));
  }

  std::size_t column_of(int place) const {
    const std::vector<int>& places = table_.columns.places;
    return static_cast<std::size_t>(std::ranges::find(places, place) - places.begin());
  }

  std::string_view field_of(int place) const {
    return fields_of(table_.lines.line(), table_.separator)[column_of(place)];
  }

  /// "column min_x is 'one'".
  std::string column_text(int place) const {
    return fmt::format("column {} is {}", plainly(table_.columns.names[column_of(place)]),
                       shown(field_of(place), 100));
  }

  [[noreturn]] void refuse_empty() const {
    int place = BoxColumns::first;
    while ((needed_ & ~filled_ & 1U << place) == 0) ++place;
    refuse_number(place);
  }

  [[noreturn]] void refuse_count() const {
    const std::size_t found = fields_of(table_.lines.line(), table_.separator).size();
    const std::size_t expected = table_.columns.places.size();
    table_.lines.refuse(fmt::format("{} column{}{}", found, found == 1 ? "" : "s",
                                    found == 2 * expected ? ", as decimal commas would make" : ""),
                        fmt::format("the {} columns {}", expected,
                                    plainly(fmt::to_string(fmt::join(table_.columns.names, ",")))));
  }

  [[noreturn]] void refuse_inverted(const Box<D, Real>& box) const {
    const auto is_nan = [](Real number) { return std::isnan(number); };
    if (std::ranges::any_of(box.min, is_nan) || std::ranges::any_of(box.max, is_nan))
      table_.lines.refuse("infinite numbers that add up to none", "bounds that can be computed");
    table_.lines.refuse(
        fmt::format("min ({}) and max ({})", fmt::join(box.min, ", "), fmt::join(box.max, ", ")),
        fmt::format("min <= max on every axis, {}or no coordinates for an absent box{}",
                    is_computed_ ? "that is, sizes of 0 or more, " : "", other_ways()));
  }

  /// As the function of that name. Once, not for each invalid row that is left out: it reads all rows.
  const std::string& other_ways() const {
    if (!other_ways_)
      other_ways_ = table_.columns.has_geometry
                        ? other_forms(table_.begin, table_.separator, table_.columns)
                        : readers::other_ways(table_.begin, table_.separator, table_.others);
    return *other_ways_;
  }

  CsvTable table_;
  mutable std::optional<std::string> other_ways_;
  bool is_computed_;
  unsigned needed_;      // bit p: a box takes the value at place p
  unsigned filled_ = 0;  // bit p: the row has a value at place p
  std::array<std::uint32_t, 2> whole_{};
  std::array<double, BoxColumns::places_of_a_row> values_{};
  std::string id_;
  std::string track_;
  Box<D, Real> text_box_{};
};

}  // namespace broadside::lab::readers
