// Finds other meanings of a table's columns in which all rows are valid.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/csv/csv.hpp"
#include "lab/formats/csv/geometry_text.hpp"
#include "lab/formats/text.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab::readers {
namespace {

/// The columns that a list for --columns names.
BoxColumns columns_of(const std::string& list, std::size_t count) {
  std::vector<std::string_view> names = fields_of(list, Separator::comma);
  for (std::string_view& name : names) {
    if (name == "-") name = {};
  }
  names.resize(count);
  BoxColumns columns;
  if (!resolve(names, columns, true).empty()) columns.places.clear();
  return columns;
}

bool is_valid(const std::vector<std::string_view>& fields, BoxColumns& columns) {
  std::array<double, BoxColumns::places_of_a_row> values{};
  bool is_empty = true;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const int place = columns.places[i];
    if (place == BoxColumns::ignored || place >= BoxColumns::id) continue;
    if (fields[i].empty()) {
      values[static_cast<std::size_t>(place)] = NAN;
      continue;
    }
    if (place >= BoxColumns::first) is_empty = false;
    if (!parse_number(fields[i], values[static_cast<std::size_t>(place)])) return false;
  }
  if (is_empty) return true;
  // The first row that shows in which direction y grows decides for all rows.
  if (const double bottom = values[BoxColumns::first + 1], top = values[BoxColumns::second + 1];
      columns.forms[1] == BoundsForm::bottom_top && bottom != top) {
    settle_top(columns, top < bottom);
    return is_valid(fields, columns);
  }
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(columns.dimension); ++axis) {
    const auto [min, max] = columns.bounds(values, axis);
    if (!(min <= max)) return false;
  }
  return true;
}

}  // namespace

std::string other_ways(CsvLines lines, Separator separator, const std::vector<std::string>& lists) {
  std::vector<std::pair<std::string, BoxColumns>> ways;
  std::uint64_t rows = 0;
  while (lines.next()) {
    const std::vector<std::string_view> fields = fields_of(lines.line(), separator);
    if (fields.size() == 1 && fields.front().empty()) continue;
    if (rows++ == 0) {
      for (const std::string& list : lists) ways.emplace_back(list, columns_of(list, fields.size()));
    }
    std::erase_if(ways, [&](auto& way) {
      return way.second.places.size() != fields.size() || !is_valid(fields, way.second);
    });
    if (ways.empty()) return {};
  }
  if (ways.empty()) return {};
  std::string found;
  for (const auto& [list, columns] : ways) found += fmt::format("{}{}", found.empty() ? "" : " or ", list);
  return fmt::format("; as {} {} valid: say {}", found,
                     rows == 1 ? "the one row is" : fmt::format("all {} rows are", grouped(rows)),
                     ways.size() == 1 ? "--columns=" + found : "which by --columns");
}

std::string other_forms(CsvLines lines, Separator separator, const BoxColumns& columns) {
  if (columns.geometry_form != BoundsForm::min_max) return {};
  const auto column = static_cast<std::size_t>(std::ranges::find(columns.places, BoxColumns::geometry) -
                                               columns.places.begin());
  std::uint64_t rows = 0;
  while (lines.next()) {
    const std::vector<std::string_view> fields = fields_of(lines.line(), separator);
    if (column >= fields.size() || fields[column].empty()) continue;
    DoubleBox3 solid;
    DoubleBox2 flat;
    const bool is_read =
        columns.dimension == 3
            ? read_geometry_text(fields[column], solid, BoundsForm::min_size).found.empty() &&
                  is_present(solid)
            : read_geometry_text(fields[column], flat, BoundsForm::min_size).found.empty() &&
                  is_present(flat);
    if (!is_read) return {};
    ++rows;
  }
  return fmt::format("; as a corner and the size all {} rows are valid: say --columns={}=xywh", grouped(rows),
                     plainly(columns.names[column]));
}

}  // namespace broadside::lab::readers
