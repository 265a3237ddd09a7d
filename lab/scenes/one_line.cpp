// Boxes with one and the same interval on the x axis: a sweep along x prunes nothing.
#include "lab/scenes/descriptions.hpp"
#include "lab/scenes/scatter.hpp"

namespace broadside::lab::generated {
namespace {

template <int D>
std::vector<Box<D>> make(const Settings& settings, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Size<D>> sizes(count);
  for (Size<D>& size : sizes) {
    size = modest_size<D>(random);
    size[0] = 1;
  }
  const double side = world_side<D>(sizes, settings.number("neighbours"), 1);
  std::vector<Box<D>> boxes;
  boxes.reserve(count);
  for (const Size<D>& size : sizes) {
    std::array<double, D> centre{};
    for (int axis = 1; axis < D; ++axis) centre[axis] = random.between(0, side);
    boxes.push_back(box_around<D>(centre, size));
  }
  return boxes;
}

}  // namespace

Scene one_line() {
  return {
      .name = "one_line",
      .summary = "all boxes have the same interval on the x axis",
      .source = "Broadside",
      .tunables = {neighbours_tunable()},
      .boxes_2d = make<2>,
      .boxes_3d = make<3>,
  };
}

}  // namespace broadside::lab::generated
