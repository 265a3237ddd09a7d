// Inputs on which a broad phase goes wrong: ties, points, infinities, outliers, crowds.
#pragma once

#include <string>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"

namespace broadside::laws {

/// Boxes and what is hard about them.
template <int D>
struct Input {
  std::string name;
  std::vector<Box<D>> boxes;
};

/// All hard inputs that are within the algorithm's declared limits.
template <int D>
std::vector<Input<D>> hard_inputs(const Algorithm& algorithm);

/// Whether the box has an infinite coordinate; false for the absent box.
template <int D>
bool is_infinite(const Box<D>& box);

}  // namespace broadside::laws
