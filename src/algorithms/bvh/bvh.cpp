// A bounding volume hierarchy (an AABB tree): sixteen boxes to a leaf, sixteen children to a node, joined
// with itself.
//
// The builder is in packer.cpp, the join in kernels/bvh_join.cpp.
#include <algorithm>
#include <cstdint>
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
#include "core/dimensions.hpp"
#include "core/lean.hpp"
#include "core/parallel.hpp"
#include "interface/follow_costs.hpp"
#include "interface/last_test.hpp"
#include "interface/margin_tracker.hpp"
#include "interface/outline_text.hpp"
#include "interface/yielding.hpp"
#include "kernels/bvh_join.hpp"
#include "kernels/waste.hpp"

namespace broadside::algorithm {
namespace {

/// The least leaves that one of several threads joins at a time: enough that the way to them from the root
/// costs nothing.
constexpr std::size_t fewest_leaves = 64;

/// A search that may give up does so in each part by itself, behind a leaf. It is in no more parts than this,
/// since a leaf may meet all others.
constexpr std::size_t most_parts = 64;

template <int D>
class Bvh final : public PairFinder<D>,
                  public Outlined<D>,
                  public core::Yielding<D>,
                  public core::LastTest<D> {
 public:
  Outlined<D>* outlined() noexcept override { return this; }
  core::Yielding<D>* yielding() noexcept override { return this; }
  core::LastTest<D>* last_test() noexcept override { return this; }

  /// A leaf is joined with all behind it.
  bool is_left(const Box<D>&, BoxId a, const Box<D>&, BoxId b) const override {
    const std::uint32_t leaf = std::min(leaf_of_[index(a)], leaf_of_[index(b)]);
    return leaf >= parts_[leaf / leaves_a_part_].next_leaf;
  }

 private:
  void find_valid(std::span<const Box<D>> boxes, PairSink& pairs) override {
    this->set_yielded(false);
    if (boxes.empty()) return this->count({});
    parallel_.start(this->workers(), boxes.size());
    packer_.pack(boxes, parallel_, this->left_count());
    tree_ = packer_.tree();
    tree_.doubles = this->doubles();
    scratch_.resize(std::max(scratch_.size(), parallel_.workers()));
    for (std::vector<std::uint32_t>& scratch : scratch_) scratch.resize(kernels::join_scratch(tree_));
    leaves_a_part_ = fewest_leaves;
    if (this->may_yield()) leaves_a_part_ = std::max(fewest_leaves, leaf_count() / most_parts + 1);
    Statistics statistics = this->may_yield() ? join_or_yield(pairs) : join_all(pairs);
    statistics.references = boxes.size();
    this->count(statistics);
    if (!this->has_yielded()) return;
    leaf_of_.assign(boxes.size(), 0);
    for (std::size_t place = 0; place < tree_.levels[0].size; ++place) {
      const float min = tree_.levels[0].min[0][place];
      if (min == min)  // else it holds no box
        leaf_of_[index(tree_.id[place])] = static_cast<std::uint32_t>(place / kernels::fan_out);
    }
  }

  std::size_t leaf_count() const { return tree_.levels[1].size; }
  std::size_t part_count() const { return (leaf_count() + leaves_a_part_ - 1) / leaves_a_part_; }

  kernels::NodeRange leaves_of(core::Range parts) const {
    return {parts.begin * leaves_a_part_, std::min(parts.end * leaves_a_part_, leaf_count())};
  }

  Statistics join_all(PairSink& pairs) {
    return parallel_.search(
        part_count(), pairs, [this](core::Range parts, std::size_t worker, PairSink& sink) {
          std::uint32_t* const scratch = scratch_[worker].data();
          const kernels::JoinLimit unlimited{.checkpoint = parallel_.checkpoint(worker)};
          return Statistics{.tests = kernels::join(tree_, leaves_of(parts), unlimited, scratch, sink).tests};
        });
  }

  /// Each part may make as many tests as its boxes and pairs account for. Those that are not done then go on,
  /// in order, with what the others have left.
  Statistics join_or_yield(PairSink& pairs) {
    parts_.resize(part_count());
    const auto join = [this](std::size_t part, kernels::NodeRange leaves, std::uint64_t most_tests,
                             std::size_t worker, PairSink& sink) {
      const kernels::JoinLimit limit = {most_tests, kernels::tests_per_pair, parallel_.checkpoint(worker)};
      parts_[part] = kernels::join(tree_, leaves, limit, scratch_[worker].data(), sink);
      return parts_[part].tests;
    };
    Statistics statistics =
        parallel_.search(parts_.size(), pairs, [&](core::Range parts, std::size_t worker, PairSink& sink) {
          Statistics of_parts;
          for (std::size_t part = parts.begin; part < parts.end; ++part) {
            const kernels::NodeRange leaves = leaves_of({part, part + 1});
            const std::uint64_t boxes = (leaves.end - leaves.begin) * kernels::fan_out;
            of_parts.tests += join(part, leaves, kernels::tests_per_box * boxes, worker, sink);
          }
          return of_parts;
        });
    std::uint64_t unused = 0;
    for (const kernels::JoinWork& part : parts_) unused += part.unused;
    for (std::size_t part = 0; part < parts_.size() && !this->has_yielded(); ++part) {
      kernels::NodeRange leaves = leaves_of({part, part + 1});
      leaves.begin = parts_[part].next_leaf;
      if (leaves.begin == leaves.end) continue;
      statistics.tests += join(part, leaves, unused, 0, pairs);
      unused = parts_[part].unused;
      this->set_yielded(parts_[part].next_leaf < leaves.end);
    }
    return statistics;
  }

  Outline<D> lay_out(std::span<const Box<D>> boxes) override {
    if constexpr (core::is_lean) return {};
    parallel_.start(this->workers(), boxes.size());
    packer_.pack(boxes, parallel_);
    const kernels::PackedBvh<D>& tree = packer_.tree();
    Outline<D> outline;
    outline.kind = "nodes";
    for (std::size_t level = tree.level_count; level-- > 1;) {
      auto& bounds = outline.levels.emplace_back();
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

  core::Parallel parallel_;
  BvhPacker<D> packer_;
  kernels::PackedBvh<D> tree_;                       // the packer's
  std::vector<std::vector<std::uint32_t>> scratch_;  // by worker
  std::size_t leaves_a_part_ = fewest_leaves;
  std::vector<kernels::JoinWork> parts_;  // of a search that may give up
  std::vector<std::uint32_t> leaf_of_;    // by id, after one that did
};

template <int D>
std::unique_ptr<PairFinder<D>> make_bvh(const Settings&) {
  return std::make_unique<Bvh<D>>();
}

template <int D>
std::unique_ptr<PairTracker<D>> make_bvh_tracking(const Settings& settings) {
  return core::adaptive_tracker<D, float>(
      core::update_of(settings), make_bvh<D>(settings), core::tree_finding<D>,
      std::vector<core::Follower<D, float>>{{"bvh", make_bvh_tracker<D>, core::bvh_following<D>}});
}

}  // namespace

Algorithm bvh() {
  return {
      .name = "bvh",
      .summary =
          core::unless_lean("a tree of bounds, sixteen to a node, packed by slabs and joined with itself"),
      .source = core::unless_lean(
          "S. Leutenegger et al., STR: a simple and efficient algorithm for R-tree packing"),
      .tunables = {core::threads_tunable(), core::update_tunable()},
      .finder_2d = core::in_dimension<2>(make_bvh<2>),
      .finder_3d = core::in_dimension<3>(make_bvh<3>),
      .tracker_2d = core::in_dimension<2>(make_bvh_tracking<2>),
      .tracker_3d = core::in_dimension<3>(make_bvh_tracking<3>),
  };
}

}  // namespace broadside::algorithm
