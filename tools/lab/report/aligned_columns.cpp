// Rows of text in aligned columns.
#include "lab/report/aligned_columns.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace broadside::lab {

void AlignedColumns::add(std::vector<std::string> row) {
  if (row.size() != alignment_.size())
    throw std::invalid_argument(fmt::format("{} cells; expected {}", row.size(), alignment_.size()));
  rows_.push_back(std::move(row));
}

std::string AlignedColumns::text(std::string_view indent) const {
  std::vector<std::size_t> widths(alignment_.size(), 0);
  for (const auto& row : rows_) {
    for (std::size_t column = 0; column + 1 < row.size(); ++column)
      widths[column] = std::max(widths[column], row[column].size());
  }
  std::string text;
  for (const auto& row : rows_) {
    std::string line(indent);
    for (std::size_t column = 0; column < row.size(); ++column) {
      if (column > 0) line += "  ";
      line += alignment_[column] == '<' ? fmt::format("{:<{}}", row[column], widths[column])
                                        : fmt::format("{:>{}}", row[column], widths[column]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace broadside::lab
