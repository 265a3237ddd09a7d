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

/// Likewise for a library that can use several threads and has the tunable `threads`.
template <int D>
FollowerChoice<D> threaded_rust_follower(const std::string& name, const std::string& shown) {
  return {.name = shown, .make = [name](const Settings& settings) {
            const auto threads = static_cast<std::size_t>(settings.integer("threads"));
            return std::make_unique<RustCrateFollower<D>>(name, threads);
          }};
}

/// The version of an engine that a crate has the sources of.
void name_engine(Algorithm& algorithm, const std::string& engine) {
  algorithm.version = engine + " (" + algorithm.version + ")";
}

/// Boxes beyond this overflow when a tree squares a distance or multiplies sides.
constexpr float max_tree_coordinate = 1e18f;

/// One of PhysX's broad phases.
Algorithm physx(const std::string& name, const std::string& summary, const std::string& source) {
  Algorithm algorithm = rust_crate("physx-sys", name, summary, source);
  name_engine(algorithm, "PhysX 5.1.3");
  algorithm.in_3d = {.searcher = rust_searcher<3>(name),
                     .followers = {rust_follower<3>(name, "PxBroadPhase")}};
  algorithm.limits.max_coordinate = 1e37f;
  return algorithm;
}

}  // namespace

Algorithm parry_bvh() {
  Algorithm algorithm = rust_crate("parry2d", "parry_bvh",
                                   "Parry's hierarchy of boxes, built by binning and joined with itself",
                                   "parry, Bvh, after Wald 2007");
  algorithm.in_2d = {.searcher = rust_searcher<2>("parry"), .followers = {rust_follower<2>("parry", "Bvh")}};
  algorithm.in_3d = {.searcher = rust_searcher<3>("parry"), .followers = {rust_follower<3>("parry", "Bvh")}};
  return algorithm;
}

Algorithm rapier_broad_phase() {
  Algorithm algorithm =
      rust_crate("rapier2d", "rapier_broad_phase",
                 "Rapier's broad phase: parry's hierarchy of boxes with margins, and a table of pairs",
                 "rapier, BroadPhaseBvh");
  algorithm.in_2d = {.searcher = rust_searcher<2>("rapier", true),
                     .followers = {rust_follower<2>("rapier", "BroadPhaseBvh")}};
  algorithm.in_3d = {.searcher = rust_searcher<3>("rapier", true),
                     .followers = {rust_follower<3>("rapier", "BroadPhaseBvh")}};
  return algorithm;
}

Algorithm obvhs_bvh() {
  Algorithm algorithm =
      rust_crate("obvhs", "obvhs_bvh", "The hierarchy of obvhs, built by PLOC, and a query for each box",
                 "obvhs, Bvh2 and PlocBuilder, after Meister and Bittner 2018");
  algorithm.in_2d = {.searcher = rust_searcher<2>("obvhs")};
  algorithm.in_3d = {.searcher = rust_searcher<3>("obvhs")};
  return algorithm;
}

Algorithm box2d3_tree() {
  Algorithm algorithm =
      rust_crate("boxdd-sys", "box2d3_tree",
                 "Box2D 3's dynamic tree of boxes with margins, whose enlarged parts are rebuilt",
                 "Box2D 3, b2DynamicTree");
  name_engine(algorithm, "Box2D 3.2.0");
  algorithm.tunables = {threads_tunable()};
  algorithm.in_2d = {.searcher = threaded_rust_searcher<2>("box2d3"),
                     .followers = {threaded_rust_follower<2>("box2d3", "b2DynamicTree")}};
  algorithm.limits.max_coordinate = max_tree_coordinate;
  return algorithm;
}

Algorithm box3d_tree() {
  Algorithm algorithm = rust_crate(
      "boxddd-sys", "box3d_tree",
      "Box3D's dynamic tree of boxes with margins, whose enlarged parts are rebuilt", "Box3D, b3DynamicTree");
  name_engine(algorithm, "Box3D 0.1.0");
  algorithm.tunables = {threads_tunable()};
  algorithm.in_3d = {.searcher = threaded_rust_searcher<3>("box3d"),
                     .followers = {threaded_rust_follower<3>("box3d", "b3DynamicTree")}};
  algorithm.limits.max_coordinate = max_tree_coordinate;
  return algorithm;
}

Algorithm physx_abp() {
  return physx("physx_abp",
               "PhysX's automatic box pruning: sorted boxes in five buckets, swept, and a table of pairs",
               "PhysX, PxBroadPhaseType::eABP, after Terdiman's box pruning");
}

Algorithm physx_sap() {
  return physx("physx_sap", "PhysX's sweep and prune: sorted bounds on three axes, and a table of pairs",
               "PhysX, PxBroadPhaseType::eSAP");
}

}  // namespace broadside::lab::peers
