// ODE's sweep and prune space: Terdiman's box pruning, after a radix sort.
#include "lab/peers/ode_space.hpp"
#include "lab/peers/peers.hpp"

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

}  // namespace broadside::lab::peers
