// Where a sweep and prune is tried: worlds without bounds, and towers on one ground.
#include "paper/experiments/sweep_worlds.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "lab/scenes/scatter.hpp"

namespace broadside::lab {
namespace {

const std::string compact = "compact";
const std::string covered = "4 boxes over all";

std::vector<Box2> compact_boxes(std::size_t count) {
  Random random(1);
  std::vector<Size<2>> sizes(count);
  for (Size<2>& size : sizes) size = modest_size<2>(random);
  return scatter<2>(sizes, 4, random);
}

/// The last box is at this many times the world's side from the others.
template <int Exponent>
std::vector<Box2> with_one_far_away(std::size_t count) {
  std::vector<Box2> boxes = compact_boxes(count);
  const double far = power(10, Exponent) * std::sqrt(static_cast<double>(count));
  const auto begin = static_cast<float>(far);
  boxes.back() = {{begin, begin}, {begin, begin}};
  return boxes;
}

std::vector<Box2> with_four_over(std::size_t count, float least, float most) {
  std::vector<Box2> boxes = compact_boxes(count);
  for (std::size_t i = 1; i <= 4; ++i) boxes[i * count / 5] = {{least, least}, {most, most}};
  return boxes;
}

std::vector<Box2> with_four_over_all(std::size_t count) {
  const auto most = static_cast<float>(2 * std::sqrt(static_cast<double>(count)));
  return with_four_over(count, -most, most);
}

std::vector<Box2> with_four_infinite(std::size_t count) {
  constexpr float most = std::numeric_limits<float>::infinity();
  return with_four_over(count, -most, most);
}

std::vector<Box2> grown_boxes(std::size_t count) {
  std::vector<Box2> boxes = compact_boxes(count);
  for (Box2& box : boxes) {
    for (int axis = 0; axis < 2; ++axis) {
      const float extent = box.max[axis] - box.min[axis];
      box.min[axis] *= 1000;
      box.max[axis] = box.min[axis] + extent;
    }
  }
  return boxes;
}

}  // namespace

const std::vector<SweepWorld>& sweep_worlds() {
  static const std::vector<SweepWorld> all = {{compact, compact, compact_boxes},
                                              {"1,000 times as wide", compact, grown_boxes},
                                              {"1 box a thousand sides away", compact, with_one_far_away<3>},
                                              {"1 box a million sides away", compact, with_one_far_away<6>},
                                              {"1 box 10^30 sides away", compact, with_one_far_away<30>},
                                              {covered, covered, with_four_over_all},
                                              {infinite_world, covered, with_four_infinite}};
  return all;
}

template <int D>
std::vector<Box<D>> towers(const Settings&, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  const double side = std::pow(static_cast<double>(count) * std::pow(2, D - 1) / 4, 1.0 / (D - 1));
  std::vector<Box<D>> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    Size<D> size = modest_size<D>(random);
    size[D - 1] *= 20;
    std::array<double, D> centre{};
    for (int axis = 0; axis + 1 < D; ++axis) centre[axis] = random.between(0, side);
    Box<D> box = box_around<D>(centre, size);
    box.min[D - 1] = 0;
    boxes.push_back(box);
  }
  return boxes;
}

template std::vector<Box<2>> towers<2>(const Settings&, std::size_t, std::uint64_t);
template std::vector<Box<3>> towers<3>(const Settings&, std::size_t, std::uint64_t);

}  // namespace broadside::lab
