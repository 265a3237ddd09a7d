// The pairs that a definition gives, for laws of pairs by distance.
#pragma once

#include <algorithm>
#include <cstddef>

#include "tests/support/boxes.hpp"

namespace broadside::laws {

/// The pairs of one set, or of its first `left_count` boxes with the others, as places in the two.
template <typename Within>
Pairs reference(std::size_t count, std::size_t left_count, const Within& within) {
  Pairs pairs;
  for (std::size_t i = 0; i < (left_count == 0 ? count : left_count); ++i) {
    for (std::size_t j = std::max(i + 1, left_count); j < count; ++j) {
      if (within(i, j)) pairs.push_back({BoxId(i), BoxId(j - left_count)});
    }
  }
  return pairs;
}

inline Pairs sorted(Pairs pairs) {
  std::ranges::sort(pairs);
  return pairs;
}

}  // namespace broadside::laws
