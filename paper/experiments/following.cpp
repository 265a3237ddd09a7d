// What the experiments on moving boxes share.
#include "paper/experiments/following.hpp"

#include "paper/experiments/growth.hpp"

namespace broadside::lab {

Effort effort_to_follow(const Laboratory& laboratory) {
  Effort effort = laboratory.effort();
  effort.share_seconds = laboratory.either(0.1, 0.03);
  effort.least_rounds = laboratory.either<std::size_t>(3, 2);
  effort.history_seconds = laboratory.either(20.0, 2.0);
  effort.slow_history_seconds = laboratory.either(1.0, 0.1);
  return effort;
}

std::string dimension_text(int dimension) { return dimension == 2 ? "2D" : "3D"; }

Cell mover_cell(const CaseResult& result, std::string_view spec) {
  const double movers = result.of.moving * static_cast<double>(result.of.boxes);
  return scaled_cell(time_cell(measurement_of(result, spec)), movers > 0 ? 1e6 / movers : 0);
}

Cell ratio_cell(const Cell& first, const Cell& second) {
  const auto* const over = std::get_if<double>(&first);
  const auto* const under = std::get_if<double>(&second);
  return over == nullptr || under == nullptr || *under == 0 ? Cell() : Cell(*over / *under);
}

Cell scaled_cell(const Cell& cell, double factor) {
  const auto* const number = std::get_if<double>(&cell);
  return number == nullptr ? Cell() : Cell(*number * factor);
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
