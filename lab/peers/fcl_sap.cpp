// FCL's two sweep and prune managers.
#include <fcl/broadphase/broadphase_SSaP.h>
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

Algorithm fcl_ssap() {
  Algorithm algorithm = fcl_manager(
      [](std::span<const Box3>) -> FclManager { return std::make_unique<fcl::SSaPCollisionManagerd>(); });
  algorithm.name = "fcl_ssap";
  algorithm.summary =
      "FCL's simple sweep and prune: lists of the boxes sorted on each axis, a sweep along one";
  algorithm.source = "FCL, SSaPCollisionManager";
  return algorithm;
}

}  // namespace broadside::lab::peers
