// Quadtree, in 3D an octree: nodes split until they hold few boxes, which are then swept.
//
// Section V of the paper, without its limits. A node is split at the median of a sample of its boxes' minima,
// not at the centre of a world, so no world is declared and clusters do not deepen the tree. An axis that
// would not separate the boxes is not split, and a node whose children would be nearly as large is a leaf, so
// the recursion ends at coincident boxes. A box that covers the middle of its node stays there and is swept
// against the node's other boxes; any other box goes into each child that it touches. Each pair is reported
// once: in the node that holds the greater of the two minima on every axis.
//
// The tree is never stored: a node is a range on a stack of references, in the order of the sweep. With
// several threads, one of them splits the uppermost nodes and copies the resulting ranges, in the order in
// which a single thread would search them.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/debug/outline.hpp"

#include "algorithms/follow_costs.hpp"
#include "algorithms/followers.hpp"
#include "algorithms/outline_text.hpp"
#include "algorithms/quadtree/quadtree_split.hpp"
#include "algorithms/registry.hpp"
#include "core/parallel.hpp"
#include "core/sample.hpp"
#include "core/sorted_boxes.hpp"
#include "core/tunables.hpp"
#include "kernels/sweep.hpp"

namespace broadside::algorithm {
namespace {

/// One thread splits nodes until there are about this many parts per worker.
constexpr std::size_t parts_per_worker = 3;

/// With a checkpoint, a part has at most this many boxes, enough that a single thread splits little.
constexpr std::size_t max_between_checkpoints = 16'384;

/// Boxes per leaf: up to about this many, a sweep costs no more than a further split.
template <int D>
constexpr std::size_t default_capacity = D == 2 ? 128 : 256;

template <int D>
class QuadtreeSearcher final : public Searcher<D> {
 public:
  explicit QuadtreeSearcher(const Settings& settings)
      : capacity_(
            static_cast<std::size_t>(settings.optional_number("capacity").value_or(default_capacity<D>))) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    const std::span<const Box<D>> boxes = input.boxes;
    doubles_ = input.doubles;
    parallel_.start(input.workers, boxes.size());
    workers_.resize(std::max(workers_.size(), parallel_.workers()));
    sample_.take(boxes);
    sorted_boxes_ = sorted_.sort(boxes, sample_.axes_by_overlap(), parallel_);
    for (std::size_t worker = 0; worker < parallel_.workers(); ++worker)
      workers_[worker].checkpoint = parallel_.checkpoint(worker);
    Worker& first = workers_[0];
    first.statistics = {};
    first.stack.references.clear();
    for (std::uint32_t i = 0; i < sorted_boxes_.size(); ++i)
      first.stack.references.push_back({i, kernels::side_bit(sorted_boxes_[i].id, input.left_count)});
    if (parallel_.workers() == 1 && !input.workers.checkpoint) {
      search_node(first, 0, first.stack.references.size(), pairs);
      return first.statistics;
    }
    parts_.clear();
    part_references_.clear();
    std::size_t max_in_part = boxes.size() / (parts_per_worker * parallel_.workers());
    if (input.workers.checkpoint) max_in_part = std::min(max_in_part, max_between_checkpoints);
    expand(first, 0, first.stack.references.size(), max_in_part);
    const auto search_parts = [&](core::Range parts, std::size_t worker, PairSink& sink) {
      workers_[worker].statistics = {};
      for (std::size_t part = parts.begin; part < parts.end; ++part)
        search_part(workers_[worker], part, sink);
      return workers_[worker].statistics;
    };
    return parallel_.search(parts_.size(), pairs, search_parts);
  }

  /// Splits the nodes as search_node() does, and keeps their regions.
  Outline<D> lay_out(std::span<const Box<D>> boxes, const Workers&) {
    sample_.take(boxes);
    const std::array<int, D> axes = sample_.axes_by_overlap();
    sorted_boxes_ = sorted_.sort(boxes, axes);
    workers_.resize(std::max<std::size_t>(workers_.size(), 1));
    Worker& worker = workers_[0];
    worker.stack.references.clear();
    for (std::uint32_t i = 0; i < sorted_boxes_.size(); ++i) worker.stack.references.push_back({i, 0});
    Outline<D> outline;
    outline.kind = "nodes";
    Box<D> region;
    region.min.fill(-std::numeric_limits<float>::infinity());
    region.max.fill(std::numeric_limits<float>::infinity());
    const std::size_t leaves =
        lay_out(worker, 0, worker.stack.references.size(), {axes, region}, 0, outline.levels);
    std::size_t nodes = 0;
    for (const auto& level : outline.levels) nodes += level.size();
    outline.caption = counted(nodes, "node") + " on " + counted(outline.levels.size(), "level") + ", " +
                      (leaves == 1 ? "1 of them a leaf" : std::to_string(leaves) + " of them leaves");
    return outline;
  }

 private:
  using Split = QuadtreeSplit<D>;

  /// The memory of one worker.
  struct Worker {
    QuadtreeStack<D> stack;
    kernels::RunBuffer<D> run;
    kernels::RunBuffer<D> kept_run;
    Statistics statistics;
    Checkpoint* checkpoint;
  };

  /// A unit of work. If `kept_count` is 0, a node and everything below it. Otherwise the boxes kept at a
  /// node, which come first, against each other and against the node's other boxes.
  struct QuadtreeTask {
    std::size_t end;  // in part_references_
    std::size_t kept_count;
  };

  /// A node's region in the caller's axes. Axis a of the sorted boxes is the caller's axis axes[a].
  struct NodeRegion {
    std::array<int, D> axes;
    Box<D> box;
  };

  /// Appends the regions of the node and its descendants to the levels. Returns how many of them are leaves.
  std::size_t lay_out(Worker& worker, std::size_t begin, std::size_t end, const NodeRegion& region,
                      std::size_t depth, decltype(Outline<D>::levels)& levels) const {
    if (levels.size() == depth) levels.emplace_back();
    levels[depth].push_back(region.box);
    Split split;
    if (end - begin < 2 || end - begin <= capacity_ || !worker.stack.split(sorted_boxes_, begin, end, split))
      return 1;
    const std::size_t top = worker.stack.references.size();
    worker.stack.push_children(sorted_boxes_, begin, end, split);
    std::size_t leaves = 0;
    std::size_t first = top;
    for (std::uint32_t child = 0; child < 1U << split.axis_count; ++child) {
      NodeRegion part = region;
      for (int at = 0; at < split.axis_count; ++at) {
        const int axis = region.axes[split.axes[at]];
        ((child >> at & 1U) != 0 ? part.box.min : part.box.max)[axis] = split.at[split.axes[at]];
      }
      leaves += lay_out(worker, first, first + split.sizes[child], part, depth + 1, levels);
      first += split.sizes[child];
    }
    worker.stack.references.resize(top);
    return leaves;
  }

  /// Makes parts of the node and its descendants, in the order in which search_node() would visit them.
  void expand(Worker& worker, std::size_t begin, std::size_t end, std::size_t largest) {
    const std::size_t count = end - begin;
    if (count < 2) return;
    Split split;
    if (count <= std::max(capacity_, largest) || !worker.stack.split(sorted_boxes_, begin, end, split)) {
      copy(worker, begin, end, [](std::size_t) { return true; });
      parts_.push_back({part_references_.size(), 0});
      return;
    }
    if (worker.stack.kept_count > 0) {
      copy(worker, begin, end, [&](std::size_t i) { return worker.stack.children[i] == 0; });
      copy(worker, begin, end, [&](std::size_t i) { return worker.stack.children[i] != 0; });
      parts_.push_back({part_references_.size(), worker.stack.kept_count});
    }
    const std::size_t top = worker.stack.references.size();
    worker.stack.push_children(sorted_boxes_, begin, end, split);
    std::size_t child = top;
    for (const std::size_t size : split.sizes) {
      expand(worker, child, child + size, largest);
      child += size;
    }
    worker.stack.references.resize(top);
  }

  /// Appends the node's references whose places in the node are `wanted` to part_references_.
  template <typename Wanted>
  void copy(const Worker& worker, std::size_t begin, std::size_t end, Wanted wanted) {
    for (std::size_t i = begin; i < end; ++i) {
      if (wanted(i - begin)) part_references_.push_back(worker.stack.references[i]);
    }
  }

  void search_part(Worker& worker, std::size_t number, PairSink& pairs) const {
    const std::size_t begin = number == 0 ? 0 : parts_[number - 1].end;
    const std::span<const core::SortedReference> references =
        std::span(part_references_).subspan(begin, parts_[number].end - begin);
    worker.stack.references.assign(references.begin(), references.end());
    if (parts_[number].kept_count == 0) {
      search_node(worker, 0, references.size(), pairs);
      return;
    }
    worker.stack.children.assign(references.size(), 1);
    std::fill_n(worker.stack.children.begin(), parts_[number].kept_count, std::uint8_t{0});
    sweep_kept(worker, 0, references.size(), pairs);
  }

  /// Reports the pairs of the node whose references are [begin, end) on the stack. Leaves the stack as it
  /// was. The depth is at most logarithmic in the number of boxes, since a child has at most 7/8 as many as
  /// its parent.
  void search_node(Worker& worker, std::size_t begin, std::size_t end, PairSink& pairs) const {
    const std::size_t count = end - begin;
    if (count < 2) return;
    Split split;
    if (count <= capacity_ || !worker.stack.split(sorted_boxes_, begin, end, split)) {
      worker.statistics.references += count;
      gather(worker, begin, end, worker.run, [](std::size_t) { return true; });
      worker.statistics.tests += kernels::sweep(worker.run.view(doubles_, worker.checkpoint), pairs);
      return;
    }
    if (worker.stack.kept_count > 0) sweep_kept(worker, begin, end, pairs);
    const std::size_t top = worker.stack.references.size();
    worker.stack.push_children(sorted_boxes_, begin, end, split);
    std::size_t child = top;
    for (const std::size_t size : split.sizes) {
      search_node(worker, child, child + size, pairs);
      child += size;
    }
    worker.stack.references.resize(top);
  }

  /// Sweeps the boxes kept at a node against each other and against the node's other boxes.
  void sweep_kept(Worker& worker, std::size_t begin, std::size_t end, PairSink& pairs) const {
    gather(worker, begin, end, worker.kept_run,
           [&worker](std::size_t i) { return worker.stack.children[i] == 0; });
    gather(worker, begin, end, worker.run,
           [&worker](std::size_t i) { return worker.stack.children[i] != 0; });
    worker.statistics.references += worker.kept_run.size();
    const kernels::Run<D> kept = worker.kept_run.view(doubles_, worker.checkpoint);
    worker.statistics.tests += kernels::sweep(kept, pairs);
    worker.statistics.tests += kernels::sweep(kept, worker.run.view(doubles_, worker.checkpoint), pairs);
  }

  /// Fills `run` with the node's boxes whose places in the node are `wanted`.
  template <typename Wanted>
  void gather(const Worker& worker, std::size_t begin, std::size_t end, kernels::RunBuffer<D>& run,
              Wanted wanted) const {
    run.clear();
    run.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      if (!wanted(i - begin)) continue;
      const core::SortedBox<D>& sorted = sorted_boxes_[worker.stack.references[i].place];
      run.append(sorted.box, sorted.id, worker.stack.references[i].dedup_mask);
    }
  }

  std::size_t capacity_;

  core::Sample<D> sample_;
  core::SortedBoxes<D> sorted_;
  std::span<const core::SortedBox<D>> sorted_boxes_;
  core::Parallel parallel_;
  std::vector<Worker> workers_;
  std::vector<QuadtreeTask> parts_;
  std::vector<core::SortedReference> part_references_;
  const Box<D, double>* doubles_ = nullptr;  // of the current search
};

template <int D>
Strategies<D> quadtree_strategies() {
  return {.searcher = make_strategy<QuadtreeSearcher<D>>,
          .followers = {{"quadtree", make_quadtree_follower<D>, quadtree_following<D>}},
          .find_costs = tree_finding<D>,
          .outline = core::outline_by(&QuadtreeSearcher<D>::lay_out)};
}

}  // namespace

Algorithm quadtree() {
  return {
      .name = "quadtree",
      .summary = "nodes split at medians until they hold few boxes, which are swept; an octree in 3D",
      .source = "paper.md, section V",
      .tunables = {{.name = "capacity",
                    .summary = "maximum number of boxes in a leaf that could be split",
                    .default_value = "auto",
                    .type = Tunable::Type::integer,
                    .min = 1,
                    .max = 1 << 30},
                   core::update_tunable(),
                   core::threads_tunable()},
      .in_2d = core::in_dimension<2, quadtree_strategies<2>>(),
      .in_3d = core::in_dimension<3, quadtree_strategies<3>>(),
      .tests_doubles = true,
      .gives_candidates = true,
  };
}

}  // namespace broadside::algorithm
