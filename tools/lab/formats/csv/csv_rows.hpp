// The rows of a table.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/box.hpp"

#include "lab/formats/columns.hpp"
#include "lab/formats/csv/csv_text.hpp"
#include "lab/formats/frames.hpp"
#include "lab/formats/input.hpp"
#include "lab/formats/quarantine.hpp"

namespace broadside::lab::readers {

/// A table whose columns have been resolved.
struct CsvTable {
  std::unique_ptr<Input> input;
  CsvLines lines;  ///< from the first line with numbers
  Separator separator;
  BoxColumns columns;
  std::shared_ptr<BoxLabels> labels;
  Quarantine quarantine;
  std::vector<std::string> others{};  ///< alternative meanings of the columns, for other_ways()
  std::string note{};                 ///< how ambiguous columns were read; empty if no columns are ambiguous
  bool crosses_date_line = false;     ///< whether rows may be boxes across the date line: see DateLine
};

/// The box made of a row's numbers.
struct RowBox {
  DoubleBox3 box = absent_box<3, double>();  ///< z repeats x in 2D; absent if all bounds are empty
  int wrong_place = BoxColumns::ignored;     ///< the place of a value that is missing or not a number, if
                                             ///< there is one
  bool is_held = true;                       ///< false if a number is not exactly representable as a double
};
RowBox box_of(const std::vector<CsvField>& fields, const BoxColumns& columns);

/// Which of the `lists` for --columns make all rows valid, as the end of an error's text; empty if none do.
/// Reads all rows.
std::string other_ways(CsvLines lines, Separator separator, const std::vector<std::string>& lists);

/// If at most one row in ten is invalid, the number of invalid rows, as the end of an error's text about one
/// of them; otherwise empty. Reads all rows.
std::string few_invalid(CsvLines lines, Separator separator, const BoxColumns& columns);

/// Likewise for bounds in one field: whether all are valid as a corner and a size.
std::string other_forms(CsvLines lines, Separator separator, const BoxColumns& columns);

/// Reads the rows of a table in sequence.
class CsvRows {
 public:
  explicit CsvRows(CsvTable table) : table_(std::move(table)), begin_(table_.lines) {}

  const BoxColumns& columns() const noexcept { return table_.columns; }
  const CsvLines& lines() const noexcept { return table_.lines; }
  std::shared_ptr<BoxLabels> labels() const { return table_.labels; }
  std::string warning() const;

  /// Whether there was another row; the functions below then refer to it. Blank lines are not rows.
  bool next();

  /// Whether `check()` passes; if it fails, the row is left out or refused.
  template <typename Check>
  bool holds(const Check& check) {
    return table_.quarantine.holds(check);
  }

  /// The row's box; z repeats x in 2D. Absent if the box is invalid and left out.
  DoubleBox3 box();

  /// Refuses the row if the number of its fields differs from that of the columns.
  void check_count() const;

  /// Whether the row has only the number of a frame.
  bool is_frame_alone() const;

  /// The number in the column of frames or boxes.
  double number(int place) const;
  std::size_t whole_number(int place) const;

  /// The text in the column of tracks or ids; empty without such a column.
  std::string text(int place) const;

  bool has_column(int place) const noexcept { return column_of(place) < columns().places.size(); }

  /// Stores the row's id, if it has one, as that of the box at `place`.
  void keep_id(std::size_t place);

  /// Says that the rows up to here will not be read again.
  void release() { table_.input->release(table_.lines.passed_bytes()); }

  /// Restricts reading to the rows of a slice; false if invalid rows are left out, because they are counted.
  bool take_slice(std::size_t slice, std::size_t slices);

  [[noreturn]] void refuse(int place, const std::string& expected) const;

 private:
  std::size_t column_of(int place) const noexcept;
  std::string_view field(int place) const;
  DoubleBox3 checked_box() const;
  DoubleBox3 geometry_box() const;
  std::string column_text(int place) const;
  [[noreturn]] void refuse_number(int place) const;
  const std::string& other_ways() const;
  const std::string& few_invalid() const;

  CsvTable table_;
  CsvLines begin_;  // before the first row
  std::vector<CsvField> fields_;
  mutable std::optional<std::string> other_ways_;
  mutable std::optional<std::string> few_invalid_;
};

/// Resolves a table's columns and opens it. Throws FileError.
AnyFrameReader open_csv(std::unique_ptr<Input> input, const ReadOptions& options);

/// The boxes of a table, in double. Memory: all rows, if there are several frames.
AnyFrameReader read_csv(CsvTable table);

}  // namespace broadside::lab::readers
