// FCL's SaPCollisionManager: linked lists of end points on every axis, and a list of the pairs.
#include <fcl/broadphase/broadphase_SaP.h>

#include "lab/peers/fcl_boxes.hpp"
#include "lab/peers/peers.hpp"

namespace broadside::lab::peers {

// It finds pairs when objects are registered, and loses those that only touch, since equal end points are in
// no order: therefore the widened bounds. Its update() looks for each pair through the list of all, and
// taking an object out reads what was erased, so motion is followed by registering all again.
Algorithm fcl_sap() {
  constexpr bool widened = true;
  Algorithm algorithm = fcl_manager(
      [](std::span<const Box3>) -> FclManager { return std::make_unique<fcl::SaPCollisionManagerd>(); },
      widened);
  algorithm.name = "fcl_sap";
  algorithm.summary = "FCL's sweep and prune: sorted lists of end points, from which the pairs are kept";
  algorithm.source = "FCL, SaPCollisionManager, after I-COLLIDE";
  return algorithm;
}

}  // namespace broadside::lab::peers
