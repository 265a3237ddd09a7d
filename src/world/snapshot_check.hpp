// Checks that the parts of a snapshot agree with each other.
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

/// Throws InvalidSnapshot, which names a pair and says what is wrong with it.
[[noreturn]] inline void refuse(Pair pair, const std::string& what) {
  throw InvalidSnapshot("a snapshot contradicts itself: the pair (" + std::to_string(index(pair.first)) +
                        ", " + std::to_string(index(pair.second)) + ") " + what);
}

/// Throws InvalidSnapshot for the first of `pairs` that is among `others`; both sorted.
inline void expect_apart(const std::vector<Pair>& pairs, const std::vector<Pair>& others, const char* what) {
  auto other = others.begin();
  for (const Pair pair : pairs) {
    other = std::lower_bound(other, others.end(), pair);
    if (other != others.end() && *other == pair) refuse(pair, what);
  }
}

/// Throws InvalidSnapshot for the first of `pairs` that is not among `others`; both sorted.
inline void expect_within(const std::vector<Pair>& pairs, const std::vector<Pair>& others, const char* what) {
  auto other = others.begin();
  for (const Pair pair : pairs) {
    other = std::lower_bound(other, others.end(), pair);
    if (other == others.end() || *other != pair) refuse(pair, what);
  }
}

/// The pairs that are in one of the two and not in the other; all sorted.
inline std::vector<Pair> difference(const std::vector<Pair>& a, const std::vector<Pair>& b) {
  std::vector<Pair> pairs;
  std::ranges::set_symmetric_difference(a, b, std::back_inserter(pairs));
  return pairs;
}

}  // namespace broadside::core
