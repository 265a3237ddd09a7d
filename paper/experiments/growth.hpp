// How measured numbers grow, and where one line crosses another.
#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "paper/experiments/table.hpp"

namespace broadside::lab {

/// The exponent e of y ~ x^e: the slope of the least squares line through the logarithms. Throws
/// std::invalid_argument if there are fewer than two different x, or a number that is not above 0.
double growth_of(const std::vector<std::pair<double, double>>& points);

/// The least x from which on `first` stays below `second`, both given at x in ascending order and joined by
/// straight lines between the logarithms: the first x of all if it is always below, empty if it is not below
/// at the last. Throws std::invalid_argument if the two are not over the same x, are empty, or hold a number
/// that is not above 0.
std::optional<double> crossover(const std::vector<std::pair<double, double>>& first,
                                const std::vector<std::pair<double, double>>& second);

/// The least x from which on `first` stays below `second`, two columns of a table over the column `x`; as
/// crossover(), of the rows that have both.
std::optional<double> crossover_in(const Table& table, std::string_view x, std::string_view first,
                                   std::string_view second);

}  // namespace broadside::lab
