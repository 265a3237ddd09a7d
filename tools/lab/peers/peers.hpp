// The other libraries in the comparison, with one function for each of their algorithms.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/algorithm.hpp"

namespace broadside::lab::peers {

/// The peers that were built in, in a fixed order.
std::vector<Algorithm> peers();

/// A peer that was left out of this build.
struct MissingPeer {
  std::string name;
  std::string reason;  ///< what was missing at configure time
};

/// The peers that were left out of this build, in the same order. Thread-safe.
std::span<const MissingPeer> missing_peers();

/// Whether a peer, or an algorithm from the literature, has a join of two sets of its own. Others find the
/// pairs of one set and drop some.
bool joins_sets(std::string_view peer);

/// A sentence about the build of a peer's library that affects its times (docs/peers.md); empty if nothing is
/// known.
std::string_view build_note(std::string_view peer);

/// The tunable `threads` of a peer whose library can use several.
Tunable threads_tunable();

// One for each algorithm. Peers that are not in the build are declared but not defined.

Algorithm boost_rtree();
Algorithm bullet_axis_sweep();
Algorithm bullet_dbvt();
Algorithm cgal_box_intersection();
Algorithm embree_collide();
Algorithm geos_strtree();
Algorithm ode_sap();
Algorithm ode_hash();
Algorithm ode_quadtree();
Algorithm fcl_dynamic_aabb_tree();
Algorithm fcl_dynamic_aabb_tree_array();
Algorithm fcl_ssap();
Algorithm fcl_sap();
Algorithm fcl_spatial_hash();
Algorithm box2d_tree();
Algorithm chipmunk_bb_tree();
Algorithm chipmunk_space_hash();
Algorithm packed_spatial_index();
Algorithm geo_index();
Algorithm rstar_tree();
Algorithm parry_bvh();
Algorithm rapier_broad_phase();
Algorithm obvhs_bvh();
Algorithm box2d3_tree();
Algorithm box3d_tree();
Algorithm physx_abp();
Algorithm physx_sap();

}  // namespace broadside::lab::peers
