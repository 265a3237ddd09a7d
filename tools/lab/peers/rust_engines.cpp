// Physics engines from crates.io, and hierarchies that engines use; how each is driven is in rust/src.
#include <memory>
#include <string>

#include "lab/peers/peers.hpp"
#include "lab/peers/rust_crates.hpp"

namespace broadside::lab::peers {
namespace {

template <int D>
FollowerChoice<D> rust_follower(const std::string& name, const std::string& shown) {
  return {.name = shown,
          .make = [name](const Settings&) { return std::make_unique<RustCrateFollower<D>>(name); }};
}

}  // namespace

Algorithm parry_bvh() {
  Algorithm algorithm = rust_crate("parry2d");
  algorithm.name = "parry_bvh";
  algorithm.summary = "Parry's hierarchy of boxes, built by binning and joined with itself";
  algorithm.source = "parry, Bvh, after Wald 2007";
  algorithm.in_2d = {.searcher = rust_searcher<2>("parry"), .followers = {rust_follower<2>("parry", "Bvh")}};
  algorithm.in_3d = {.searcher = rust_searcher<3>("parry"), .followers = {rust_follower<3>("parry", "Bvh")}};
  return algorithm;
}

Algorithm rapier_broad_phase() {
  Algorithm algorithm = rust_crate("rapier2d");
  algorithm.name = "rapier_broad_phase";
  algorithm.summary = "Rapier's broad phase: parry's hierarchy of boxes with margins, and a table of pairs";
  algorithm.source = "rapier, BroadPhaseBvh";
  algorithm.in_2d = {.searcher = rust_searcher<2>("rapier", true),
                     .followers = {rust_follower<2>("rapier", "BroadPhaseBvh")}};
  algorithm.in_3d = {.searcher = rust_searcher<3>("rapier", true),
                     .followers = {rust_follower<3>("rapier", "BroadPhaseBvh")}};
  return algorithm;
}

Algorithm obvhs_bvh() {
  Algorithm algorithm = rust_crate("obvhs");
  algorithm.name = "obvhs_bvh";
  algorithm.summary = "The hierarchy of obvhs, built by PLOC, and a query for each box";
  algorithm.source = "obvhs, Bvh2 and PlocBuilder, after Meister and Bittner 2018";
  algorithm.in_2d = {.searcher = rust_searcher<2>("obvhs")};
  algorithm.in_3d = {.searcher = rust_searcher<3>("obvhs")};
  return algorithm;
}

}  // namespace broadside::lab::peers
