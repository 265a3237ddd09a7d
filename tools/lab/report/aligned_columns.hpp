// Rows of text in aligned columns.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace broadside::lab {

/// A table of cells, added row by row; each column is as wide as its widest cell.
class AlignedColumns {
 public:
  /// One character per column: '<' aligns it to the left, '>' to the right. Cells of the last column may have
  /// any length and are not padded.
  explicit AlignedColumns(std::string_view alignment) : alignment_(alignment) {}

  /// Adds a row with one cell per column. Throws std::invalid_argument if there are more or fewer.
  void add(std::vector<std::string> row);

  /// All rows, each with `indent` before it and a newline after it; no spaces before newlines.
  std::string text(std::string_view indent) const;

 private:
  std::string alignment_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace broadside::lab
