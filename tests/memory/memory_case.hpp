// What is tried with too little memory: every algorithm of the library with each of its choices, in each
// dimension, on boxes of floats and of doubles.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"
#include "broadside/executor.hpp"

#include "tests/support/rng.hpp"

namespace broadside::laws {

/// One algorithm in one dimension, of one type of coordinates.
struct MemoryCase {
  const Algorithm* algorithm;
  int dimension;
  bool is_double;
};

/// Each algorithm of the library in each dimension that it does and with each type of coordinates.
std::vector<MemoryCase> memory_cases();

/// Those of them that can use several threads, on floats: doubles are searched as floats are.
std::vector<MemoryCase> threaded_memory_cases();

/// Such as "grid_2d_double".
std::string name(const MemoryCase& memory_case);
void PrintTo(const MemoryCase& memory_case, std::ostream* out);

/// The algorithm with nothing set, and with each value of each choice that it takes in this dimension.
std::vector<Spec> specs_of(const MemoryCase& memory_case);

/// Those of them that differ in how several threads work: the first one, and those that find all pairs anew
/// in every frame.
std::vector<Spec> threaded_specs_of(const MemoryCase& memory_case);

/// A box on a lattice on which, of `count` boxes, many overlap, touch or coincide; a few are large.
template <int D, typename Real>
Box<D, Real> lattice_box(std::size_t count, Choices& choices) {
  int side = 4;
  for (std::size_t room = 1; room < count; room *= D == 2 ? 4 : 8) side *= 2;
  const int most = choices.one_in(20) ? side / 2 : 3;
  Box<D, Real> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = static_cast<Real>(choices.whole(0, side)) / 2;
    box.max[axis] = box.min[axis] + static_cast<Real>(choices.whole(0, most)) / 2;
  }
  return box;
}

/// Such boxes, a few absent.
template <int D, typename Real>
std::vector<Box<D, Real>> lattice_boxes(std::size_t count, Choices& choices) {
  std::vector<Box<D, Real>> boxes(count);
  for (Box<D, Real>& box : boxes)
    box = choices.one_in(12) ? absent_box<D, Real>() : lattice_box<D, Real>(count, choices);
  return boxes;
}

/// A test for each case.
class MemoryTest : public testing::TestWithParam<MemoryCase> {
 protected:
  /// Calls `body.operator()<D, Real>()` with the case's dimension and type.
  template <typename Body>
  static void in_case(Body body) {
    const bool is_double = GetParam().is_double;
    if (GetParam().dimension == 2)
      is_double ? body.template operator()<2, double>() : body.template operator()<2, float>();
    else
      is_double ? body.template operator()<3, double>() : body.template operator()<3, float>();
  }

  const Algorithm& algorithm() const { return *GetParam().algorithm; }
};

/// The names of INSTANTIATE_TEST_SUITE_P.
inline std::string case_name(const testing::TestParamInfo<MemoryCase>& info) { return name(info.param); }

}  // namespace broadside::laws
