// Rows of text in aligned columns.
#include "lab/report/aligned_columns.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace broadside::lab {
namespace {

constexpr std::string_view column_gap = "  ";

}  // namespace

void AlignedColumns::add(std::vector<std::string> row) {
  if (row.size() != alignment_.size())
    throw std::invalid_argument(fmt::format("{} cells; expected {}", row.size(), alignment_.size()));
  rows_.push_back(std::move(row));
}

std::string AlignedColumns::text(std::string_view indent, std::size_t width) const {
  const std::size_t count = alignment_.size();
  std::vector<std::size_t> widths(count, 0);
  for (const auto& row : rows_) {
    if (row.size() < count) continue;
    for (std::size_t column = 0; column < count; ++column)
      widths[column] = std::max(widths[column], row[column].size());
  }
  // Long cells of the last column are wrapped.
  constexpr std::size_t min_last_width = 24;
  widths.back() = std::min(widths.back(), min_last_width);
  std::string text;
  for (std::size_t begin = 1; begin < count;) {
    std::size_t end = begin;
    std::size_t used = indent.size() + widths[0];
    do used += column_gap.size() + widths[end++];
    while (end < count && used + column_gap.size() + widths[end] <= width);
    if (!text.empty()) text += "\n";
    text += part(indent, width, widths, begin, end);
    begin = end;
  }
  return text;
}

std::string AlignedColumns::part(std::string_view indent, std::size_t width,
                                 const std::vector<std::size_t>& widths, std::size_t begin,
                                 std::size_t end) const {
  std::string text;
  for (const auto& row : rows_) {
    std::string line(indent);
    const auto add = [&](std::size_t column) {
      if (column + 1 == alignment_.size())
        line += wrapped(row[column], width, line.size(), line.size());
      else
        line += alignment_[column] == '<' ? fmt::format("{:<{}}", row[column], widths[column])
                                          : fmt::format("{:>{}}", row[column], widths[column]);
    };
    if (row.size() == 1) {
      line += row[0];
    } else {
      add(0);
      for (std::size_t column = begin; column < end; ++column) {
        line += column_gap;
        add(column);
      }
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace broadside::lab
