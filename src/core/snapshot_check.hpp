// What is asked of a snapshot that is read: that its parts agree with each other.
#pragma once

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "broadside/error.hpp"
#include "broadside/pair.hpp"

namespace broadside::core {

/// Throws InvalidSnapshot, which says `what` is wrong, unless it holds.
inline void expect(bool holds, const char* what) {
  if (!holds) throw InvalidSnapshot(std::string("a snapshot contradicts itself: ") + what);
}

/// The pairs that are in one of the two and not in the other; all sorted.
inline std::vector<Pair> difference(const std::vector<Pair>& a, const std::vector<Pair>& b) {
  std::vector<Pair> pairs;
  std::ranges::set_symmetric_difference(a, b, std::back_inserter(pairs));
  return pairs;
}

}  // namespace broadside::core
