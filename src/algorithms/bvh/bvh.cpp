// A bounding volume hierarchy (an AABB tree): sixteen boxes to a leaf, sixteen children to a node, joined
// with itself.
//
// The builder is in packer.cpp, the join in kernels/bvh_join.cpp.
#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/debug/outline.hpp"

#include "algorithms/bvh/bvh_packer.hpp"
#include "algorithms/follow_costs.hpp"
#include "algorithms/followers.hpp"
#include "algorithms/outline_text.hpp"
#include "algorithms/registry.hpp"
#include "algorithms/sweep_bounds.hpp"
#include "core/parallel.hpp"
#include "core/tunables.hpp"
#include "kernels/bvh_join.hpp"

namespace broadside::algorithm {
namespace {

/// The fewest leaves that a worker joins at a time: enough that the descent to them costs next to nothing.
constexpr std::size_t min_leaves_per_part = 64;

/// In a search that may give up, each part does so by itself, after a leaf. It has at most this many parts,
/// since a leaf may be joined with all others before its part gives up.
constexpr std::size_t max_parts = 64;

template <int D>
class BvhSearcher final : public Searcher<D> {
 public:
  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    const std::size_t size = input.boxes.size();
    if (size == 0) return Statistics{};
    parallel_.start(input.workers, size);
    packer_.pack(input.boxes, parallel_, input.left_count);
    tree_ = packer_.tree();
    tree_.doubles = input.doubles;
    scratch_.resize(std::max(scratch_.size(), parallel_.workers()));
    for (std::vector<std::uint32_t>& scratch : scratch_) scratch.resize(kernels::join_scratch(tree_));
    leaves_per_part_ = min_leaves_per_part;
    Statistics statistics;
    if (input.successor == nullptr) {
      statistics = join_all(pairs);
    } else {
      leaves_per_part_ = std::max(min_leaves_per_part, leaf_count() / max_parts + 1);
      bool gave_up = false;
      statistics = join_or_give_up(pairs, gave_up);
      if (gave_up) hand_over(size, *input.successor);
    }
    statistics.references = size;
    return statistics;
  }

  Outline<D> lay_out(std::span<const Box<D>> boxes, const Workers& workers) {
    parallel_.start(workers, boxes.size());
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
                      counted(outline.levels.size(), "level") + " of bounds";
    return outline;
  }

 private:
  /// Says which pairs are missing. A pair is found at the earlier of its two leaves.
  void hand_over(std::size_t boxes, Successor<D>& successor) {
    leaf_of_.assign(boxes, 0);
    for (std::size_t place = 0; place < tree_.levels[0].size; ++place) {
      const float min = tree_.levels[0].min[0][place];
      if (min == min)  // NaN: no box here
        leaf_of_[index(tree_.id[place])] = static_cast<std::uint32_t>(place / kernels::fan_out);
    }
    successor.finish([this](const Box<D>&, BoxId a, const Box<D>&, BoxId b) {
      const std::uint32_t leaf = std::min(leaf_of_[index(a)], leaf_of_[index(b)]);
      return leaf >= parts_[leaf / leaves_per_part_].next_leaf;
    });
  }

  std::size_t leaf_count() const { return tree_.levels[1].size; }
  std::size_t part_count() const { return (leaf_count() + leaves_per_part_ - 1) / leaves_per_part_; }

  kernels::NodeRange leaves_of(core::Range parts) const {
    return {parts.begin * leaves_per_part_, std::min(parts.end * leaves_per_part_, leaf_count())};
  }

  Statistics join_all(PairSink& pairs) {
    return parallel_.search(
        part_count(), pairs, [this](core::Range parts, std::size_t worker, PairSink& sink) {
          std::uint32_t* const scratch = scratch_[worker].data();
          const kernels::JoinLimit unlimited{.checkpoint = parallel_.checkpoint(worker)};
          return Statistics{.tests = kernels::join(tree_, leaves_of(parts), unlimited, scratch, sink).tests};
        });
  }

  /// Each part may make as many tests as its boxes and pairs account for. Unfinished parts then continue, in
  /// order, with the tests that the others have left.
  Statistics join_or_give_up(PairSink& pairs, bool& gave_up) {
    parts_.resize(part_count());
    const auto join = [this](std::size_t part, kernels::NodeRange leaves, std::uint64_t max_tests,
                             std::size_t worker, PairSink& sink) {
      const kernels::JoinLimit limit = {max_tests, max_tests_per_pair, parallel_.checkpoint(worker)};
      parts_[part] = kernels::join(tree_, leaves, limit, scratch_[worker].data(), sink);
      return parts_[part].tests;
    };
    Statistics statistics =
        parallel_.search(parts_.size(), pairs, [&](core::Range parts, std::size_t worker, PairSink& sink) {
          Statistics of_parts;
          for (std::size_t part = parts.begin; part < parts.end; ++part) {
            const kernels::NodeRange leaves = leaves_of({part, part + 1});
            const std::uint64_t boxes = (leaves.end - leaves.begin) * kernels::fan_out;
            of_parts.tests += join(part, leaves, max_tests_per_box * boxes, worker, sink);
          }
          return of_parts;
        });
    std::uint64_t unused = 0;
    for (const kernels::JoinWork& part : parts_) unused += part.unused;
    for (std::size_t part = 0; part < parts_.size() && !gave_up; ++part) {
      kernels::NodeRange leaves = leaves_of({part, part + 1});
      leaves.begin = parts_[part].next_leaf;
      if (leaves.begin == leaves.end) continue;
      statistics.tests += join(part, leaves, unused, 0, pairs);
      unused = parts_[part].unused;
      gave_up = parts_[part].next_leaf < leaves.end;
    }
    return statistics;
  }

  core::Parallel parallel_;
  BvhPacker<D> packer_;
  kernels::PackedBvh<D> tree_;                       // the packer's
  std::vector<std::vector<std::uint32_t>> scratch_;  // by worker
  std::size_t leaves_per_part_ = min_leaves_per_part;
  std::vector<kernels::JoinWork> parts_;  // of a search that may give up
  std::vector<std::uint32_t> leaf_of_;    // by id, after a search gave up
};

template <int D>
Strategies<D> bvh_strategies() {
  return {.searcher = make_strategy<BvhSearcher<D>>,
          .followers = {{"bvh", make_bvh_follower<D>, bvh_following<D>}},
          .find_costs = tree_finding<D>,
          .outline = core::outline_by(&BvhSearcher<D>::lay_out)};
}

}  // namespace

Algorithm bvh() {
  return {
      .name = "bvh",
      .summary = "a tree of bounds, sixteen to a node, packed by slabs and joined with itself",
      .source = "S. Leutenegger et al., STR: a simple and efficient algorithm for R-tree packing",
      .tunables = {core::threads_tunable(), core::update_tunable()},
      .in_2d = core::in_dimension<2, bvh_strategies<2>>(),
      .in_3d = core::in_dimension<3, bvh_strategies<3>>(),
      .tests_doubles = true,
      .gives_candidates = true,
  };
}

}  // namespace broadside::algorithm
