// Tables of what an experiment measured.
#include "paper/experiments/table.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace broadside::lab {
namespace {

/// The cells of a column that hold a Value.
template <typename Value>
std::vector<Value> values(const Table& table, std::string_view column) {
  const std::size_t at = table.column(column);
  std::vector<Value> found;
  for (const std::vector<Cell>& row : table.rows) {
    if (const auto* const value = std::get_if<Value>(&row[at])) found.push_back(*value);
  }
  return found;
}

template <typename Value>
std::vector<Value> distinct(std::vector<Value> values) {
  std::vector<Value> found;
  for (Value& value : values) {
    if (std::ranges::find(found, value) == found.end()) found.push_back(std::move(value));
  }
  return found;
}

}  // namespace

std::string_view name(ChartKind kind) noexcept {
  switch (kind) {
    case ChartKind::lines:
      return "lines";
    case ChartKind::bars:
      return "bars";
    case ChartKind::map:
      return "map";
  }
  return "";
}

Chart log_log_chart(std::string title, std::string x, std::string y, std::string series,
                    std::vector<std::pair<std::string, std::string>> where) {
  return {.title = std::move(title),
          .x = std::move(x),
          .y = std::move(y),
          .series = std::move(series),
          .log_x = true,
          .log_y = true,
          .where = std::move(where)};
}

void Table::add(std::vector<Cell> row) {
  if (row.size() != columns.size()) {
    throw std::invalid_argument(fmt::format("table '{}': a row of {} cells; expected {}, one a column", name,
                                            row.size(), columns.size()));
  }
  for (std::size_t i = 0; i < row.size(); ++i) {
    const double* const number = std::get_if<double>(&row[i]);
    if (number != nullptr && !std::isfinite(*number)) {
      throw std::invalid_argument(fmt::format("table '{}', row {}, column '{}': {}; expected a finite number",
                                              name, rows.size() + 1, columns[i].name, *number));
    }
  }
  rows.push_back(std::move(row));
}

std::size_t Table::column(std::string_view wanted) const {
  const auto found = std::ranges::find(columns, wanted, &Column::name);
  if (found == columns.end()) {
    std::vector<std::string_view> known;
    for (const Column& column : columns) known.push_back(column.name);
    throw std::invalid_argument(fmt::format("table '{}' has no column '{}'; expected one of: {}", name,
                                            wanted, fmt::join(known, ", ")));
  }
  return static_cast<std::size_t>(found - columns.begin());
}

Table Table::where(std::string_view wanted, const Cell& cell) const {
  const std::size_t at = column(wanted);
  Table some{name, title, columns, charts, {}};
  for (const std::vector<Cell>& row : rows) {
    if (row[at] == cell) some.rows.push_back(row);
  }
  return some;
}

std::vector<double> Table::numbers(std::string_view column) const { return values<double>(*this, column); }

std::vector<std::string> Table::texts(std::string_view column) const {
  return values<std::string>(*this, column);
}

double Table::number(std::string_view column) const {
  const std::vector<double> all = numbers(column);
  if (all.empty()) {
    throw std::invalid_argument(fmt::format("table '{}': no number in column '{}' of {} rows; expected one",
                                            name, column, rows.size()));
  }
  return all[0];
}

std::vector<std::string> Table::distinct_texts(std::string_view column) const {
  return distinct(texts(column));
}

std::vector<double> Table::distinct_numbers(std::string_view column) const {
  return distinct(numbers(column));
}

std::vector<std::pair<double, double>> Table::points(std::string_view x, std::string_view y) const {
  const std::size_t x_at = column(x);
  const std::size_t y_at = column(y);
  std::vector<std::pair<double, double>> found;
  for (const std::vector<Cell>& row : rows) {
    const auto* const first = std::get_if<double>(&row[x_at]);
    const auto* const second = std::get_if<double>(&row[y_at]);
    if (first != nullptr && second != nullptr) found.emplace_back(*first, *second);
  }
  return found;
}

const Table& table_named(const std::vector<Table>& tables, std::string_view name) {
  const auto found = std::ranges::find(tables, name, &Table::name);
  if (found == tables.end())
    throw std::invalid_argument(fmt::format("no table '{}' among the experiment's", name));
  return *found;
}

}  // namespace broadside::lab
