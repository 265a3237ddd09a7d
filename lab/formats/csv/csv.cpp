// Boxes as text: comma-separated values and their kin. The columns' names tell what they are.
#include "lab/formats/csv/csv.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/descriptions.hpp"
#include "lab/formats/map/geometry_text.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab::readers {
namespace {

using Fields = std::vector<std::string_view>;

constexpr const char* expected_columns =
    "columns such as 'min_x,min_y,max_x,max_y' or 'center_x,center_y,width,height', with z or without, in "
    "any order, with or without 'frame,box' or 'frame,id'; or points 'x,y', or 'wkt' or 'bbox'";

bool is_number(std::string_view field) {
  double value = 0;
  return parse_number(field, value);
}

/// Whether a line stands before the table: it is empty or a comment.
bool is_before(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == std::string_view::npos || line[first] == '#';
}

/// Whether a field is more likely a geometry or bounds than their column's name.
bool is_geometry(std::string_view field) { return field.find_first_of("([") != std::string_view::npos; }

bool is_table_row(const Fields& fields) {
  return std::ranges::any_of(fields, is_geometry) ||
         std::ranges::all_of(fields, [](std::string_view field) { return field.empty(); }) ||
         std::ranges::any_of(fields, is_number);
}

/// The columns that a comment before rows of numbers names, as numpy.savetxt writes it.
bool resolve_comment(std::string_view comment, std::size_t count, CsvColumns& columns) {
  comment.remove_prefix(std::min(comment.find_first_not_of("# \t"), comment.size()));
  const Fields names = fields_of(comment, separator_of(comment));
  return names.size() == count && resolve(names, columns).empty();
}

/// The columns that the user names, from left to right; `count` is the number of columns there are.
CsvColumns columns_of_user(const std::string& list, std::size_t count, const CsvLines& lines) {
  Fields names = fields_of(list, Separator::comma);
  for (std::string_view& name : names) {
    if (name == "-") name = {};
  }
  if (names.size() > count)
    lines.refuse(fmt::format("{} column{}", count, count == 1 ? "" : "s"),
                 fmt::format("the {} that --columns names", names.size()));
  names.resize(count);
  CsvColumns columns;
  const std::string problem = resolve(names, columns);
  if (!problem.empty())
    lines.refuse(fmt::format("--columns names '{}': {}", list, problem), expected_columns);
  return columns;
}

/// The dimension of the first geometry; 2 if there is none.
int dimension_of_geometries(CsvLines lines, Separator separator, const CsvColumns& columns) {
  const auto column = static_cast<std::size_t>(std::ranges::find(columns.places, CsvColumns::geometry) -
                                               columns.places.begin());
  while (lines.next()) {
    const Fields fields = fields_of(lines.line(), separator);
    if (column < fields.size() && !fields[column].empty()) return dimension_of_geometry_text(fields[column]);
  }
  return 2;
}

/// Finds the column of ids, by its very name or another spelling of it, and lists the columns that nothing is
/// read from.
std::shared_ptr<BoxLabels> find_labels(const ReadOptions& options, const CsvLines& lines,
                                       CsvColumns& columns) {
  auto labels = std::make_shared<BoxLabels>();
  const std::vector<std::string>& names = columns.names;
  std::string_view wanted = options.ids;
  if (wanted.empty() && options.finds_ids) {
    const auto track = std::ranges::find(columns.places, CsvColumns::track);
    wanted = track == columns.places.end() ? std::string_view("id")
                                           : names[static_cast<std::size_t>(track - columns.places.begin())];
  }
  if (!wanted.empty()) {
    auto column = std::ranges::find(names, wanted);
    if (column == names.end())
      column = std::ranges::find(names, plain(wanted), [](const std::string& name) { return plain(name); });
    if (column == names.end() && !options.ids.empty())
      lines.refuse(fmt::format("no column {} of ids", shown(wanted)),
                   fmt::format("one of: {}", plainly(fmt::to_string(fmt::join(names, ", ")))));
    if (column != names.end()) {
      int& place = columns.places[static_cast<std::size_t>(column - names.begin())];
      if (place != CsvColumns::ignored && place != CsvColumns::track)
        lines.refuse(fmt::format("column {} is read already, and --ids names it", shown(*column)),
                     "a column of its own for the ids");
      if (place == CsvColumns::ignored) place = CsvColumns::id;
      labels->has_ids = true;
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (columns.places[i] == CsvColumns::ignored && !names[i].empty()) labels->unread.push_back(names[i]);
  }
  return labels;
}

AnyFrameReader open_csv(std::unique_ptr<Input> input, const ReadOptions& options) {
  CsvLines lines(*input);
  CsvLines rows = lines;
  std::string_view comment;
  while (true) {
    if (!lines.next())
      throw FileError(fmt::format("{}: {}; expected a table with {}", input->name(),
                                  input->bytes().empty() ? "is empty" : "has no line but comments",
                                  expected_columns));
    if (lines.line().find('\r') != std::string_view::npos)
      lines.refuse("a carriage return within the line", "lines that end with a line feed");
    if (!is_before(lines.line())) break;
    comment = lines.line();
    rows = lines;
  }
  Separator separator = separator_of(lines.line());
  // The blanks of a geometry that is alone in its line separate nothing.
  if (separator == Separator::blanks && is_geometry_name(fields_of(lines.line(), separator).front()))
    separator = Separator::tab;
  const Fields fields = fields_of(lines.line(), separator);
  CsvColumns columns;
  bool has_header = false;
  if (!options.columns.empty()) {
    columns = columns_of_user(options.columns, fields.size(), lines);
    // A row in which one of several numbers is wrong is not taken for names.
    Fields wanted;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (columns.places[i] != CsvColumns::ignored) wanted.push_back(fields[i]);
    }
    has_header = !is_table_row(wanted);
  } else {
    std::string problem = resolve(fields, columns);
    has_header = problem.empty();
    if (!has_header && is_table_row(fields) && !resolve_comment(comment, fields.size(), columns)) {
      problem = positional(fields.size(), columns);
      if (!problem.empty())
        lines.refuse(problem, "4, which are min_x,min_y,max_x,max_y, or 6 in 3D, or names with --columns");
    } else if (!has_header && !is_table_row(fields)) {
      const auto slip = std::ranges::find_if(
          fields, [](std::string_view field) { return !number_fault(field).expected.empty(); });
      if (slip != fields.end())
        lines.refuse(fmt::format("{}, {}", shown(*slip), number_fault(*slip).found),
                     number_fault(*slip).expected);
      lines.refuse(fmt::format("{}: {}", shown(lines.line(), 100), problem),
                   fmt::format("{}; --columns can name them", expected_columns));
    }
  }
  if (columns.has_geometry)
    columns.dimension = dimension_of_geometries(has_header ? lines : rows, separator, columns);
  std::shared_ptr<BoxLabels> labels = find_labels(options, lines, columns);
  return read_csv({std::move(input), has_header ? lines : rows, separator, std::move(columns),
                   std::move(labels), !options.ids.empty(), Quarantine(options)},
                  options.precision.value_or(Precision::float64));
}

/// Whether the first line that says something is that of a table.
bool is_csv(std::string_view bytes, std::string_view extension) {
  if (extension == ".csv") return true;
  Input input("", bytes);
  CsvLines lines(input);
  do {
    if (!lines.next()) return false;
  } while (is_before(lines.line()));
  Fields fields = fields_of(lines.line(), separator_of(lines.line()));
  // What was cut off may be half a number.
  if (lines.bytes_left() == 0 && bytes.size() == Input::beginning_bytes) fields.pop_back();
  if (fields.size() < 2) return false;
  return std::ranges::count_if(fields, is_column_name) >= 2 ||
         std::ranges::any_of(fields, is_geometry_name) ||
         (std::ranges::any_of(fields, is_number) && std::ranges::all_of(fields, [](std::string_view field) {
            return field.empty() || is_number(field);
          }));
}

}  // namespace

Format csv() {
  return {
      .name = "csv",
      .summary = "boxes as a table of text",
      .extensions = {".csv"},
      .has_columns = true,
      .can_skip = true,
      .has_ids = true,
      .recognises = is_csv,
      .open = open_csv,
      .create = write_csv,
      .keeps_ids = true,
  };
}

}  // namespace broadside::lab::readers
