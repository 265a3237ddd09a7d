// ODE's quadtree space: a full quadtree over x and y, each box in the smallest block that holds it.
#include <algorithm>
#include <cmath>

#include "lab/peers/ode_space.hpp"
#include "lab/peers/peers.hpp"
#include "lab/peers/typical_extent.hpp"

namespace broadside::lab::peers {
namespace {

OdeSpace make_quadtree_space(std::span<const Box3> boxes) {
  // The blocks of the whole tree are made beforehand: about as many leaves as boxes, none smaller than a box.
  constexpr int greatest_depth = 10;
  dVector3 centre{};
  dVector3 half{};
  double longest = 0;
  for (int axis = 0; axis < 2; ++axis) {
    const auto [least, greatest] = range_on(axis, boxes);
    centre[axis] = least / 2 + greatest / 2;
    half[axis] = (greatest - least) / 2;
    longest = std::max(longest, greatest - least);
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
