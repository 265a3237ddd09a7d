// Boxes of given sizes, scattered so that each touches a given number of others on average.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"

#include "lab/scenes/random.hpp"

namespace broadside::lab {

/// The extents of a box.
template <int D>
using Size = std::array<double, D>;

/// The tunable for the number of others that a box touches.
Tunable neighbours_tunable();

/// base^exponent, for base > 0, to about nine digits. Made of products and square roots, which IEEE 754
/// rounds in only one way; pow() differs between machines.
double power(double base, double exponent);

/// The side of the cube in which boxes of these sizes, centred uniformly, touch `neighbours` others on
/// average; 0 if there are too few others. Scatters only on axes from `first_axis` on: on earlier axes, all
/// boxes touch. Cost O(n).
template <int D>
double world_side(std::span<const Size<D>> sizes, double neighbours, int first_axis = 0);

/// The minimum side of a cube in which `count` boxes at random integers, each uniformly 0 to `longest` long,
/// touch about 4 others; computed without floating point.
template <int D>
std::uint64_t integer_side(std::size_t count, std::uint64_t longest);

/// The box of this size around this centre.
template <int D>
Box<D> box_around(const std::array<double, D>& centre, const Size<D>& size);

/// One box of each size, centred uniformly in a cube in which it touches `neighbours` others on average.
template <int D>
std::vector<Box<D>> scatter(std::span<const Size<D>> sizes, double neighbours, Random& random);

/// A box of size about 1: each extent is uniform in [0.5, 1.5).
template <int D>
Size<D> modest_size(Random& random) {
  Size<D> size;
  for (double& extent : size) extent = random.between(0.5, 1.5);
  return size;
}

}  // namespace broadside::lab
