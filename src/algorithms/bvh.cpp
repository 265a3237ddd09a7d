// A bounding volume hierarchy: sixteen boxes to a leaf, sixteen children to a node, joined with itself.
//
// The builder is in bvh_tree.cpp, the join in kernels/box_tree.cpp.
#include <memory>

#include "broadside/broad_phase.hpp"

#include "algorithms/bvh_tracker.hpp"
#include "algorithms/bvh_tree.hpp"
#include "algorithms/descriptions.hpp"
#include "kernels/box_tree.hpp"

namespace broadside::own {
namespace {

template <int D>
class Bvh final : public PairFinder<D> {
 private:
  void find_valid(std::span<const Box<D>> boxes, PairSink& pairs) override {
    if (boxes.empty()) return this->count({});
    packer_.pack(boxes, this->left_count());
    this->count({.tests = kernels::join(packer_.tree(), pairs), .references = boxes.size()});
  }

  BoxTreePacker<D> packer_;
};

template <int D>
std::unique_ptr<PairTracker<D>> make_tracker(const Settings& settings) {
  return make_bvh_tracker<D>(settings, std::make_unique<Bvh<D>>());
}

}  // namespace

Algorithm bvh() {
  return {
      .name = "bvh",
      .summary = "a tree of bounds, sixteen to a node, packed by slabs and joined with itself",
      .source = "S. Leutenegger et al., STR: a simple and efficient algorithm for R-tree packing",
      .tunables = bvh_tracking(),
      .finder_2d = [](const Settings&) { return std::make_unique<Bvh<2>>(); },
      .finder_3d = [](const Settings&) { return std::make_unique<Bvh<3>>(); },
      .tracker_2d = make_tracker<2>,
      .tracker_3d = make_tracker<3>,
  };
}

}  // namespace broadside::own
