// FCL's SpatialHashingCollisionManager: a hashed grid.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fcl/broadphase/broadphase_spatialhash.h>
#include <fcl/broadphase/detail/sparse_hash_table.h>
#include <fcl/broadphase/detail/spatial_hash.h>

#include "lab/peers/fcl_boxes.hpp"
#include "lab/peers/peers.hpp"
#include "lab/peers/typical_extent.hpp"

namespace broadside::lab::peers {
namespace {

// As in FCL's own tests: a table that grows, over the bounds of all objects.
using Table = fcl::detail::SparseHashTable<fcl::AABBd, fcl::CollisionObjectd*, fcl::detail::SpatialHashd>;
using Manager = fcl::SpatialHashingCollisionManager<double, Table>;

FclManager make_hash(std::span<const Box3> boxes) {
  const double cell = std::exp2(std::ceil(std::log2(cell_size(boxes, 1))));
  // A box that ends on a cell's border is not filed in the next cell, where one that touches it begins. With
  // cells of a power of two that start at an odd multiple of 2^-30 cells, no float lies on a border.
  constexpr double offset = 0.40625 + 0x1p-30;
  fcl::Vector3d min = fcl::Vector3d::Zero();
  fcl::Vector3d max = fcl::Vector3d::Zero();
  for (int axis = 0; axis < 3 && !boxes.empty(); ++axis) {
    double least = std::numeric_limits<double>::infinity();
    double greatest = -least;
    for (const Box3& box : boxes) {
      least = std::min<double>(least, box.min[axis]);
      greatest = std::max<double>(greatest, box.max[axis]);
    }
    min[axis] = (std::floor(least / cell) - 1 + offset) * cell;
    max[axis] = (std::ceil(greatest / cell) + 1 + offset) * cell;
  }
  return std::make_unique<Manager>(cell, min, max);
}

}  // namespace

Algorithm fcl_spatial_hash() {
  Algorithm algorithm = fcl_manager(make_hash);
  algorithm.name = "fcl_spatial_hash";
  algorithm.summary =
      "FCL's spatial hashing: boxes in every cell they touch, each box looked up in all its cells";
  algorithm.source = "FCL, SpatialHashingCollisionManager";
  return algorithm;
}

}  // namespace broadside::lab::peers
