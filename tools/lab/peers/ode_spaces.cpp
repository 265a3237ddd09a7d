// ODE's three spaces: sweep and prune, hashed grids, and a quadtree.
#include <algorithm>
#include <cmath>

#include "lab/peers/ode_space.hpp"
#include "lab/peers/peers.hpp"
#include "lab/peers/typical_extent.hpp"

namespace broadside::lab::peers {

namespace {

OdeSpace make_sap_space(std::span<const Box3> boxes) {
  // ODE's dSAP_AXES_XYZ and its like: the first axis is swept along.
  const auto [first, second, third] = axes_by_extent(boxes);
  return OdeSpace(dSweepAndPruneSpaceCreate(nullptr, first | second << 2 | third << 4));
}

}  // namespace

Algorithm ode_sap() {
  Algorithm algorithm = ode_space({.make = make_sap_space});
  algorithm.name = "ode_sap";
  algorithm.summary =
      "ODE's sweep and prune space: radix-sorted along the axis of the longest extent, one sweep";
  algorithm.source = "ODE, dSweepAndPruneSpaceCreate, after Terdiman's OPCODE";
  return algorithm;
}

namespace {

// The space keeps a bit for every pair of boxes and finds it by an int.
constexpr std::size_t max_boxes = 1 << 17;

struct Levels {
  int min;  ///< of cells of 2^least
  int max;
};

Levels levels_of(std::span<const Box3> boxes) {
  double greatest = 0;
  double longest = 0;
  for (const Box3& box : boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      if (std::isinf(box.min[axis]) || std::isinf(box.max[axis])) continue;
      greatest = std::max<double>({greatest, std::abs(box.min[axis]), std::abs(box.max[axis])});
      longest = std::max(longest, double{box.max[axis]} - box.min[axis]);
    }
  }
  // A cell's place is an int: what is farther off aborts the program.
  constexpr int max_bits = 29;
  const int finest = greatest > 0 ? std::ilogb(greatest) + 1 - max_bits : -max_bits;
  const int min = std::max(std::ilogb(typical_extent(boxes)) + 1, finest);
  return {min, longest > 0 ? std::max(std::ilogb(longest) + 1, min) : min};
}

// The space hashes places as unsigned numbers, so that a cell may be another one to a box that begins before
// 0 than to one that begins behind it, and pairs be lost. Among positive places that cannot be. What the sum
// rounds keeps its order.
double shift_of(std::span<const Box3> boxes) {
  constexpr int bits = 30;
  return std::ldexp(1.0, levels_of(boxes).min + bits);
}

OdeSpace make_hash_space(std::span<const Box3> boxes) {
  // Its manual: the sizes of the smallest and the largest cells are 2^level. A box goes to cells as large as
  // itself, and the smaller half of all where the typical one goes.
  OdeSpace space(dHashSpaceCreate(nullptr));
  const Levels levels = levels_of(boxes);
  dHashSpaceSetLevels(space.get(), levels.min, levels.max);
  return space;
}

}  // namespace

// Its table is new in each search, so that following motion is searching.
Algorithm ode_hash() {
  Algorithm algorithm =
      ode_space({.make = make_hash_space, .shift = shift_of, .tracks = false, .max_boxes = max_boxes});
  algorithm.name = "ode_hash";
  algorithm.summary =
      "ODE's hash space: grids of several cell sizes in one table, and a bit for every two boxes";
  algorithm.source = "ODE, dHashSpaceCreate";
  return algorithm;
}

namespace {

OdeSpace make_quadtree_space(std::span<const Box3> boxes) {
  // The blocks of the whole tree are made beforehand: about as many leaves as boxes, none smaller than a box.
  constexpr int greatest_depth = 10;
  dVector3 centre{};
  dVector3 half{};
  double longest = 0;
  for (int axis = 0; axis < 2; ++axis) {
    const auto [low, high] = range_on(axis, boxes);
    centre[axis] = low / 2 + high / 2;
    half[axis] = (high - low) / 2;
    longest = std::max(longest, high - low);
  }
  const double by_count = std::log2(static_cast<double>(boxes.size()) + 1) / 2;
  const double by_extent = longest > 0 ? std::log2(longest / typical_extent(boxes)) : 0;
  const int depth = static_cast<int>(std::clamp(std::min(by_count, by_extent), 0.0, double{greatest_depth}));
  return OdeSpace(dQuadTreeSpaceCreate(nullptr, centre, half, depth));
}

}  // namespace

Algorithm ode_quadtree() {
  Algorithm algorithm = ode_space({.make = make_quadtree_space});
  algorithm.name = "ode_quadtree";
  algorithm.summary = "ODE's quadtree space: each box in the smallest block of x and y that holds it";
  algorithm.source = "ODE, dQuadTreeSpaceCreate";
  return algorithm;
}

}  // namespace broadside::lab::peers
