// The pairs of a search as a list.
#pragma once

#include <cstddef>
#include <vector>

#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

namespace broadside::laws {

/// All pairs of a search of `boxes`, in its order; between two sets if `left_count` is not 0.
template <int D, typename Real>
std::vector<Pair> found(Finder<D, Real>& finder, const std::vector<Box<D, Real>>& boxes,
                        std::size_t left_count = 0) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  if (left_count == 0)
    finder.find(boxes, collector);
  else
    finder.find_across(boxes, left_count, collector);
  return pairs;
}

}  // namespace broadside::laws
