// FCL's SSaPCollisionManager: a sweep over boxes sorted anew on every axis.
#include <fcl/broadphase/broadphase_SSaP.h>

#include "lab/peers/fcl_boxes.hpp"
#include "lab/peers/peers.hpp"

namespace broadside::lab::peers {

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
