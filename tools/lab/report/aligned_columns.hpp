// Rows of text in aligned columns.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace broadside::lab {

/// Cells, row by row; the columns become as wide as their widest cell.
class AlignedColumns {
 public:
  /// One character a column: '<' aligns it to the left, '>' to the right. The last column's cells may be as
  /// long as they like and are not filled up.
  explicit AlignedColumns(std::string_view alignment) : alignment_(alignment) {}

  /// Adds a row of as many cells as there are columns. Throws std::invalid_argument if there are more or
  /// less.
  void add(std::vector<std::string> row);

  /// All rows, each with `indent` before it and a line's end after it; no spaces before a line's end.
  std::string text(std::string_view indent) const;

 private:
  std::string alignment_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace broadside::lab
