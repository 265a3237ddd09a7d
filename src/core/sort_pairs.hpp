// Pairs sorted by their ids, each once.
#pragma once

#include <vector>

#include "broadside/pair.hpp"

namespace broadside::core {

/// Sorts as sort_pairs() does unless the pairs are sorted, and drops duplicates.
void sort_unique(std::vector<Pair>& pairs, std::vector<Pair>& scratch);

}  // namespace broadside::core
