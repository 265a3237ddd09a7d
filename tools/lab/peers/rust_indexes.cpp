// Spatial indexes from crates.io; how each is driven is in rust/src.
#include <limits>
#include <string>
#include <utility>

#include "lab/peers/peers.hpp"
#include "lab/peers/rust_crates.hpp"

namespace broadside::lab::peers {

Algorithm rust_crate(const char* crate_name, std::string name, std::string summary, std::string source) {
  const char* const version = rust_peer_version(crate_name);
  return {
      .name = std::move(name),
      .summary = std::move(summary),
      .source = std::move(source),
      .kind = AlgorithmKind::peer,
      .version = std::string(crate_name) + " " + (version == nullptr ? "of unknown version" : version),
      .limits = {.infinite_boxes = false, .max_coordinate = std::numeric_limits<float>::max()},
      .own_allocator = true,
  };
}

Algorithm packed_spatial_index() {
  Algorithm algorithm = rust_crate("packed_spatial_index", "packed_spatial_index",
                                   "An R-tree of doubles packed along a Hilbert curve, joined with itself",
                                   "packed_spatial_index, Index2D and Index3D");
  algorithm.tunables = {threads_tunable()};
  algorithm.in_2d = {.searcher = threaded_rust_searcher<2>("packed_spatial_index")};
  algorithm.in_3d = {.searcher = threaded_rust_searcher<3>("packed_spatial_index")};
  return algorithm;
}

Algorithm geo_index() {
  Algorithm algorithm =
      rust_crate("geo-index", "geo_index", "An R-tree packed along a Hilbert curve, joined with itself",
                 "geo-index, RTree, after Agafonkin's flatbush");
  algorithm.in_2d = {.searcher = rust_searcher<2>("geo_index")};
  return algorithm;
}

Algorithm rstar_tree() {
  Algorithm algorithm =
      rust_crate("rstar", "rstar_tree",
                 "An R*-tree, bulk loaded by overlap minimizing top-down packing and joined with itself",
                 "rstar, RTree, after Lee and Lee 2003");
  algorithm.in_2d = {.searcher = rust_searcher<2>("rstar")};
  algorithm.in_3d = {.searcher = rust_searcher<3>("rstar")};
  return algorithm;
}

}  // namespace broadside::lab::peers
