// The pairs of a frame by the definition and nothing else: what every algorithm is measured against.
#pragma once

#include <span>
#include <vector>

#include "broadside/tracker.hpp"

namespace broadside::core {

/// Every pair of present boxes that overlap, accept each other and are not ignored; sorted. n^2 / 2 tests.
template <int D, typename Real>
std::vector<Pair> pairs_by_definition(const Frame<D, Real>& frame) {
  std::vector<Pair> pairs;
  const std::span<const Box<D, Real>> boxes = frame.boxes;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!is_present(boxes[i])) continue;
    for (std::size_t j = i + 1; j < boxes.size(); ++j) {
      if (!overlap(boxes[i], boxes[j]) || !is_present(boxes[j])) continue;
      if (!frame.filters.empty() && !accepts(frame.filters[i], frame.filters[j])) continue;
      const Pair pair{BoxId(i), BoxId(j)};
      if (frame.ignored == nullptr || !frame.ignored->contains(pair)) pairs.push_back(pair);
    }
  }
  return pairs;
}

}  // namespace broadside::core
