// What the experiments on moving boxes share: how they measure, and what a mover costs.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "paper/experiments/laboratory.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {

/// The laboratory's effort with time enough for whole histories, so that none is skipped because a first try
/// was disturbed, and with so many frames that the median is of some use.
Effort effort_to_follow(const Laboratory& laboratory);

/// "2D" or "3D".
std::string dimension_text(int dimension);

/// The median frame, in nanoseconds for each box that changes in it; nothing where it was skipped.
Cell mover_cell(const CaseResult& result, std::string_view spec);

/// `first` over `second`; nothing where either is nothing.
Cell ratio_cell(const Cell& first, const Cell& second);

/// The cell times a factor; nothing where it is nothing.
Cell scaled_cell(const Cell& cell, double factor);

/// The least x from which on `first` stays below `second`, two columns of a table over the column `x`; as
/// crossover() (growth.hpp), of the rows that have both.
std::optional<double> crossover_in(const Table& table, std::string_view x, std::string_view first,
                                   std::string_view second);

}  // namespace broadside::lab
