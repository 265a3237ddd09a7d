// Boxes as text: comma-separated values and their kin. The columns' names tell what they are.
#include "lab/formats/csv/csv.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/descriptions.hpp"
#include "lab/formats/csv/geometry_text.hpp"
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
bool resolve_comment(std::string_view comment, std::size_t count, BoxColumns& columns) {
  comment.remove_prefix(std::min(comment.find_first_not_of("# \t"), comment.size()));
  const Fields names = fields_of(comment, separator_of(comment));
  return names.size() == count && resolve(names, columns).empty();
}

/// The meaning of a box's numbers, under the names that torchvision made common.
struct Convention {
  std::string_view name;
  BoundsForm form;
  std::string_view columns;
};
constexpr auto conventions = std::to_array<Convention>({
    {"xyxy", BoundsForm::min_max, "min_x,min_y,max_x,max_y"},
    {"xywh", BoundsForm::min_size, "x,y,w,h"},
    {"cxcywh", BoundsForm::centre_size, "cx,cy,w,h"},
    {"xyzxyz", BoundsForm::min_max, "min_x,min_y,min_z,max_x,max_y,max_z"},
    {"xyzwhd", BoundsForm::min_size, "x,y,z,w,h,d"},
    {"cxcyczwhd", BoundsForm::centre_size, "cx,cy,cz,w,h,d"},
});

const Convention* find_convention(std::string_view name) {
  const auto* const found = std::ranges::find(conventions, name, &Convention::name);
  return found == conventions.end() ? nullptr : found;
}

/// The order of the numbers in a field of bounds.
std::optional<BoundsForm> form_named(std::string_view name) {
  const Convention* const convention = find_convention(name);
  return convention == nullptr ? std::nullopt : std::optional(convention->form);
}

/// The columns of bounds in a file with names, as a convention says.
BoxColumns columns_of_convention(const Convention& convention, const Fields& fields, const CsvLines& lines) {
  Fields names = fields;
  if (convention.form == BoundsForm::centre_size) {
    for (std::string_view& name : names) {
      if (plain(name) == "x") name = "cx";
      if (plain(name) == "y") name = "cy";
      if (plain(name) == "z") name = "cz";
    }
  }
  BoxColumns columns;
  std::string problem = resolve(names, columns, true);
  columns.geometry_form = convention.form;
  const auto is_such = [&](BoundsForm form) {
    return form == convention.form ||
           (form == BoundsForm::bottom_top && convention.form == BoundsForm::min_max);
  };
  if (problem.empty() && !columns.has_geometry &&
      !std::all_of(columns.forms.begin(), columns.forms.begin() + columns.dimension, is_such))
    problem = "other columns of bounds";
  if (!problem.empty())
    lines.refuse(fmt::format("--columns is '{}': {}", convention.name, problem),
                 fmt::format("columns such as {}", convention.columns));
  return columns;
}

/// The columns that the user names, from left to right. Or, as "bbox=xywh", the order of the numbers in the
/// file's column of that name; or, as "xywh", the meaning of its columns of bounds.
BoxColumns columns_of_user(std::string_view list, const Fields& fields, const CsvLines& lines) {
  if (const Convention* const convention = find_convention(list)) {
    if (!is_table_row(fields)) return columns_of_convention(*convention, fields, lines);
    list = convention->columns;
  }
  const std::size_t count = fields.size();
  Fields names = fields_of(list, Separator::comma);
  BoundsForm form = BoundsForm::min_max;
  for (std::string_view& name : names) {
    if (name == "-") name = {};
    const std::size_t equals = name.find('=');
    if (equals == std::string_view::npos) continue;
    const std::optional<BoundsForm> told = form_named(name.substr(equals + 1));
    name = name.substr(0, equals);
    if (!told || !is_geometry_name(name))
      lines.refuse(fmt::format("--columns names '{}'", list), "bbox=xyxy, bbox=xywh or bbox=cxcywh");
    form = *told;
    // In a file with names, the column is found by its name, and other columns of bounds are ignored.
    if (names.size() != 1 || std::ranges::find(fields, name) == fields.end()) continue;
    const std::string_view wanted = name;
    names = fields;
    for (std::string_view& other : names) {
      if (other != wanted && (meaning_of(other) || is_geometry_name(other))) other = {};
    }
    break;
  }
  if (names.size() > count)
    lines.refuse(fmt::format("{} column{}", count, count == 1 ? "" : "s"),
                 fmt::format("the {} that --columns names", names.size()));
  names.resize(count);
  BoxColumns columns;
  const std::string problem = resolve(names, columns, true);
  columns.geometry_form = form;
  if (!problem.empty())
    lines.refuse(fmt::format("--columns names '{}': {}", list, problem), expected_columns);
  return columns;
}

std::size_t column_of(const BoxColumns& columns, int place) {
  return static_cast<std::size_t>(std::ranges::find(columns.places, place) - columns.places.begin());
}

/// The first geometry; empty if there is none.
std::string_view first_geometry(CsvLines lines, Separator separator, const BoxColumns& columns) {
  const std::size_t column = column_of(columns, BoxColumns::geometry);
  while (lines.next()) {
    const Fields fields = fields_of(lines.line(), separator);
    if (column < fields.size() && !fields[column].empty()) return fields[column];
  }
  return {};
}

/// Looks for the first row that shows in which direction y grows.
void settle_top(CsvLines lines, Separator separator, BoxColumns& columns) {
  const std::size_t bottom = column_of(columns, BoxColumns::first + 1);
  const std::size_t top = column_of(columns, BoxColumns::second + 1);
  while (columns.forms[1] == BoundsForm::bottom_top && lines.next()) {
    const Fields fields = fields_of(lines.line(), separator);
    double bottom_y = 0;
    double top_y = 0;
    if (std::max(bottom, top) < fields.size() && parse_number(fields[bottom], bottom_y) &&
        parse_number(fields[top], top_y) && bottom_y != top_y && std::isfinite(bottom_y) &&
        std::isfinite(top_y))
      readers::settle_top(columns, top_y < bottom_y);
  }
  readers::settle_top(columns, false);
}

/// How ambiguous columns were read; empty if the columns are not ambiguous.
std::string note_on(const BoxColumns& columns, std::string_view geometry, bool are_chosen, bool are_named) {
  const auto name_at = [&columns](int place) {
    const std::size_t column = column_of(columns, place);
    return column < columns.names.size() ? shown(columns.names[column]) : std::string();
  };
  if (columns.has_frames && columns.has_tracks && name_at(BoxColumns::track).empty())
    return "no column of ids: the boxes of each frame are numbered anew";
  if (are_chosen) return {};
  if (!are_named)
    return fmt::format(
        "no names of columns: read as {}{}", columns.wanted(),
        columns.names.size() == 4 ? "; --columns x,y,w,h if they are a corner and the size" : "");
  const bool is_list = !geometry.empty() &&
                       std::string_view("[( +-.0123456789").find(geometry.front()) != std::string_view::npos;
  if (columns.has_geometry && is_list)
    return fmt::format(
        "column {} read as minima and then maxima; --columns {}=xywh if it is a corner and the size",
        name_at(BoxColumns::geometry), plainly(columns.names[column_of(columns, BoxColumns::geometry)]));
  if (!columns.has_geometry && columns.forms[0] == BoundsForm::point)
    return fmt::format("no columns of bounds: each row is a point, with x from {} and y from {}{}",
                       name_at(BoxColumns::first), name_at(BoxColumns::first + 1),
                       columns.dimension == 3 ? " and z from " + name_at(BoxColumns::first + 2) : "");
  return {};
}

/// Whether a row is one of KITTI's object labels: a class, and 14 or 15 numbers.
bool is_kitti(const Fields& fields) {
  return (fields.size() == 15 || fields.size() == 16) && !is_number(fields.front()) &&
         std::all_of(fields.begin() + 1, fields.end(), is_number);
}

/// Finds the column of ids, by its very name or another spelling of it, and lists the columns that nothing is
/// read from.
std::shared_ptr<BoxLabels> find_labels(const ReadOptions& options, const CsvLines& lines,
                                       BoxColumns& columns) {
  auto labels = std::make_shared<BoxLabels>();
  const std::vector<std::string>& names = columns.names;
  std::string_view wanted = options.ids;
  if (wanted.empty() && options.finds_ids) {
    const auto track = std::ranges::find(columns.places, BoxColumns::track);
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
      if (place != BoxColumns::ignored && place != BoxColumns::track)
        lines.refuse(fmt::format("column {} is read already, and --ids names it", shown(*column)),
                     "a column of its own for the ids");
      if (place == BoxColumns::ignored) place = BoxColumns::id;
      labels->has_ids = true;
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (columns.places[i] == BoxColumns::ignored && !names[i].empty()) labels->unread.push_back(names[i]);
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
  BoxColumns columns;
  bool has_header = false;
  bool are_named = true;
  if (!options.columns.empty()) {
    columns = columns_of_user(options.columns, fields, lines);
    // A row in which one of several numbers is wrong is not taken for names.
    Fields wanted;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (columns.places[i] != BoxColumns::ignored) wanted.push_back(fields[i]);
    }
    has_header = !is_table_row(wanted);
  } else {
    std::string problem = resolve(fields, columns);
    has_header = problem.empty();
    if (!has_header && is_table_row(fields) && !resolve_comment(comment, fields.size(), columns)) {
      are_named = false;
      problem = is_kitti(fields) ? resolve(fields_of(unnamed_meanings(15).front(), Separator::comma), columns)
                                 : positional(fields.size(), columns);
      columns.places.resize(fields.size(), BoxColumns::ignored);
      columns.names.resize(fields.size());
      if (!problem.empty())
        lines.refuse(problem, "4, which are min_x,min_y,max_x,max_y, or 6 in 3D, or names with --columns" +
                                  other_ways(rows, separator, unnamed_meanings(fields.size())));
    } else if (!has_header && !is_table_row(fields)) {
      const auto slip = std::ranges::find_if(
          fields, [](std::string_view field) { return !number_fault(field).expected.empty(); });
      if (slip != fields.end())
        lines.refuse(fmt::format("{}, {}", shown(*slip), number_fault(*slip).found),
                     number_fault(*slip).expected);
      lines.refuse(fmt::format("{}: {}", shown(lines.line(), 100), problem),
                   fmt::format("{}; --columns can name them{}", expected_columns,
                               other_ways(lines, separator, corner_or_centre(fields))));
    }
  }
  if (!has_header) lines = rows;
  std::string_view geometry;
  if (columns.has_geometry) {
    geometry = first_geometry(lines, separator, columns);
    columns.dimension = dimension_of_geometry_text(geometry);
  }
  settle_top(lines, separator, columns);
  std::vector<std::string> others = other_meanings(columns);
  if (!are_named) std::ranges::copy(unnamed_meanings(fields.size()), std::back_inserter(others));
  std::string note = note_on(columns, geometry, !options.columns.empty(), are_named);
  if (!note.empty()) note = fmt::format("{}: {}", input->name(), note);
  std::shared_ptr<BoxLabels> labels = find_labels(options, lines, columns);
  return read_csv({std::move(input), lines, separator, std::move(columns), std::move(labels),
                   Quarantine(options), lines, std::move(others), std::move(note)},
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
         std::ranges::any_of(fields, is_geometry_name) || is_kitti(fields) ||
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
