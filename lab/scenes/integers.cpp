// Boxes on random integers, points among them: the same boxes whatever the compiler, for golden hashes.
#include "lab/scenes/descriptions.hpp"
#include "lab/scenes/scatter.hpp"

namespace broadside::lab::generated {
namespace {

constexpr std::uint64_t longest = 8;

template <int D>
std::vector<Box<D>> make(const Settings&, std::size_t count, std::uint64_t seed) {
  const std::uint64_t side = integer_side<D>(count, longest);
  Random random(seed);
  std::vector<Box<D>> boxes(count);
  for (Box<D>& box : boxes) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = static_cast<float>(random.below(side));
      box.max[axis] = box.min[axis] + static_cast<float>(random.below(longest + 1));
    }
  }
  return boxes;
}

}  // namespace

Scene integers() {
  return {
      .name = "integers",
      .summary = "uniform boxes with integer coordinates, 0 to 8 long",
      .source = "Broadside",
      .boxes_2d = make<2>,
      .boxes_3d = make<3>,
      .integers = true,
  };
}

}  // namespace broadside::lab::generated
