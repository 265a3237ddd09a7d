// Scenes with integer coordinates: the same with every compiler, and with many exact ties.
#include "lab/scenes/registry.hpp"
#include "lab/scenes/scatter.hpp"

namespace broadside::lab::generated {
namespace {

/// Boxes at random integers, some of them points: the same boxes with every compiler, for golden hashes.
template <int D>
std::vector<Box<D>> make_integers(const Settings&, std::size_t count, std::uint64_t seed) {
  constexpr std::uint64_t longest = 8;
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

/// The minimum side of a lattice with room for `count` boxes.
template <int D>
std::uint64_t lattice_side(std::size_t count) {
  const auto room = [](std::uint64_t side) { return D == 2 ? side * side : side * side * side; };
  std::uint64_t side = 1;
  while (room(side) < count) ++side;
  return side;
}

/// Unit boxes side by side on the integers: each only touches its neighbours, and every coordinate is a tie.
template <int D>
std::vector<Box<D>> make_lattice(const Settings&, std::size_t count, std::uint64_t seed) {
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

/// The scene of Pierre Terdiman's "Box pruning revisited" (codercorner.com), number for number, so that its
/// published pair count verifies the library: 11,811 pairs at n = 10,000 in 3D.
template <int D>
std::vector<Box<D>> make_terdiman(const Settings&, std::size_t count, std::uint64_t) {
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

Scene integers() {
  return {
      .name = "integers",
      .summary = "uniform boxes with integer coordinates, 0 to 8 long",
      .source = "Broadside",
      .boxes_2d = make_integers<2>,
      .boxes_3d = make_integers<3>,
      .integers = true,
  };
}

Scene lattice() {
  return {
      .name = "lattice",
      .summary = "unit boxes that touch their 8 (26 in 3D) neighbours on a lattice: exact ties everywhere",
      .source = "Broadside",
      .boxes_2d = make_lattice<2>,
      .boxes_3d = make_lattice<3>,
      .integers = true,
  };
}

Scene terdiman() {
  return {
      .name = "terdiman",
      .summary = "Terdiman's published scene: a fixed world of 4096^3; without its z axis in 2D",
      .source = "Terdiman, Box pruning revisited, codercorner.com",
      .boxes_2d = make_terdiman<2>,
      .boxes_3d = make_terdiman<3>,
      .fixed_seed = true,
      .integers = true,
  };
}

}  // namespace broadside::lab::generated
