// ODE's three spaces: sweep and prune, hashed grids, and a quadtree.
#include <algorithm>
#include <cmath>

#include "lab/peers/ode_space.hpp"
#include "lab/peers/peers.hpp"
#include "lab/peers/typical_extent.hpp"

namespace broadside::lab::peers {

namespace {

OdeSpace make_sap_space(std::span<const Box3> boxes) {
  // For ODE's dSAP_AXES_XYZ and the like: it sweeps along the first axis.
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

// The space keeps a bit for every pair of boxes, indexed by an int.
constexpr std::size_t max_boxes = 1 << 17;

struct Levels {
  int min;  ///< cells have side 2^level
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
  // Cell coordinates are ints: a box farther away aborts the program.
  constexpr int max_bits = 29;
  const int finest = greatest > 0 ? std::ilogb(greatest) + 1 - max_bits : -max_bits;
  const int min = std::max(std::ilogb(typical_extent(boxes)) + 1, finest);
  return {min, longest > 0 ? std::max(std::ilogb(longest) + 1, min) : min};
}

// The space hashes cell coordinates as unsigned numbers, so a cell may differ between a box that begins below
// 0 and one that begins above, and pairs are lost. This shift makes all coordinates positive. Rounding of the
// sums keeps their order.
double shift_of(std::span<const Box3> boxes) {
  constexpr int bits = 30;
  return std::ldexp(1.0, levels_of(boxes).min + bits);
}

OdeSpace make_hash_space(std::span<const Box3> boxes) {
  // From its manual: the smallest and the largest cells have side 2^level. A box goes to cells of about its
  // own size; the smaller half of all boxes goes where the typical one goes.
  OdeSpace space(dHashSpaceCreate(nullptr));
  const Levels levels = levels_of(boxes);
  dHashSpaceSetLevels(space.get(), levels.min, levels.max);
  return space;
}

}  // namespace

// Its table is new in each search, so the follower searches from nothing.
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
  // Allocates the blocks of the whole tree in advance: about as many leaves as boxes, each at least as large
  // as a box.
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
