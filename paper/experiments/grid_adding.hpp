// What experiment 4 measures: where the time of the paper's grid goes.
#pragma once

#include "paper/experiments/laboratory.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {

/// A row for each number of neighbours and length of a box in cells, down to the smallest cells that the grid
/// takes: the time of a search for its empty cells, for adding boxes to them, and for testing.
Table measure_adding(const Laboratory& laboratory);

}  // namespace broadside::lab
