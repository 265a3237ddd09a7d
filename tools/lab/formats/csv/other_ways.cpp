// Finds alternative meanings of a table's columns with which all rows are valid.
#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/csv/csv_rows.hpp"
#include "lab/formats/csv/geometry_text.hpp"
#include "lab/formats/text.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab::readers {
namespace {

/// The columns that a list for --columns names.
BoxColumns columns_of(const std::string& list, std::size_t count) {
  std::vector<std::string_view> names = fields_of(list, Separator::comma);
  std::replace(names.begin(), names.end(), std::string_view("-"), std::string_view());
  names.resize(count);
  BoxColumns columns;
  if (!resolve(names, columns, true).empty()) columns.places.clear();
  return columns;
}

bool is_valid(const std::vector<CsvField>& fields, BoxColumns& columns) {
  if (columns.places.size() != fields.size()) return false;
  const RowBox row = box_of(fields, columns);
  if (row.wrong_place != BoxColumns::ignored) return false;
  if (is_absent(row.box)) return true;
  // The first row that shows in which direction y grows decides for all rows.
  if (columns.forms[1] == BoundsForm::bottom_top && row.box.min[1] != row.box.max[1]) {
    settle_top(columns, row.box.max[1] < row.box.min[1]);
    return is_valid(fields, columns);
  }
  return is_present(row.box);
}

}  // namespace

std::string other_ways(CsvLines lines, Separator separator, const std::vector<std::string>& lists) {
  std::vector<std::pair<std::string, BoxColumns>> ways;
  std::vector<CsvField> fields;
  std::uint64_t rows = 0;
  while (lines.next()) {
    split(lines.line(), separator, fields);
    if (fields.size() == 1 && fields.front().text.empty()) continue;
    if (rows++ == 0) {
      for (const std::string& list : lists) ways.emplace_back(list, columns_of(list, fields.size()));
    }
    std::erase_if(ways, [&](auto& way) { return !is_valid(fields, way.second); });
    if (ways.empty()) break;
  }
  if (ways.empty()) return {};
  std::string found;
  for (const auto& [list, columns] : ways) found += fmt::format("{}{}", found.empty() ? "" : " or ", list);
  return fmt::format("; as {} {} valid: say {}", found,
                     rows == 1 ? "the one row is" : fmt::format("all {} rows are", grouped(rows)),
                     ways.size() == 1 ? "--columns=" + found : "which by --columns");
}

std::string few_invalid(CsvLines lines, Separator separator, const BoxColumns& columns) {
  std::vector<CsvField> fields;
  std::uint64_t rows = 0;
  std::uint64_t invalid = 0;
  BoxColumns read = columns;
  while (lines.next()) {
    split(lines.line(), separator, fields);
    if (fields.size() < columns.places.size()) continue;  // blank, or the number of a frame without changes
    ++rows;
    if (!is_valid(fields, read)) ++invalid;
  }
  if (invalid * 3 > rows) return {};  // then the layout is another one
  return fmt::format("; {} of {} rows {} invalid", grouped(invalid), grouped(rows),
                     invalid == 1 ? "is" : "are");
}

std::string other_forms(CsvLines lines, Separator separator, const BoxColumns& columns) {
  if (columns.geometry_form != BoundsForm::min_max) return {};
  const auto column = static_cast<std::size_t>(
      std::find(columns.places.begin(), columns.places.end(), BoxColumns::geometry) - columns.places.begin());
  std::uint64_t rows = 0;
  while (lines.next()) {
    const std::vector<std::string_view> fields = fields_of(lines.line(), separator);
    if (column >= fields.size() || fields[column].empty()) continue;
    const TextGeometry geometry = read_geometry_text(fields[column], BoundsForm::min_size);
    bool is_right = geometry.found.empty() && geometry.dimension == columns.dimension;
    for (int axis = 0; axis < columns.dimension; ++axis)
      is_right = is_right && geometry.box.min[axis] <= geometry.box.max[axis];
    if (!is_right) return {};
    ++rows;
  }
  return fmt::format("; as a corner and the size all {} rows are valid: say --columns={}=xywh", grouped(rows),
                     plainly(columns.names[column]));
}

}  // namespace broadside::lab::readers
