// Boxes of given sizes, scattered so that each touches a given number of others on average.
#include "lab/scenes/scatter.hpp"

#include <algorithm>

namespace broadside::lab {
namespace {

/// The probability that two boxes of these sizes touch, if centred uniformly in a cube of this side.
template <int D>
double chance_of_touching(const Size<D>& a, const Size<D>& b, double side, int first_axis) {
  double chance = 1;
  for (int axis = first_axis; axis < D; ++axis) {
    const double reach = std::min(1.0, (a[axis] + b[axis]) / (2 * side));
    chance *= reach * (2 - reach);
  }
  return chance;
}

/// The same for a random pair of `sizes`. These are in random order, so consecutive ones are a fair sample.
template <int D>
double mean_chance(std::span<const Size<D>> sizes, double side, int first_axis) {
  constexpr std::size_t enough = 1 << 16;
  const std::size_t count = sizes.size();
  const std::size_t rounds = std::min(count - 1, 1 + enough / count);
  double sum = 0;
  for (std::size_t round = 1; round <= rounds; ++round) {
    for (std::size_t i = 0; i < count; ++i)
      sum += chance_of_touching<D>(sizes[i], sizes[(i + round) % count], side, first_axis);
  }
  return sum / (static_cast<double>(rounds) * static_cast<double>(count));
}

}  // namespace

Tunable neighbours_tunable() {
  return {.name = "neighbours",
          .summary = "how many others a box touches on average",
          .default_value = "4",
          .min = 1e-6,
          .max = 1e6};
}

double power(double base, double exponent) {
  if (exponent < 0) return 1 / power(base, -exponent);
  double whole = std::floor(exponent);
  double fraction = exponent - whole;
  double result = 1;
  for (double square = base; whole > 0; whole = std::floor(whole / 2), square *= square) {
    if (std::fmod(whole, 2) == 1) result *= square;
  }
  double root = base;
  for (int bit = 0; bit < 32; ++bit) {
    root = std::sqrt(root);
    fraction *= 2;
    if (fraction >= 1) {
      result *= root;
      fraction -= 1;
    }
  }
  return result;
}

template <int D>
double world_side(std::span<const Size<D>> sizes, double neighbours, int first_axis) {
  if (sizes.size() < 2) return 0;
  const double wanted = neighbours / static_cast<double>(sizes.size() - 1);
  if (wanted >= 1) return 0;
  // In a wide world the probability is proportional to side^-axes, so one step nearly arrives; if boxes fill
  // the world, steps are too short but never overshoot.
  const double inverse_axes = 1.0 / (D - first_axis);
  double side = 1;
  for (int i = 0; i < 50; ++i) {
    const double ratio = mean_chance<D>(sizes, side, first_axis) / wanted;
    side *= power(ratio, inverse_axes);
    if (ratio > 0.999 && ratio < 1.001) break;
  }
  return side;
}

template <int D>
std::uint64_t integer_side(std::size_t count, std::uint64_t longest_side) {
  constexpr std::uint64_t neighbours = 4;
  // Two such intervals, longest_side / 2 long on average, touch at longest_side + 1 of the possible places.
  const auto volume = [](std::uint64_t side) { return D == 2 ? side * side : side * side * side; };
  std::uint64_t side = 1;
  while (volume(side) * neighbours < count * volume(longest_side + 1)) ++side;
  return side;
}

template <int D>
Box<D> box_around(const std::array<double, D>& centre, const Size<D>& size) {
  Box<D> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = static_cast<float>(centre[axis] - size[axis] / 2);
    box.max[axis] = static_cast<float>(centre[axis] + size[axis] / 2);
  }
  return box;
}

template <int D>
std::vector<Box<D>> scatter(std::span<const Size<D>> sizes, double neighbours, Random& random) {
  const double side = world_side<D>(sizes, neighbours);
  std::vector<Box<D>> boxes;
  boxes.reserve(sizes.size());
  for (const Size<D>& size : sizes) {
    std::array<double, D> centre;
    for (double& coordinate : centre) coordinate = random.between(0, side);
    boxes.push_back(box_around<D>(centre, size));
  }
  return boxes;
}

template double world_side<2>(std::span<const Size<2>>, double, int);
template double world_side<3>(std::span<const Size<3>>, double, int);
template std::uint64_t integer_side<2>(std::size_t, std::uint64_t);
template std::uint64_t integer_side<3>(std::size_t, std::uint64_t);
template Box<2> box_around<2>(const std::array<double, 2>&, const Size<2>&);
template Box<3> box_around<3>(const std::array<double, 3>&, const Size<3>&);
template std::vector<Box<2>> scatter<2>(std::span<const Size<2>>, double, Random&);
template std::vector<Box<3>> scatter<3>(std::span<const Size<3>>, double, Random&);

}  // namespace broadside::lab
