// Chipmunk's cpSpaceHash: a hashed grid.
#include <algorithm>

#include "lab/peers/chipmunk_index.hpp"
#include "lab/peers/peers.hpp"
#include "lab/peers/typical_extent.hpp"

namespace broadside::lab::peers {
namespace {

ChipmunkIndex make_hash(std::span<const Box2> boxes, bool, cpSpatialIndex* resting) {
  // Its manual: cells about as large as the objects, and ten times as many cells as objects.
  constexpr std::size_t cells_a_box = 10;
  constexpr std::size_t most_cells = 100'000'000;
  const std::size_t cells = std::min(cells_a_box * std::max<std::size_t>(boxes.size(), 1), most_cells);
  return ChipmunkIndex(cpSpaceHashNew(cell_size(boxes, 1), static_cast<int>(cells), bounds_of, resting));
}

}  // namespace

Algorithm chipmunk_space_hash() {
  Algorithm algorithm = chipmunk_index(make_hash);
  algorithm.name = "chipmunk_space_hash";
  algorithm.summary =
      "Chipmunk's spatial hash: boxes in every cell they touch, in a table by the cell's hash";
  algorithm.source = "Chipmunk, cpSpaceHash in cpSpatialIndex.h";
  return algorithm;
}

}  // namespace broadside::lab::peers
