// How measured numbers grow, and where one line crosses another.
#include "paper/experiments/growth.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace broadside::lab {
namespace {

double logarithm(double number) {
  if (!(number > 0)) throw std::invalid_argument(fmt::format("{}; expected a number above 0", number));
  return std::log(number);
}

}  // namespace

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
