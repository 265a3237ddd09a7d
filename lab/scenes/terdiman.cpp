// The scene of Pierre Terdiman's "Box pruning revisited" (codercorner.com), number for number, so that its
// published pair count checks us: 11,811 pairs at n = 10,000 in 3D.
#include "lab/scenes/descriptions.hpp"

namespace broadside::lab::generated {
namespace {

/// The C runtime's rand() with which the scene was published.
class PublishedRandom {
 public:
  std::int32_t next() noexcept {
    state_ = state_ * 214013 + 2531011;
    return static_cast<std::int32_t>(state_ >> 16 & 0x7fff);
  }

 private:
  std::uint32_t state_ = 42;
};

template <int D>
std::vector<Box<D>> make(const Settings&, std::size_t count, std::uint64_t) {
  PublishedRandom random;
  std::vector<Box<D>> boxes(count);
  for (Box<D>& box : boxes) {
    std::array<std::int32_t, 3> centre;
    std::array<std::int32_t, 3> half_extent;
    for (std::int32_t& coordinate : centre) coordinate = (random.next() & 4095) - 2048;
    for (std::int32_t& coordinate : half_extent) coordinate = random.next() & 127;
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = static_cast<float>(centre[axis] - half_extent[axis]);
      box.max[axis] = static_cast<float>(centre[axis] + half_extent[axis]);
    }
  }
  return boxes;
}

}  // namespace

Scene terdiman() {
  return {
      .name = "terdiman",
      .summary = "Terdiman's published scene: a fixed world of 4096^3; without its z axis in 2D",
      .source = "Terdiman, Box pruning revisited, codercorner.com",
      .boxes_2d = make<2>,
      .boxes_3d = make<3>,
      .fixed_seed = true,
      .integers = true,
  };
}

}  // namespace broadside::lab::generated
