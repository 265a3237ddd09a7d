// A join with a bound for the worst case: the streamed segment tree of A. Zomorodian and H. Edelsbrunner,
// "Fast software for box intersections" (2002), with the axis chosen at each node and a sweep at the leaves.
//
// auto hands a search over to it when another algorithm makes far too many tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"
#include "broadside/searcher.hpp"

#include "core/large_array.hpp"
#include "core/parallel.hpp"
#include "core/radix_sort.hpp"
#include "core/sorted_boxes.hpp"
#include "kernels/run.hpp"

namespace broadside::algorithm {

/// Cost for n boxes and k pairs: O((n + k) log^D n), as long as sample medians halve the boxes. Memory, kept
/// from one search to the next: O(n log n).
template <int D>
class SegmentJoin {
 public:
  /// Reports each overlapping pair once; if `left_count` > 0, only pairs of one of the first `left_count`
  /// boxes and one of the others. All boxes are present; `doubles` and `checkpoint` are as in a Run.
  Statistics join(std::span<const Box<D>> boxes, std::size_t left_count, const Box<D, double>* doubles,
                  Checkpoint& checkpoint, PairSink& pairs);

 private:
  using Reference = core::SortedReference;

  /// Consecutive references on the stack, in the order of the sorted boxes.
  using List = core::Range;

  /// A node's lists. Its pairs are between `a` and `b` or, if `is_self`, within `a`.
  struct SegmentNode {
    List a;
    List b;
    bool is_self;
    std::uint32_t open;  // bit a: boxes of the node may be disjoint on axis a
    int depth;

    std::size_t size() const { return is_self ? a.size() : a.size() + b.size(); }
  };

  /// Where a node is cut, and the least and the greatest minimum in its region.
  struct SegmentCut {
    int axis;
    float at;
    float low;
    float high;
  };

  /// The parts into which a cut divides a list.
  struct SegmentParts {
    List covering;
    List below;
    List above;
  };

  void search(const SegmentNode& node);
  void decide(const SegmentNode& node, const SegmentCut& cut);
  void cut_in_two(const SegmentNode& node, const SegmentCut& cut);
  void sweep(const SegmentNode& node);
  SegmentCut choose(const SegmentNode& node);
  bool set_range(const SegmentNode& node, SegmentCut& cut) const;
  void set_exact_median(const SegmentNode& node, SegmentCut& cut);
  SegmentParts part(const List& list, const SegmentCut& cut);

  /// Calls `visit(min)` for each of the node's boxes that begins in its region on that axis.
  template <typename Visit>
  void for_minima(const SegmentNode& node, int axis, Visit visit) const {
    const auto visit_all = [&](const List& list) {
      for (std::size_t i = list.begin; i < list.end; ++i) {
        if ((stack_[i].dedup_mask >> axis & 1U) == 0) visit(box(stack_[i]).min[axis]);
      }
    };
    visit_all(node.a);
    if (!node.is_self) visit_all(node.b);
  }

  /// Pushes the wanted references of a list.
  template <typename Wanted>
  List push(const List& list, Wanted wanted);

  kernels::Run<D> run_of(const List& list, int axis, kernels::RunBuffer<D>& run);
  const Box<D>& box(const Reference& reference) const { return sorted_boxes_[reference.place].box; }

  core::SortedBoxes<D> sorted_;
  std::span<const core::SortedBox<D>> sorted_boxes_;
  core::LargeArray<Reference> stack_;
  std::vector<float> minima_;
  core::RadixSort radix_;
  kernels::RunBuffer<D> run_a_;
  kernels::RunBuffer<D> run_b_;
  const Box<D, double>* doubles_ = nullptr;
  Checkpoint* checkpoint_ = nullptr;
  PairSink* pairs_ = nullptr;
  Statistics statistics_;
};

}  // namespace broadside::algorithm
