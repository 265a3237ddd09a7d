// Reads boxes from comma-separated values and similar text. The names of the columns determine their meaning.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/csv/csv_rows.hpp"
#include "lab/formats/csv/csv_writer.hpp"
#include "lab/formats/csv/geometry_text.hpp"
#include "lab/formats/registry.hpp"
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

/// Whether a line precedes the table: it is empty or a comment.
bool is_before(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == std::string_view::npos || line[first] == '#';
}

/// Whether the fields are probably a row of data, with a number or a geometry, rather than column names.
bool is_table_row(const Fields& fields) {
  return std::all_of(fields.begin(), fields.end(), [](std::string_view field) { return field.empty(); }) ||
         std::any_of(fields.begin(), fields.end(), [](std::string_view field) {
           return field.find_first_of("([") != std::string_view::npos || is_number(field);
         });
}

/// Whether a row is one of KITTI's object labels: a class, and 14 or 15 numbers.
bool is_kitti(const Fields& fields) {
  return (fields.size() == 15 || fields.size() == 16) && !is_number(fields.front()) &&
         std::all_of(fields.begin() + 1, fields.end(), is_number);
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

/// Null if none has this name.
const Convention* convention_named(std::string_view name) {
  for (const Convention& convention : conventions) {
    if (convention.name == name) return &convention;
  }
  return nullptr;
}

/// Opens a table: resolves its columns.
class CsvOpener {
 public:
  CsvOpener(std::unique_ptr<Input> input, const ReadOptions& options)
      : input_(std::move(input)), options_(options), lines_(*input_), rows_(lines_) {}

  AnyFrameReader open() {
    const std::string_view comment = skip_comments();
    separator_ = separator_of(lines_.line());
    // Blanks within a geometry that is alone in its line are not separators.
    if (separator_ == Separator::blanks && is_geometry_name(fields_of(lines_.line(), separator_).front()))
      separator_ = Separator::tab;
    fields_ = fields_of(lines_.line(), separator_);
    const bool has_header =
        options_.columns.empty() ? find_columns(comment) : take_columns(options_.columns, comment);
    if (!has_header) lines_ = rows_;
    look_into_rows();
    std::vector<std::string> others = other_meanings(columns_, are_named_);
    if (!are_named_) {
      for (std::string& meaning : unnamed_meanings(fields_.size())) others.push_back(std::move(meaning));
    }
    std::string note = note_on_columns();
    if (!note.empty()) note = fmt::format("{}: {}", input_->name(), note);
    std::shared_ptr<BoxLabels> labels = find_labels();
    const bool crosses = options_.date_line == DateLine::always ||
                         (options_.date_line == DateLine::by_names && !columns_.has_frames &&
                          is_longitude(BoxColumns::first) && is_longitude(BoxColumns::second));
    return read_csv({std::move(input_), lines_, separator_, std::move(columns_), std::move(labels),
                     Quarantine(options_), std::move(others), std::move(note), crosses});
  }

 private:
  /// Goes to the first line of the table, and returns the comment before it, if any.
  std::string_view skip_comments() {
    std::string_view comment;
    while (true) {
      if (!lines_.next())
        throw FileError(fmt::format("{}: {}; expected a table with {}", input_->name(),
                                    input_->bytes().empty() ? "is empty" : "has no line but comments",
                                    expected_columns));
      if (lines_.line().find('\r') != std::string_view::npos)
        lines_.refuse("a carriage return within the line", "lines that end with a line feed");
      if (!is_before(lines_.line())) return comment;
      comment = lines_.line();
      rows_ = lines_;
    }
  }

  static Fields names_in(std::string_view comment) {
    comment.remove_prefix(std::min(comment.find_first_not_of("# \t"), comment.size()));
    return fields_of(comment, separator_of(comment));
  }

  /// Resolves the columns by the names in the first line or in a comment before it (numpy.savetxt writes
  /// one), or by their number. Returns whether the first line holds names.
  bool find_columns(std::string_view comment) {
    std::string problem = resolve(fields_, columns_);
    if (problem.empty()) return true;
    if (!is_table_row(fields_)) {
      const auto slip = std::find_if(fields_.begin(), fields_.end(), [](std::string_view field) {
        return !number_fault(field).expected.empty();
      });
      if (slip != fields_.end())
        lines_.refuse(fmt::format("{}, {}", shown(*slip), number_fault(*slip).found),
                      number_fault(*slip).expected);
      lines_.refuse(fmt::format("{}: {}", shown(lines_.line(), 100), problem),
                    fmt::format("{}; --columns can name them{}", expected_columns,
                                other_ways(lines_, separator_, corner_or_centre(fields_))));
    }
    const Fields names = names_in(comment);
    if (names.size() == fields_.size() && resolve(names, columns_).empty()) return false;
    are_named_ = false;
    problem = is_kitti(fields_) ? resolve(fields_of(unnamed_meanings(15).front(), Separator::comma), columns_)
                                : positional(fields_.size(), columns_);
    columns_.places.resize(fields_.size(), BoxColumns::ignored);
    columns_.names.resize(fields_.size());
    if (!problem.empty())
      lines_.refuse(problem, "4, which are min_x,min_y,max_x,max_y, or 6 in 3D, or names with --columns" +
                                 other_ways(rows_, separator_, unnamed_meanings(fields_.size())));
    return false;
  }

  /// Resolves the columns that the user names, from left to right, by the table's own names, or by a
  /// convention such as "xywh". Returns whether the first line holds names.
  bool take_columns(std::string_view list, std::string_view comment) {
    const Convention* const convention = convention_named(list);
    if (convention != nullptr && !is_table_row(fields_)) return take_convention(*convention);
    Fields names = fields_of(convention != nullptr ? convention->columns : list, Separator::comma);
    std::replace(names.begin(), names.end(), std::string_view("-"), std::string_view());
    if (options_.selects_columns && convention == nullptr) select(names, comment);
    const BoundsForm form = take_form(list, names);
    if (names.size() > fields_.size())
      lines_.refuse(fmt::format("{} column{}", fields_.size(), fields_.size() == 1 ? "" : "s"),
                    fmt::format("the {} that --columns names", names.size()));
    names.resize(fields_.size());
    const std::string problem = resolve(names, columns_, true);
    columns_.geometry_form = form;
    if (!problem.empty())
      lines_.refuse(fmt::format("--columns names '{}': {}", list, problem), expected_columns);
    // A row with one invalid number among valid ones is not a line of names.
    Fields read;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (columns_.places[i] != BoxColumns::ignored) read.push_back(fields_[i]);
    }
    return !is_table_row(read);
  }

  /// The columns of this name, up to an "="; if none has exactly this name, those that have it in any
  /// spelling.
  static std::vector<std::size_t> called(const Fields& header, std::string_view name) {
    name = name.substr(0, name.find('='));
    const bool is_exact = std::find(header.begin(), header.end(), name) != header.end();
    std::vector<std::size_t> columns;
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (is_exact ? header[i] == name : plain(header[i]) == plain(name)) columns.push_back(i);
    }
    return columns;
  }

  /// If the first line or the comment before it names the columns, gives the user's names to the columns that
  /// are called so, and none to others of bounds. Names without a meaning stand for the bounds in order.
  void select(Fields& names, std::string_view comment) const {
    const auto has_one = [&names](const Fields& header) {
      return std::any_of(names.begin(), names.end(), [&header](std::string_view name) {
        return !is_number(name) && !called(header, name).empty();
      });
    };
    Fields header = fields_;
    if (is_table_row(fields_) && !has_one(fields_)) {
      header = names_in(comment);
      if (header.size() != fields_.size() || !has_one(header)) return;
    }
    Fields meanings = names;
    BoxColumns meant;
    if ((names.size() == 4 || names.size() == 6) && options_.columns.find('=') == std::string::npos &&
        !resolve(names, meant, true).empty())
      meanings =
          fields_of(convention_named(names.size() == 4 ? "xyxy" : "xyzxyz")->columns, Separator::comma);
    Fields selected = header;
    std::replace_if(selected.begin(), selected.end(), gives_bounds, std::string_view());
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::vector<std::size_t> columns = called(header, names[i]);
      if (columns.empty())
        lines_.refuse(shown(fmt::to_string(fmt::join(header, ",")), 100),
                      fmt::format("a column {}, as columns names it", shown(names[i])));
      for (const std::size_t column : columns) selected[column] = meanings[i];
    }
    names = std::move(selected);
  }

  /// Takes the order of the numbers in a column of bounds from names such as "bbox=xywh".
  BoundsForm take_form(std::string_view list, Fields& names) const {
    BoundsForm form = BoundsForm::min_max;
    for (std::string_view& name : names) {
      const std::size_t equals = name.find('=');
      if (equals == std::string_view::npos) continue;
      const Convention* const told = convention_named(name.substr(equals + 1));
      name = name.substr(0, equals);
      if (told == nullptr || !is_geometry_name(name))
        lines_.refuse(fmt::format("--columns names '{}'", list), "bbox=xyxy, bbox=xywh or bbox=cxcywh");
      form = told->form;
    }
    // In a file with names, one column is found by its name; other columns of bounds are ignored.
    const std::string_view only = names.front();
    const bool has_form = list.find('=') != std::string_view::npos;
    if (!has_form || names.size() != 1 || std::find(fields_.begin(), fields_.end(), only) == fields_.end())
      return form;
    names = fields_;
    std::replace_if(
        names.begin(), names.end(),
        [only](std::string_view other) { return other != only && gives_bounds(other); }, std::string_view());
    return form;
  }

  /// Resolves the columns of bounds in a file with names by a convention.
  bool take_convention(const Convention& convention) {
    Fields names = fields_;
    static constexpr std::array<std::string_view, 3> centres = {"cx", "cy", "cz"};
    for (std::string_view& name : names) {
      const std::string letter = plain(name);
      if (convention.form == BoundsForm::centre_size && letter.size() == 1 && letter >= "x" && letter <= "z")
        name = centres[static_cast<std::size_t>(letter[0] - 'x')];
    }
    std::string problem = resolve(names, columns_, true);
    columns_.geometry_form = convention.form;
    const auto is_other = [&](BoundsForm form) {
      return form != convention.form &&
             (form != BoundsForm::bottom_top || convention.form != BoundsForm::min_max);
    };
    if (problem.empty() && !columns_.has_geometry &&
        std::any_of(columns_.forms.begin(), columns_.forms.begin() + columns_.dimension, is_other))
      problem = "other columns of bounds";
    if (!problem.empty())
      lines_.refuse(fmt::format("--columns is '{}': {}", convention.name, problem),
                    fmt::format("columns such as {}", convention.columns));
    return true;
  }

  std::size_t column_of(int place) const {
    return static_cast<std::size_t>(std::find(columns_.places.begin(), columns_.places.end(), place) -
                                    columns_.places.begin());
  }

  /// Whether the name of this place's column says that it is a longitude.
  bool is_longitude(int place) const {
    const std::size_t column = column_of(place);
    if (column >= columns_.names.size()) return false;
    const std::string name = plain(columns_.names[column]);
    return name.find("lon") != std::string::npos || name.find("lng") != std::string::npos;
  }

  /// Looks for the first geometry, which determines the dimension, and for the first row that shows in which
  /// direction y grows.
  void look_into_rows() {
    CsvLines lines = lines_;
    const std::size_t geometry = column_of(BoxColumns::geometry);
    const std::size_t bottom = column_of(BoxColumns::first + 1);
    const std::size_t top = column_of(BoxColumns::second + 1);
    while (((columns_.has_geometry && geometry_.empty()) || columns_.forms[1] == BoundsForm::bottom_top) &&
           lines.next()) {
      const Fields fields = fields_of(lines.line(), separator_);
      if (columns_.has_geometry && geometry < fields.size()) geometry_ = fields[geometry];
      double bottom_y = 0;
      double top_y = 0;
      if (std::max(bottom, top) < fields.size() && parse_number(fields[bottom], bottom_y) &&
          parse_number(fields[top], top_y) && bottom_y != top_y && std::isfinite(bottom_y) &&
          std::isfinite(top_y))
        settle_top(columns_, top_y < bottom_y);
    }
    settle_top(columns_, false);
    if (columns_.has_geometry) columns_.dimension = read_geometry_text(geometry_).dimension;
  }

  /// How ambiguous columns were read; empty if no columns are ambiguous.
  std::string note_on_columns() const {
    const auto name_at = [this](int place) {
      const std::size_t column = column_of(place);
      return column < columns_.names.size() ? shown(columns_.names[column]) : std::string();
    };
    if (columns_.has_tracks && name_at(BoxColumns::track).empty())
      return "no column of ids: the boxes of each frame are numbered anew";
    if (!options_.columns.empty()) return {};
    if (!are_named_)
      return fmt::format(
          "no names of columns: read as {}{}", columns_.wanted(),
          columns_.names.size() == 4 ? "; --columns x,y,w,h if they are a corner and the size" : "");
    const bool is_list = !geometry_.empty() && std::string_view("[( +-.0123456789").find(geometry_.front()) !=
                                                   std::string_view::npos;
    if (is_list)
      return fmt::format(
          "column {} read as minima and then maxima; --columns {}=xywh if it is a corner and the size",
          name_at(BoxColumns::geometry), plainly(columns_.names[column_of(BoxColumns::geometry)]));
    if (!columns_.has_geometry && columns_.forms[0] == BoundsForm::point)
      return fmt::format("no columns of bounds: each row is a point, with x from {} and y from {}{}",
                         name_at(BoxColumns::first), name_at(BoxColumns::first + 1),
                         columns_.dimension == 3 ? " and z from " + name_at(BoxColumns::first + 2) : "");
    return {};
  }

  /// Finds the column of ids, first by its exact name, then in other spellings, and lists the columns that
  /// are not read.
  std::shared_ptr<BoxLabels> find_labels() {
    auto labels = std::make_shared<BoxLabels>();
    const std::vector<std::string>& names = columns_.names;
    const std::size_t track = column_of(BoxColumns::track);
    const std::string default_name = track < names.size() ? names[track] : "id";
    const std::string wanted = options_.ids.empty() && options_.finds_ids ? default_name : options_.ids;
    auto column = std::find(names.begin(), names.end(), wanted);
    if (column == names.end()) {
      column = std::find_if(names.begin(), names.end(),
                            [&](const std::string& name) { return plain(name) == plain(wanted); });
    }
    if (column == names.end() && !options_.ids.empty())
      lines_.refuse(fmt::format("no column {} of ids", shown(wanted)),
                    fmt::format("one of: {}", plainly(fmt::to_string(fmt::join(names, ", ")))));
    if (column != names.end() && !wanted.empty()) {
      int& place = columns_.places[static_cast<std::size_t>(column - names.begin())];
      if (place != BoxColumns::ignored && place != BoxColumns::track)
        lines_.refuse(fmt::format("column {} is read already, and --ids names it", shown(*column)),
                      "a column of its own for the ids");
      if (place == BoxColumns::ignored) place = BoxColumns::id;
      labels->has_ids = true;
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (columns_.places[i] == BoxColumns::ignored && !names[i].empty()) labels->unread.push_back(names[i]);
    }
    return labels;
  }

  std::unique_ptr<Input> input_;
  const ReadOptions& options_;
  CsvLines lines_;  // at first before the table's first line, in the end before its first row
  CsvLines rows_;   // before the table's first line
  Separator separator_ = Separator::comma;
  Fields fields_;  // of the first line
  BoxColumns columns_;
  bool are_named_ = true;
  std::string_view geometry_;  // the first one
};

/// Whether the first line with content is that of a table.
bool is_csv(std::string_view bytes, std::string_view extension) {
  if (extension == ".csv") return true;
  Input input("", bytes);
  CsvLines lines(input);
  do {
    if (!lines.next()) return false;
  } while (is_before(lines.line()));
  Fields fields = fields_of(lines.line(), separator_of(lines.line()));
  // The last field may be cut off within a number.
  if (lines.bytes_left() == 0 && bytes.size() == Input::beginning_bytes) fields.pop_back();
  if (fields.size() < 2) return false;
  return std::count_if(fields.begin(), fields.end(), is_column_name) >= 2 ||
         std::any_of(fields.begin(), fields.end(), is_geometry_name) || is_kitti(fields) ||
         (std::any_of(fields.begin(), fields.end(), is_number) &&
          std::all_of(fields.begin(), fields.end(),
                      [](std::string_view field) { return field.empty() || is_number(field); }));
}

}  // namespace

AnyFrameReader open_csv(std::unique_ptr<Input> input, const ReadOptions& options) {
  return CsvOpener(std::move(input), options).open();
}

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
