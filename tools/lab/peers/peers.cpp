// The list of peers; CMakeLists.txt decides at configure time which of them are in this build.
#include "lab/peers/peers.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <iterator>
#include <string_view>

#include "lab/peers/queries.hpp"

namespace broadside::lab::peers {
namespace {

/// Every peer that the lab knows: those built in, and the names of the others.
struct PeerList {
  std::vector<Algorithm> there;
  std::vector<MissingPeer> missing;

  PeerList() {
    // Functions in a discarded branch need not exist.
    if constexpr (BROADSIDE_HAS_CGAL)
      add({cgal_box_intersection()});
    else
      miss("libcgal-dev", {"cgal_box_intersection"});
    if constexpr (BROADSIDE_HAS_BOOST)
      add({boost_rtree()});
    else
      miss("libboost-dev", {"boost_rtree"});
    if constexpr (BROADSIDE_HAS_GEOS)
      add({geos_strtree()});
    else
      miss("libgeos++-dev", {"geos_strtree"});
    if constexpr (BROADSIDE_HAS_EMBREE)
      add({embree_collide()});
    else
      miss("libembree-dev", {"embree_collide"});
    if constexpr (BROADSIDE_HAS_BULLET)
      add({bullet_dbvt(), bullet_axis_sweep()});
    else
      miss("libbullet-dev", {"bullet_dbvt", "bullet_axis_sweep"});
    if constexpr (BROADSIDE_HAS_ODE)
      add({ode_sap(), ode_hash(), ode_quadtree()});
    else
      miss("libode-dev", {"ode_sap", "ode_hash", "ode_quadtree"});
    if constexpr (BROADSIDE_HAS_FCL)
      add({fcl_dynamic_aabb_tree(), fcl_dynamic_aabb_tree_array(), fcl_ssap(), fcl_sap(),
           fcl_spatial_hash()});
    else
      miss("libfcl-dev", {"fcl_dynamic_aabb_tree", "fcl_dynamic_aabb_tree_array", "fcl_ssap", "fcl_sap",
                          "fcl_spatial_hash"});
    if constexpr (BROADSIDE_HAS_BOX2D)
      add({box2d_tree()});
    else
      miss("libbox2d-dev", {"box2d_tree"});
    if constexpr (BROADSIDE_HAS_CHIPMUNK)
      add({chipmunk_bb_tree(), chipmunk_space_hash()});
    else
      miss("libchipmunk-dev", {"chipmunk_bb_tree", "chipmunk_space_hash"});
    if constexpr (BROADSIDE_HAS_RUST_INDEXES)
      add({packed_spatial_index(), geo_index(), rstar_tree()});
    else
      miss_because(BROADSIDE_RUST_INDEXES_MISSING, {"packed_spatial_index", "geo_index", "rstar_tree"});
    if constexpr (BROADSIDE_HAS_RUST_ENGINES)
      add({parry_bvh(), rapier_broad_phase(), obvhs_bvh(), box2d3_tree(), box3d_tree(), physx_abp(),
           physx_sap()});
    else
      miss_because(BROADSIDE_RUST_ENGINES_MISSING, {"parry_bvh", "rapier_broad_phase", "obvhs_bvh",
                                                    "box2d3_tree", "box3d_tree", "physx_abp", "physx_sap"});
  }

  void add(std::initializer_list<Algorithm> algorithms) {
    for (const Algorithm& algorithm : algorithms) {
      there.push_back(algorithm);
      there.back().kind = AlgorithmKind::peer;
    }
  }

  void miss(std::string_view package, std::initializer_list<std::string_view> names) {
    miss_because(std::string(package) + " was missing at configure time; install it and configure again",
                 names);
  }

  void miss_because(const std::string& reason, std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names) missing.push_back({std::string(name), reason});
  }
};

/// The measured cost of assertions in Debian's build of a library; measured by hand: docs/peers.md.
struct BuildNote {
  std::string_view prefix;  ///< of the names of the library's peers
  std::string_view text;
};

constexpr std::array<BuildNote, 3> build_notes = {{
    {"box2d_",
     "Debian's build has assertions, which cost no more than the noise of the measurement: "
     "docs/peers.md"},
    {"embree_", "Debian's build has assertions, whose cost there is not known: docs/peers.md"},
    {"fcl_",
     "Debian's build has assertions, which cost no more than the noise of the measurement: "
     "docs/peers.md"},
}};

const PeerList& peer_list() {
  static const PeerList list;
  return list;
}

}  // namespace

std::vector<Algorithm> peers() { return peer_list().there; }

std::span<const MissingPeer> missing_peers() { return peer_list().missing; }

std::string_view build_note(std::string_view peer) {
  const auto note = std::ranges::find_if(
      build_notes, [peer](const BuildNote& each) { return peer.starts_with(each.prefix); });
  return note == build_notes.end() ? std::string_view() : note->text;
}

bool joins_sets(std::string_view peer) {
  constexpr std::array<std::string_view, 20> names = {"boost_rtree",
                                                      "bullet_dbvt",
                                                      "cgal_box_intersection",
                                                      "embree_collide",
                                                      "fcl_dynamic_aabb_tree",
                                                      "fcl_dynamic_aabb_tree_array",
                                                      "fcl_sap",
                                                      "fcl_spatial_hash",
                                                      "fcl_ssap",
                                                      "geo_index",
                                                      "geos_strtree",
                                                      "karras_lbvh",
                                                      "obvhs_bvh",
                                                      "ode_quadtree",
                                                      "packed_spatial_index",
                                                      "parry_bvh",
                                                      "pbsm_stripes",
                                                      "rstar_tree",
                                                      "terdiman_box_pruning",
                                                      "two_layer_grid"};
  return std::ranges::find(names, peer) != names.end();
}

Tunable threads_tunable() {
  return {.name = "threads",
          .summary = "maximum number of threads; 0: as many as the machine has",
          .default_value = "1",
          .type = Tunable::Type::integer,
          .min = 0,
          .max = 1024};
}

template <int D>
std::vector<std::unique_ptr<QueryPeer<D>>> query_peers(std::span<const Box<D>> boxes) {
  std::vector<std::unique_ptr<QueryPeer<D>>> peers;
  if constexpr (BROADSIDE_HAS_BOOST) peers.push_back(boost_queries<D>(boxes));
  if constexpr (D == 2 && BROADSIDE_HAS_BOX2D) peers.push_back(box2d_queries(boxes));
  if constexpr (D == 3 && BROADSIDE_HAS_EMBREE) peers.push_back(embree_queries(boxes));
  if constexpr (BROADSIDE_HAS_RUST_INDEXES)
    std::ranges::move(rust_queries<D>(boxes), std::back_inserter(peers));
  return peers;
}

template std::vector<std::unique_ptr<QueryPeer<2>>> query_peers(std::span<const Box<2>>);
template std::vector<std::unique_ptr<QueryPeer<3>>> query_peers(std::span<const Box<3>>);

}  // namespace broadside::lab::peers
