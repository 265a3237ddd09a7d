// Tables of what an experiment measured.
#include "paper/experiments/table.hpp"

#include <algorithm>
#include <array>
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

double logarithm(double number) {
  if (!(number > 0)) throw std::invalid_argument(fmt::format("{}; expected a number above 0", number));
  return std::log(number);
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

double growth_of(const std::vector<std::pair<double, double>>& points) {
  double mean_x = 0;
  double mean_y = 0;
  for (const auto& [x, y] : points) {
    mean_x += logarithm(x) / static_cast<double>(points.size());
    mean_y += logarithm(y) / static_cast<double>(points.size());
  }
  double both = 0;
  double square = 0;
  for (const auto& [x, y] : points) {
    const double distance = std::log(x) - mean_x;
    both += distance * (std::log(y) - mean_y);
    square += distance * distance;
  }
  if (points.size() < 2 || !(square > 0))
    throw std::invalid_argument(
        fmt::format("growth from {} points; expected two with different x", points.size()));
  return both / square;
}

std::optional<double> crossover(const std::vector<std::pair<double, double>>& first,
                                const std::vector<std::pair<double, double>>& second) {
  if (first.empty() || first.size() != second.size())
    throw std::invalid_argument(fmt::format("lines of {} and {} points; expected as many in both, and some",
                                            first.size(), second.size()));
  std::vector<double> lead;  // how far the first is below the second, in logarithms
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (first[i].first != second[i].first)
      throw std::invalid_argument(
          fmt::format("points at {} and {}; expected the same", first[i].first, second[i].first));
    lead.push_back(logarithm(second[i].second) - logarithm(first[i].second));
  }
  std::size_t from = lead.size();
  while (from > 0 && lead[from - 1] > 0) --from;
  if (from == lead.size()) return std::nullopt;
  if (from == 0) return first[0].first;
  const double begin = logarithm(first[from - 1].first);
  const double end = logarithm(first[from].first);
  return std::exp(begin + (end - begin) * -lead[from - 1] / (lead[from] - lead[from - 1]));
}

Interval growth_interval_of(const std::vector<std::pair<double, double>>& points) {
  const double exponent = growth_of(points);
  if (points.size() < 3) return {exponent, exponent};
  double mean_x = 0;
  double mean_y = 0;
  const auto count = static_cast<double>(points.size());
  for (const auto& [x, y] : points) {
    mean_x += std::log(x) / count;
    mean_y += std::log(y) / count;
  }
  double residue = 0;
  double square = 0;
  for (const auto& [x, y] : points) {
    const double distance = std::log(x) - mean_x;
    const double error = std::log(y) - mean_y - exponent * distance;
    residue += error * error;
    square += distance * distance;
  }
  // Student's t at 97.5 %, by the degrees of freedom from 1 on.
  constexpr std::array<double, 10> student = {12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26, 2.23};
  const std::size_t freedom = points.size() - 2;
  const double t = student[std::min(freedom, student.size()) - 1];
  const double error = t * std::sqrt(residue / static_cast<double>(freedom) / square);
  return {exponent - error, exponent + error};
}

std::vector<Column> ratio_columns(const std::string& name) {
  return {{name}, {name + " low"}, {name + " high"}};
}

std::vector<RatioAt> ratios_over(const Table& table, std::string_view x, const std::string& ratio) {
  const std::size_t at_x = table.column(x);
  const std::size_t at_ratio = table.column(ratio);
  const std::size_t at_low = table.column(ratio + " low");
  const std::size_t at_high = table.column(ratio + " high");
  std::vector<RatioAt> ratios;
  for (const std::vector<Cell>& row : table.rows) {
    const auto number = [&row](std::size_t at) { return std::get_if<double>(&row[at]); };
    if (number(at_x) == nullptr || number(at_ratio) == nullptr || number(at_low) == nullptr ||
        number(at_high) == nullptr)
      continue;
    ratios.push_back({*number(at_x), *number(at_ratio), {*number(at_low), *number(at_high)}});
    if (!ratios.back().interval.includes(ratios.back().ratio))
      throw std::invalid_argument(fmt::format("table '{}': '{}' is {}, from {} to {}; expected it between",
                                              table.name, ratio, ratios.back().ratio,
                                              ratios.back().interval.low, ratios.back().interval.high));
  }
  if (ratios.size() < 2)
    throw std::invalid_argument(fmt::format("table '{}': {} rows with '{}' and its interval; expected two",
                                            table.name, ratios.size(), ratio));
  std::ranges::sort(ratios, {}, &RatioAt::x);
  return ratios;
}

Crossing rises_above(double level, const std::vector<RatioAt>& ratios) {
  std::vector<std::pair<double, double>> flat;
  for (const RatioAt& at : ratios) flat.emplace_back(at.x, level);
  const auto crossing = [&](const auto& height) {
    std::vector<std::pair<double, double>> rising;
    for (const RatioAt& at : ratios) rising.emplace_back(at.x, height(at));
    return crossover(flat, rising);
  };
  return {crossing([](const RatioAt& at) { return at.ratio; }),
          crossing([](const RatioAt& at) { return at.interval.high; }),
          crossing([](const RatioAt& at) { return at.interval.low; })};
}

std::optional<double> crossover_in(const Table& table, std::string_view x, std::string_view first,
                                   std::string_view second) {
  std::vector<std::pair<double, double>> below;
  std::vector<std::pair<double, double>> above;
  const std::size_t at_x = table.column(x);
  const std::size_t at_first = table.column(first);
  const std::size_t at_second = table.column(second);
  for (const std::vector<Cell>& row : table.rows) {
    const auto* const place = std::get_if<double>(&row[at_x]);
    const auto* const one = std::get_if<double>(&row[at_first]);
    const auto* const other = std::get_if<double>(&row[at_second]);
    if (place == nullptr || one == nullptr || other == nullptr) continue;
    below.emplace_back(*place, *one);
    above.emplace_back(*place, *other);
  }
  return crossover(below, above);
}

}  // namespace broadside::lab
