// Boxes that all share a point, so that every two overlap: the worst case of every algorithm.
#include "lab/scenes/descriptions.hpp"
#include "lab/scenes/random.hpp"

namespace broadside::lab::generated {
namespace {

template <int D>
std::vector<Box<D>> make(const Settings&, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Box<D>> boxes(count);
  for (Box<D>& box : boxes) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = static_cast<float>(random.between(-1, 0));
      box.max[axis] = static_cast<float>(random.between(0, 1));
    }
  }
  return boxes;
}

}  // namespace

Scene one_point() {
  return {
      .name = "one_point",
      .summary = "every box contains the origin: all n (n - 1) / 2 pairs overlap",
      .source = "Broadside",
      .boxes_2d = make<2>,
      .boxes_3d = make<3>,
  };
}

}  // namespace broadside::lab::generated
