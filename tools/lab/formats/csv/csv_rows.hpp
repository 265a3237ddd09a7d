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

/// A table whose columns are known.
struct CsvTable {
  std::unique_ptr<Input> input;
  CsvLines lines;  ///< from the first line that holds numbers
  Separator separator;
  BoxColumns columns;
  std::shared_ptr<BoxLabels> labels;
  Quarantine quarantine;
  std::vector<std::string> others{};  ///< other meanings of the columns, for other_ways()
  std::string note{};                 ///< how ambiguous columns were read; empty if there are none
};

/// The box that a row's numbers make.
struct RowBox {
  DoubleBox3 box = absent_box<3, double>();  ///< z repeats x in 2D; absent if all bounds are empty
  int wrong_place = BoxColumns::ignored;     ///< of a value that is no number, or missing, if there is one
  bool is_held = true;                       ///< false if it is a number that no double holds
};
RowBox box_of(const std::vector<CsvField>& fields, const BoxColumns& columns);

/// The `lists` for --columns that make all rows valid, as the end of an error's text; empty if there is none.
/// Reads all rows.
std::string other_ways(CsvLines lines, Separator separator, const std::vector<std::string>& lists);

/// Likewise for bounds in one field: says so if all are valid as a corner and the size.
std::string other_forms(CsvLines lines, Separator separator, const BoxColumns& columns);

/// The rows of a table, one after the other.
class CsvRows {
 public:
  explicit CsvRows(CsvTable table) : table_(std::move(table)), begin_(table_.lines) {}

  const BoxColumns& columns() const noexcept { return table_.columns; }
  const CsvLines& lines() const noexcept { return table_.lines; }
  std::shared_ptr<BoxLabels> labels() const { return table_.labels; }
  std::string warning() const;

  /// Whether there was another row; what follows is then of that one. Blank lines are not rows.
  bool next();

  /// Whether `check()` finds nothing wrong that the row is to be left out for.
  template <typename Check>
  bool holds(const Check& check) {
    return table_.quarantine.holds(check);
  }

  /// The row's box, where z repeats x in 2D; absent where it is invalid and is to be left out.
  DoubleBox3 box();

  /// Refuses the row if it has more or fewer fields than there are columns.
  void check_count() const;

  /// Whether the row says no more than the number of a frame.
  bool is_frame_alone() const;

  /// The number in the column of frames or boxes.
  double number(int place) const;
  std::size_t whole_number(int place) const;

  /// The text in the column of tracks or ids; empty without such a column.
  std::string text(int place) const;

  bool has_column(int place) const noexcept { return column_of(place) < columns().places.size(); }

  /// Keeps the row's id, if it has one, as that of the box at `place`.
  void keep_id(std::size_t place);

  /// Says that the rows up to here will not be looked at again.
  void release() { table_.input->release(table_.lines.passed_bytes()); }

  /// Leaves out the rows but those of a slice; false where invalid rows are left out, which are counted.
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

  CsvTable table_;
  CsvLines begin_;  // before any row was read
  std::vector<CsvField> fields_;
  mutable std::optional<std::string> other_ways_;
};

/// Finds out what a table's columns are, and opens it. Throws FileError.
AnyFrameReader open_csv(std::unique_ptr<Input> input, const ReadOptions& options);

/// The boxes of a table, in double. Memory: all rows where there are several frames.
AnyFrameReader read_csv(CsvTable table);

}  // namespace broadside::lab::readers
