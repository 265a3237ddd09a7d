// QuadtreeStack: the nodes of the quadtree that is never stored, as ranges of references on a stack, and how
// they are split.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"

#include "core/large_array.hpp"
#include "core/sample.hpp"
#include "core/sorted_boxes.hpp"

namespace broadside::algorithm {

/// Where a node is split, on the first `axis_count` of `axes`.
template <int D>
struct QuadtreeSplit {
  static constexpr std::uint32_t max_children = 1U << D;

  std::array<float, D> at;
  std::array<float, D> low;   ///< a box that spans from low to high
  std::array<float, D> high;  ///< covers the middle half of the node
  std::array<int, D> axes;
  int axis_count;
  std::array<std::size_t, max_children> sizes;  ///< how many boxes each child gets

  bool covers_middle(const Box<D>& b) const {
    bool covers = true;
    for (int i = 0; i < axis_count; ++i) {
      const int axis = axes[i];
      covers &= b.min[axis] <= low[axis] && b.max[axis] >= high[axis];
    }
    return covers;
  }
};

/// A stack of references, a range for each node, and the children of each reference of the node split last.
template <int D>
class QuadtreeStack {
 public:
  using Split = QuadtreeSplit<D>;
  using Boxes = std::span<const core::SortedBox<D>>;

  // always_inline here and below: g++ 12 would not inline these by itself, since several functions call them.

  /// Splits the node whose references are [begin, end), at least one: chooses the axes and where to cut them,
  /// and sets `children`. False if no axis would separate the boxes, or if a child would be nearly as large
  /// as the node.
  [[gnu::always_inline]] bool split(const Boxes& boxes, std::size_t begin, std::size_t end, Split& split) {
    return choose(boxes, begin, end, split) && partition(boxes, begin, end, split);
  }

  /// Pushes the references of all children, one child after the other.
  [[gnu::always_inline]] void push_children(const Boxes& boxes, std::size_t begin, std::size_t end,
                                            const Split& split) {
    std::array<std::size_t, Split::max_children> next;
    std::size_t top = references.size();
    for (std::uint32_t child = 0; child < Split::max_children; ++child) {
      next[child] = top;
      top += split.sizes[child];
    }
    references.resize(top);
    for (std::size_t i = begin; i < end; ++i) {
      const core::SortedReference reference = references[i];
      for (std::uint32_t mask = children[i - begin], child = 0; mask != 0; mask >>= 1, ++child) {
        if ((mask & 1U) == 0) continue;
        std::uint32_t dedup_mask = reference.dedup_mask;
        for (int at = 0; at < split.axis_count; ++at) {
          const int axis = split.axes[at];
          const bool is_before = boxes[reference.place].box.min[axis] < split.at[axis];
          if ((child >> at & 1U) != 0 && is_before) dedup_mask |= 1U << axis;
        }
        references[next[child]++] = {reference.place, dedup_mask};
      }
    }
  }

  core::LargeArray<core::SortedReference> references;
  std::vector<std::uint8_t> children;  ///< by reference of the node split last: bit c if it goes to child c
  std::size_t kept_count = 0;          ///< how many of them go to no child and stay at the node

 private:
  static constexpr std::size_t samples = 31;

  /// False if no axis would separate the boxes.
  [[gnu::always_inline]] bool choose(const Boxes& boxes, std::size_t begin, std::size_t end,
                                     Split& split) const {
    split.axis_count = 0;
    const std::size_t count = end - begin;
    std::array<float, samples> minima;
    for (int axis = 0; axis < D; ++axis) {
      const auto sample = [&](std::size_t i) -> const Box<D>& {
        return boxes[references[begin + (2 * i + 1) * count / (2 * samples)].place].box;
      };
      for (std::size_t i = 0; i < samples; ++i) minima[i] = core::without_nan(sample(i).min[axis]);
      std::sort(minima.begin(), minima.end());
      const float at = minima[samples / 2];
      std::size_t crossing = 0;
      for (std::size_t i = 0; i < samples; ++i)
        crossing += static_cast<std::size_t>(sample(i).min[axis] < at && sample(i).max[axis] >= at);
      if (minima.front() == at || crossing > samples / 4) continue;
      split.at[axis] = at;
      split.low[axis] = minima[samples / 4];
      split.high[axis] = minima[samples - 1 - samples / 4];
      split.axes[split.axis_count++] = axis;
    }
    return split.axis_count > 0;
  }

  /// Sets the children of each reference, none for a box kept at the node, and the sizes. A box goes to each
  /// child whose region it touches: to lower ones if it begins before the split, to upper ones unless it ends
  /// before the split. False if a child would be nearly as large as the node.
  bool partition(const Boxes& boxes, std::size_t begin, std::size_t end, Split& split) {
    // For each axis, the children on its lower and on its upper side.
    constexpr std::array<std::uint32_t, 3> lower = {0x55, 0x33, 0x0f};
    constexpr std::array<std::uint32_t, 3> upper = {0xaa, 0xcc, 0xf0};
    const std::uint32_t all = (1U << (1U << split.axis_count)) - 1;
    children.resize(std::max(children.size(), end - begin));
    split.sizes.fill(0);
    std::array<std::size_t, 256> masks{};
    for (std::size_t i = begin; i < end; ++i) {
      const Box<D>& b = boxes[references[i].place].box;
      std::uint32_t mask = all;
      for (int at = 0; at < split.axis_count; ++at) {
        const int axis = split.axes[at];
        const float border = split.at[axis];
        mask &= (b.min[axis] < border ? lower[at] : 0U) | (b.max[axis] >= border ? upper[at] : 0U);
      }
      if (mask == all && split.covers_middle(b)) mask = 0;
      children[i - begin] = static_cast<std::uint8_t>(mask);
      ++masks[mask];
    }
    kept_count = masks[0];
    std::size_t largest = 0;
    for (std::uint32_t child = 0; child < 1U << split.axis_count; ++child) {
      for (std::uint32_t mask = 1; mask <= all; ++mask)
        split.sizes[child] += (mask >> child & 1U) * masks[mask];
      largest = std::max(largest, split.sizes[child]);
    }
    return largest <= (end - begin) / 8 * 7;
  }
};

}  // namespace broadside::algorithm
