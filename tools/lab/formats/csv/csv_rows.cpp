// Reads the rows of a table.
#include "lab/formats/csv/csv_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>

#include <fmt/format.h>

#include "lab/formats/csv/geometry_text.hpp"
#include "lab/formats/format.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab::readers {

RowBox box_of(const std::vector<CsvField>& fields, const BoxColumns& columns) {
  std::array<double, BoxColumns::places_of_a_row> values{};
  RowBox row;
  bool is_empty = true;
  int missing = BoxColumns::ignored;
  for (std::size_t i = 0; i < columns.places.size(); ++i) {
    const int place = columns.places[i];
    if (place < BoxColumns::first || place >= BoxColumns::id) continue;
    double& value = values[static_cast<std::size_t>(place)];
    if (fields[i].text.empty()) {
      missing = place;
      continue;
    }
    is_empty = false;
    const bool is_number = parse_number(fields[i].text, value);
    if (is_number && is_held(fields[i].text, value)) continue;
    row.wrong_place = place;
    row.is_held = !is_number;
    return row;
  }
  if (is_empty) return row;
  row.wrong_place = missing;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t of = axis < static_cast<std::size_t>(columns.dimension) ? axis : 0;
    std::tie(row.box.min[axis], row.box.max[axis]) = columns.bounds(values, of);
  }
  return row;
}

std::string CsvRows::warning() const {
  const std::string left_out = table_.quarantine.warning(table_.input->name());
  return table_.note + (table_.note.empty() || left_out.empty() ? "" : "\n") + left_out;
}

bool CsvRows::next() {
  do {
    if (!table_.lines.next()) return false;
    split(table_.lines.line(), table_.separator, fields_);
  } while (fields_.size() == 1 && fields_[0].text.empty());
  // Checked here: a skipped row must not hide that later rows are misaligned.
  if (has_open_quote(table_.lines.line(), fields_))
    table_.lines.refuse("a quoted field that goes on in the next line",
                        "each row on one line; to remove quotes that are text: tr -d '\"'");
  return true;
}

DoubleBox3 CsvRows::box() {
  DoubleBox3 box;
  // g++ 12 loses the previous value of `box` if checked_box() throws.
  return holds([&] { box = checked_box(); }) ? box : absent_box<3, double>();
}

void CsvRows::check_count() const {
  const std::size_t found = fields_.size();
  const std::size_t expected = columns().places.size();
  if (found != expected)
    table_.lines.refuse(
        fmt::format("{} column{}{}", found, found == 1 ? "" : "s",
                    found == 2 * expected ? ", as decimal commas would make" : ""),
        fmt::format("the {} columns {}", expected, plainly(fmt::to_string(fmt::join(columns().names, ",")))));
}

namespace {

/// Whether only the first axis descends, by degrees of longitude from east to west of the date line, or from
/// 359 to 1: by half the earth or more, since a row that descends by less has its bounds exchanged.
bool is_across_date_line(std::span<const double> min, std::span<const double> max) {
  return min[0] <= 360 && max[0] >= -180 && min[0] - max[0] >= 180 && min[0] - max[0] <= 360 &&
         std::equal(min.begin() + 1, min.end(), max.begin() + 1, std::less_equal<>());
}

}  // namespace

DoubleBox3 CsvRows::checked_box() const {
  check_count();
  const RowBox row = columns().has_geometry ? RowBox{geometry_box()} : box_of(fields_, columns());
  if (!row.is_held)
    refuse(row.wrong_place, "a whole number that a double holds exactly, as all up to 2^53 are");
  if (row.wrong_place != BoxColumns::ignored) refuse_number(row.wrong_place);
  if (is_absent(row.box) || is_present(row.box)) return row.box;
  const auto axes = static_cast<std::size_t>(columns().dimension);
  const std::span min = std::span(row.box.min).first(axes);
  const std::span max = std::span(row.box.max).first(axes);
  const bool is_across = !columns().is_computed() && is_across_date_line(min, max);
  if (is_across && table_.crosses_date_line) {
    ++table_.labels->across_date_line;
    DoubleBox3 box = row.box;
    box.max[0] += 360;
    if (axes == 2) box.max[2] = box.max[0];
    return box;
  }
  const auto is_nan = [](double number) { return std::isnan(number); };
  if (std::any_of(min.begin(), min.end(), is_nan) || std::any_of(max.begin(), max.end(), is_nan))
    table_.lines.refuse("infinite numbers that add up to none", "bounds that can be computed");
  // A fault in few rows is one of theirs, not of how all are read.
  std::string advice = few_invalid().empty() ? other_ways() : few_invalid();
  if (!few_invalid().empty() && !columns().is_computed() && !is_across)
    advice += "; min and max may be swapped in this row";
  if (is_across && max[0] < 0) advice += "; or --longitude of pairs, if the box is across the date line";
  table_.lines.refuse(fmt::format("min ({}) and max ({})", fmt::join(min, ", "), fmt::join(max, ", ")),
                      fmt::format("min <= max on every axis, {}or no coordinates for an absent box{}",
                                  columns().is_computed() ? "that is, sizes of 0 or more, " : "", advice));
}

DoubleBox3 CsvRows::geometry_box() const {
  const std::string_view text = field(BoxColumns::geometry);
  if (text.empty()) return absent_box<3, double>();
  TextGeometry geometry = read_geometry_text(text, columns().geometry_form);
  if (geometry.found.empty() && geometry.dimension != columns().dimension) {
    geometry.found = fmt::format(", which is in {}D", geometry.dimension);
    geometry.expected = fmt::format("{}D, as in the rows before", columns().dimension);
  }
  if (!geometry.found.empty())
    table_.lines.refuse(column_text(BoxColumns::geometry) + geometry.found, geometry.expected);
  if (geometry.dimension == 2) {
    geometry.box.min[2] = geometry.box.min[0];
    geometry.box.max[2] = geometry.box.max[0];
  }
  return geometry.box;
}

bool CsvRows::is_frame_alone() const {
  for (std::size_t i = 0; i < std::min(fields_.size(), columns().places.size()); ++i) {
    const int place = columns().places[i];
    if (place != BoxColumns::ignored && place != BoxColumns::frame && !fields_[i].text.empty()) return false;
  }
  return true;
}

double CsvRows::number(int place) const {
  double value = 0;
  if (!parse_number(field(place), value)) refuse_number(place);
  return value;
}

std::size_t CsvRows::whole_number(int place) const {
  const double value = number(place);
  constexpr double max_id = 4294967295;
  if (!(value >= 0 && value <= max_id) || value != std::floor(value)) refuse_number(place);
  return static_cast<std::size_t>(value);
}

std::string CsvRows::text(int place) const {
  const std::size_t column = column_of(place);
  return column < fields_.size() ? unquoted(fields_[column]) : "";
}

void CsvRows::keep_id(std::size_t place) {
  if (!table_.labels->has_ids) return;
  std::vector<std::string>& ids = table_.labels->ids;
  if (ids.size() <= place) ids.resize(place + 1);
  if (std::string id = text(BoxColumns::id); !id.empty()) ids[place] = std::move(id);
}

bool CsvRows::take_slice(std::size_t slice, std::size_t slices) {
  if (table_.quarantine.leaves_out() && slices > 1) return false;
  table_.lines.take_slice(slice, slices);
  return true;
}

std::size_t CsvRows::column_of(int place) const noexcept {
  const std::vector<int>& places = columns().places;
  return static_cast<std::size_t>(std::find(places.begin(), places.end(), place) - places.begin());
}

std::string_view CsvRows::field(int place) const {
  const std::size_t column = column_of(place);
  return column < fields_.size() ? fields_[column].text : std::string_view();
}

/// "column min_x is 'one'".
std::string CsvRows::column_text(int place) const {
  return fmt::format("column {} is {}", plainly(columns().names[column_of(place)]), shown(field(place), 100));
}

void CsvRows::refuse(int place, const std::string& expected) const {
  table_.lines.refuse(column_text(place), expected);
}

void CsvRows::refuse_number(int place) const {
  NumberFault fault = number_fault(field(place));
  const bool is_whole = place < BoxColumns::first && !columns().has_tracks;
  if (fault.expected.empty())
    fault.expected = is_whole                     ? "a whole number from 0 to 4294967295"
                     : place == BoxColumns::frame ? "a number"
                                                  : "a number that a double can hold";
  table_.lines.refuse(column_text(place) + (fault.found.empty() ? "" : ", " + fault.found),
                      fault.expected + (place < BoxColumns::first ? "" : other_ways()));
}

/// Computed once, as other_ways() is.
const std::string& CsvRows::few_invalid() const {
  if (!few_invalid_)
    few_invalid_ = columns().has_geometry ? "" : readers::few_invalid(begin_, table_.separator, columns());
  return *few_invalid_;
}

/// Computed once, not for each invalid row that is left out, because it reads all rows.
const std::string& CsvRows::other_ways() const {
  if (!other_ways_)
    other_ways_ = columns().has_geometry ? other_forms(begin_, table_.separator, columns())
                                         : readers::other_ways(begin_, table_.separator, table_.others);
  return *other_ways_;
}

}  // namespace broadside::lab::readers
