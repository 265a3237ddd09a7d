// A fuzzer's bytes as choices, and how it learns of a fault. Any bytes mean something.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/support/drawn_boxes.hpp"
#include "tests/support/rng.hpp"

namespace broadside::fuzz {

using Bytes = ByteChoices;

/// Ends the program, which is how a fuzzer learns of a fault.
inline void expect(bool holds, const std::string& what) {
  if (holds) return;
  std::fprintf(stderr, "%s\n", what.c_str());
  std::abort();
}

/// A box on a small lattice.
template <int D, typename Real>
Box<D, Real> lattice_box(Choices& choices) {
  return random_box<D, Real>(choices, {.places = 12, .max_extent = 3, .infinite_one_in = 0});
}

}  // namespace broadside::fuzz
