// Inputs on which a broad phase goes wrong: ties, points, infinities, outliers, crowds.
#pragma once

#include <string>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"

#include "law_case.hpp"

namespace broadside::laws {

/// Boxes and what is hard about them.
template <int D>
struct Input {
  std::string name;
  std::vector<Box<D>> boxes;
};

/// All hard inputs that are within the algorithm's declared limits. `crowd` is how many boxes coincide in the
/// one in which most do; all of them pair with each other.
template <int D>
std::vector<Input<D>> hard_inputs(const Algorithm& algorithm, std::size_t crowd = 300);

/// Whether the box is beyond the algorithm's declared limits; false for the absent box.
template <int D, typename Real>
bool is_beyond(const Algorithm& algorithm, const Box<D, Real>& box);

/// Whether boxes of any floats but NaN are within its limits.
bool takes_any_floats(const Algorithm& algorithm);
inline bool takes_any_boxes(const LawCase& law_case) { return takes_any_floats(*law_case.algorithm); }

}  // namespace broadside::laws
