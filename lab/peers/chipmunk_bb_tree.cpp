// Chipmunk's cpBBTree: a binary tree of bounding boxes that keeps the pairs of its leaves.
#include "lab/peers/chipmunk_index.hpp"
#include "lab/peers/peers.hpp"

namespace broadside::lab::peers {
namespace {

ChipmunkIndex make_tree(std::span<const Box2>, bool moving, cpSpatialIndex* resting) {
  ChipmunkIndex tree(cpBBTreeNew(bounds_of, resting));
  // Margins are for what moves.
  if (moving)
    cpBBTreeSetVelocityFunc(tree.get(),
                            [](void* object) { return static_cast<ChipmunkObject*>(object)->velocity; });
  return tree;
}

}  // namespace

Algorithm chipmunk_bb_tree() {
  Algorithm algorithm = chipmunk_index(make_tree);
  algorithm.name = "chipmunk_bb_tree";
  algorithm.summary = "Chipmunk's bounding box tree, filled one by one, which keeps its leaves' pairs";
  algorithm.source = "Chipmunk, cpBBTree in cpSpatialIndex.h";
  return algorithm;
}

}  // namespace broadside::lab::peers
