// Unit boxes side by side on the integers: each only touches its neighbours, and every coordinate is a tie.
#include "lab/scenes/descriptions.hpp"
#include "lab/scenes/random.hpp"

namespace broadside::lab::generated {
namespace {

/// The least side of a lattice that has room for `count` boxes.
template <int D>
std::uint64_t lattice_side(std::size_t count) {
  const auto room = [](std::uint64_t side) { return D == 2 ? side * side : side * side * side; };
  std::uint64_t side = 1;
  while (room(side) < count) ++side;
  return side;
}

template <int D>
std::vector<Box<D>> make(const Settings&, std::size_t count, std::uint64_t seed) {
  const std::uint64_t side = lattice_side<D>(count);
  std::vector<Box<D>> boxes(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t rest = i;
    for (int axis = 0; axis < D; ++axis) {
      boxes[i].min[axis] = static_cast<float>(rest % side);
      boxes[i].max[axis] = boxes[i].min[axis] + 1;
      rest /= side;
    }
  }
  Random(seed).shuffle(boxes, count);
  return boxes;
}

}  // namespace

Scene lattice() {
  return {
      .name = "lattice",
      .summary = "unit boxes that touch their 8 (26 in 3D) neighbours on a lattice: exact ties everywhere",
      .source = "Broadside",
      .boxes_2d = make<2>,
      .boxes_3d = make<3>,
      .integers = true,
  };
}

}  // namespace broadside::lab::generated
