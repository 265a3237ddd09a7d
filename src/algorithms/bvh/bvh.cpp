// A bounding volume hierarchy (an AABB tree): sixteen boxes to a leaf, sixteen children to a node, joined
// with itself.
//
// The builder is in packer.cpp, the join in kernels/bvh_join.cpp.
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "broadside/debug/outline.hpp"
#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"

#include "algorithms/bvh/packer.hpp"
#include "algorithms/bvh/tracker.hpp"
#include "algorithms/descriptions.hpp"
#include "interface/adaptive_tracker.hpp"
#include "interface/follow_costs.hpp"
#include "interface/outline_text.hpp"
#include "interface/yielding.hpp"
#include "kernels/bvh_join.hpp"
#include "kernels/waste.hpp"

namespace broadside::algorithm {
namespace {

template <int D>
class Bvh final : public PairFinder<D>, public Outlined<D>, public core::Yielding<D> {
 public:
  Outlined<D>* outlined() noexcept override { return this; }
  core::Yielding<D>* yielding() noexcept override { return this; }

  /// A leaf is joined with all behind it.
  bool is_left(const Box<D>&, BoxId a, const Box<D>&, BoxId b) const override {
    return !is_joined_[index(a)] && !is_joined_[index(b)];
  }

 private:
  void find_valid(std::span<const Box<D>> boxes, PairSink& pairs) override {
    this->set_yielded(false);
    if (boxes.empty()) return this->count({});
    packer_.pack(boxes, this->left_count());
    const kernels::PackedBvh<D>& tree = packer_.tree();
    kernels::JoinLimit limit;
    if (this->may_yield()) limit = {kernels::tests_per_box * boxes.size(), kernels::tests_per_pair};
    const kernels::JoinWork work = kernels::join(tree, limit, pairs);
    this->count({.tests = work.tests, .references = boxes.size()});
    if (work.places >= tree.levels[0].size) return;
    this->set_yielded(true);
    is_joined_.assign(boxes.size(), false);
    for (std::size_t place = 0; place < work.places; ++place) {
      const float min = tree.levels[0].min[0][place];
      if (min == min) is_joined_[index(tree.id[place])] = true;  // else it holds no box
    }
  }

  Outline<D> lay_out(std::span<const Box<D>> boxes) override {
    packer_.pack(boxes);
    const kernels::PackedBvh<D>& tree = packer_.tree();
    Outline<D> outline;
    outline.kind = "nodes";
    for (std::size_t level = tree.level_count; level-- > 1;) {
      std::vector<Box<D>>& bounds = outline.levels.emplace_back();
      for (std::size_t place = 0; place < tree.levels[level].size; ++place) {
        Box<D> node;
        for (int axis = 0; axis < D; ++axis) {
          node.min[axis] = tree.levels[level].min[axis][place];
          node.max[axis] = tree.levels[level].max[axis][place];
        }
        if (is_present(node)) bounds.push_back(node);
      }
    }
    const std::size_t leaves = outline.levels.back().size();
    outline.caption = (leaves == 1 ? "1 leaf" : std::to_string(leaves) + " leaves") + " of up to " +
                      std::to_string(kernels::fan_out) + " boxes, " +
                      core::counted(outline.levels.size(), "level") + " of bounds";
    return outline;
  }

  BvhPacker<D> packer_;
  std::vector<bool> is_joined_;  // by id, after a search that gave up
};

template <int D>
std::unique_ptr<PairFinder<D>> make_bvh(const Settings&) {
  return std::make_unique<Bvh<D>>();
}

template <int D>
std::unique_ptr<PairTracker<D>> make_bvh_tracking(const Settings& settings) {
  return std::make_unique<core::AdaptiveTracker<D>>(
      core::update_of(settings), make_bvh<D>(settings), core::tree_finding<D>,
      std::vector<core::Follower<D, float>>{{"bvh", make_bvh_tracker<D>, core::bvh_following<D>}});
}

}  // namespace

Algorithm bvh() {
  return {
      .name = "bvh",
      .summary = "a tree of bounds, sixteen to a node, packed by slabs and joined with itself",
      .source = "S. Leutenegger et al., STR: a simple and efficient algorithm for R-tree packing",
      .tunables = {core::update_tunable()},
      .finder_2d = make_bvh<2>,
      .finder_3d = make_bvh<3>,
      .tracker_2d = make_bvh_tracking<2>,
      .tracker_3d = make_bvh_tracking<3>,
  };
}

}  // namespace broadside::algorithm
