// Difficult inputs for a broad phase: ties, points, infinities, outliers, crowds.
#pragma once

#include <string>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"

#include "law_case.hpp"

namespace broadside::laws {

/// Boxes, and why they are difficult.
template <int D>
struct Input {
  std::string name;
  std::vector<Box<D>> boxes;
};

/// All difficult inputs within the algorithm's declared limits. `crowd` is the largest number of coincident
/// boxes in an input; all of them pair with each other.
template <int D>
std::vector<Input<D>> hard_inputs(const Algorithm& algorithm, std::size_t crowd = 300);

/// Whether the box exceeds the algorithm's declared limits; false for the absent box.
template <int D, typename Real>
bool is_beyond(const Algorithm& algorithm, const Box<D, Real>& box);

/// Whether arbitrary boxes without NaN are within the algorithm's limits.
bool takes_any_floats(const Algorithm& algorithm);
inline bool takes_any_boxes(const LawCase& law_case) { return takes_any_floats(*law_case.algorithm); }

}  // namespace broadside::laws
