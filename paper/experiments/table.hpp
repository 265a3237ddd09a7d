// Tables of what an experiment measured, and the charts that show them best.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// A column: what it is, in lower case as it stands in a heading, and the unit of its numbers ("ms", "bytes";
/// empty for a count, a ratio or text).
struct Column {
  std::string name;
  std::string unit{};

  friend bool operator==(const Column&, const Column&) = default;
};

/// A finite number, a text, or nothing where there is nothing to say (an algorithm that was skipped).
using Cell = std::variant<std::monostate, double, std::string>;

/// How a chart shows a table.
enum class ChartKind {
  lines,  ///< y over x, a line for each value of `series`
  bars,   ///< y for each x (which may be text), a bar for each value of `series`
  map     ///< a field for each x and y, coloured by the text in `value`: the winner there
};

/// "lines", "bars" or "map".
std::string_view name(ChartKind kind) noexcept;

/// A chart of a table, in names of its columns.
struct Chart {
  std::string title;
  ChartKind kind = ChartKind::lines;
  std::string x;
  std::string y;
  std::string series{};  ///< empty: there is one
  std::string value{};   ///< of a map
  bool log_x = false;
  bool log_y = false;
  /// Only rows in which each of these columns has this text are shown; empty: all.
  std::vector<std::pair<std::string, std::string>> where{};

  friend bool operator==(const Chart&, const Chart&) = default;
};

/// Lines of y over x, both axes logarithmic.
Chart log_log_chart(std::string title, std::string x, std::string y, std::string series = {},
                    std::vector<std::pair<std::string, std::string>> where = {});

/// Rows of cells under columns.
struct Table {
  std::string name;   ///< as in results: lower case, digits and underscores
  std::string title;  ///< what it shows, in a line
  std::vector<Column> columns;
  std::vector<Chart> charts{};
  std::vector<std::vector<Cell>> rows{};

  friend bool operator==(const Table&, const Table&) = default;

  /// Adds a row. Throws std::invalid_argument if there are not as many cells as columns, or one is a number
  /// that is not finite.
  void add(std::vector<Cell> row);

  /// The place of a column. Throws std::invalid_argument if there is none of that name.
  std::size_t column(std::string_view name) const;

  /// Those of its rows whose cell in `column` is `cell`, as a table.
  Table where(std::string_view column, const Cell& cell) const;

  /// A column's numbers and texts, row by row; rows with none are left out. Two columns of numbers go
  /// together only by points().
  std::vector<double> numbers(std::string_view column) const;
  std::vector<std::string> texts(std::string_view column) const;

  /// A column's first number. Throws std::invalid_argument if there is none.
  double number(std::string_view column) const;

  /// Each different text of a column, in the order in which they first come; likewise numbers.
  std::vector<std::string> distinct_texts(std::string_view column) const;
  std::vector<double> distinct_numbers(std::string_view column) const;

  /// Of each row with a number in both columns: the two.
  std::vector<std::pair<double, double>> points(std::string_view x, std::string_view y) const;
};

/// The table of that name. Throws std::invalid_argument if there is none.
const Table& table_named(const std::vector<Table>& tables, std::string_view name);

/// The exponent e of y ~ x^e: the slope of the least squares line through the logarithms. Throws
/// std::invalid_argument if there are fewer than two different x, or a number that is not above 0.
double growth_of(const std::vector<std::pair<double, double>>& points);

/// The least x from which on `first` stays below `second`, both given at x in ascending order and joined by
/// straight lines between the logarithms: the first x of all if it is always below, empty if it is not below
/// at the last. Throws std::invalid_argument if the two are not over the same x, are empty, or hold a number
/// that is not above 0.
std::optional<double> crossover(const std::vector<std::pair<double, double>>& first,
                                const std::vector<std::pair<double, double>>& second);

/// The 95 % interval of growth_of(): how far the exponent may be off, by how far the points lie from the
/// line. Of two points it is the exponent alone.
Interval growth_interval_of(const std::vector<std::pair<double, double>>& points);

/// The columns of a ratio with its interval: `name`, and the same with " low" and " high" behind it.
std::vector<Column> ratio_columns(const std::string& name);

/// A ratio as tables have it: in a column, and the bounds of its interval in columns of that name with " low"
/// and " high" behind it.
struct RatioAt {
  double x = 0;
  double ratio = 0;
  Interval interval{};

  bool is_above(double level) const { return interval.low > level; }
  bool is_below(double level) const { return interval.high < level; }
};

/// Of the rows that have all of it, by x. Throws std::invalid_argument if there are fewer than two, or a
/// bound is on the wrong side.
std::vector<RatioAt> ratios_over(const Table& table, std::string_view x, const std::string& ratio);

/// Where a ratio comes to stay above a level, and the range that its interval leaves.
struct Crossing {
  std::optional<double> at;  ///< the first x of all if it is always above; empty if it is not at the last
  std::optional<double> earliest;
  std::optional<double> latest;

  /// The crossing as a figure's interval, up to `most` where there is none.
  Interval interval(double most) const { return {earliest.value_or(most), latest.value_or(most)}; }
};

/// Throws std::invalid_argument as crossover().
Crossing rises_above(double level, const std::vector<RatioAt>& ratios);

/// Adds elements at the end.
template <typename Element>
void append(std::vector<Element>& elements, const std::vector<Element>& more) {
  elements.insert(elements.end(), more.begin(), more.end());
}

/// The least x from which on `first` stays below `second`, two columns of a table over the column `x`; as
/// crossover(), of the rows that have both.
std::optional<double> crossover_in(const Table& table, std::string_view x, std::string_view first,
                                   std::string_view second);

}  // namespace broadside::lab
