// Pairs sorted by their ids.
#pragma once

#include <vector>

#include "broadside/export.hpp"
#include "broadside/pair.hpp"

namespace broadside::core {

/// Sorts `pairs`. `scratch` is memory to be kept between calls. O(n) where there are many: a radix sort over
/// the bits in which they differ. Seen outside a shared library, for distributed/.
BROADSIDE_PUBLIC void sort(std::vector<Pair>& pairs, std::vector<Pair>& scratch);

/// Likewise, and drops duplicates.
void sort_unique(std::vector<Pair>& pairs, std::vector<Pair>& scratch);

}  // namespace broadside::core
