// Rows of text in aligned columns.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lab/report/fold.hpp"

namespace broadside::lab {

/// A table of cells, added row by row; each column is as wide as its widest cell.
class AlignedColumns {
 public:
  /// `alignment` has one character for each column: '<' aligns it to the left, '>' to the right. There are at
  /// least two columns.
  /// Cells of the last column may have any length and are not padded.
  explicit AlignedColumns(std::string_view alignment) : alignment_(alignment) {}

  /// Adds a row with one cell per column. Throws std::invalid_argument if there are more or fewer.
  void add(std::vector<std::string> row);

  /// Adds a line across all columns.
  void add_line(std::string line) { rows_.push_back({std::move(line)}); }

  /// All rows, each with `indent` before it and a newline after it; no spaces before newlines. If the columns
  /// do not fit in `width`, the table is printed in parts, one below the other. Each part begins with the
  /// first column.
  std::string text(std::string_view indent, std::size_t width = any_width) const;

 private:
  /// The first column and the columns from `begin` up to `end`.
  std::string part(std::string_view indent, std::size_t width, const std::vector<std::size_t>& widths,
                   std::size_t begin, std::size_t end) const;

  std::string alignment_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace broadside::lab
