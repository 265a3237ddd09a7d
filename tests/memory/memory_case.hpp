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

/// Boxes on a lattice, many of which overlap, touch or coincide; a few absent, a few large.
template <int D, typename Real>
std::vector<Box<D, Real>> lattice_boxes(std::size_t count, Rng& rng) {
  int side = 4;
  for (std::size_t room = 1; room < count; room *= D == 2 ? 4 : 8) side *= 2;
  std::vector<Box<D, Real>> boxes(count);
  for (Box<D, Real>& box : boxes) {
    if (rng.one_in(12)) {
      box = absent_box<D, Real>();
      continue;
    }
    const int most = rng.one_in(20) ? side / 2 : 3;
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = static_cast<Real>(rng.whole(0, side)) / 2;
      box.max[axis] = box.min[axis] + static_cast<Real>(rng.whole(0, most)) / 2;
    }
  }
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
