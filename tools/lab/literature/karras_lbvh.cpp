// Karras 2012, "Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d Trees" (High Performance
// Graphics): a binary radix tree over the Morton codes of the boxes' centres. Each internal node's range of
// leaves is found from common prefixes alone; bounds are computed bottom up. The traversal is that of the
// same author's "Thinking Parallel, Part II: Tree Traversal on the GPU" (2012): each leaf searches for the
// leaves to its right.
//
// Differences: one thread loops over the nodes, where the paper has one GPU thread for each. So the counters
// with which the second child to arrive continues to the parent are plain integers. Codes are computed from
// coordinates in double, relative to the centres' bounds; infinite centres are clamped to these bounds. With
// two sets, the tree holds the right one, and the boxes of the left one search it in the order of their
// codes.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lab/literature/literature.hpp"
#include "lab/literature/radix_sort.hpp"

namespace broadside::lab::literature {
namespace {

/// Inserts D - 1 zeros between the bits of `value`; uses its lowest 64 / D bits.
template <int D>
std::uint64_t spread(std::uint64_t value) noexcept {
  if constexpr (D == 2) {
    value &= 0xffffffffU;
    value = (value | value << 16) & 0x0000ffff0000ffffU;
    value = (value | value << 8) & 0x00ff00ff00ff00ffU;
    value = (value | value << 4) & 0x0f0f0f0f0f0f0f0fU;
    value = (value | value << 2) & 0x3333333333333333U;
    return (value | value << 1) & 0x5555555555555555U;
  } else {
    value &= 0x1fffffU;
    value = (value | value << 32) & 0x001f00000000ffffU;
    value = (value | value << 16) & 0x001f0000ff0000ffU;
    value = (value | value << 8) & 0x100f00f00f00f00fU;
    value = (value | value << 4) & 0x10c30c30c30c30c3U;
    return (value | value << 2) & 0x1249249249249249U;
  }
}

/// Morton codes of boxes' centres, with `axis_bits` bits for each coordinate.
template <int D>
class MortonCurve {
 public:
  MortonCurve(std::span<const Box<D>> boxes, int axis_bits) : max_cell_(std::ldexp(1.0, axis_bits) - 1) {
    low_.fill(std::numeric_limits<double>::infinity());
    std::array<double, D> high;
    high.fill(-std::numeric_limits<double>::infinity());
    for (const Box<D>& box : boxes) {
      for (int axis = 0; axis < D; ++axis) {
        const double centre = centre_of(box, axis);
        if (!std::isfinite(centre)) continue;
        low_[axis] = std::min(low_[axis], centre);
        high[axis] = std::max(high[axis], centre);
      }
    }
    for (int axis = 0; axis < D; ++axis) {
      if (low_[axis] > high[axis]) low_[axis] = 0;  // no centre is finite
      scale_[axis] = high[axis] > low_[axis] ? max_cell_ / (high[axis] - low_[axis]) : 0;
    }
  }

  std::uint64_t code(const Box<D>& box) const noexcept {
    std::uint64_t code = 0;
    for (int axis = 0; axis < D; ++axis) {
      const double place = (centre_of(box, axis) - low_[axis]) * scale_[axis];
      // NaN, for a box that is infinite both ways, compares as not above 0.
      const double inside = place > 0 ? std::min(place, max_cell_) : 0;
      code |= spread<D>(static_cast<std::uint64_t>(inside)) << axis;
    }
    return code;
  }

 private:
  static double centre_of(const Box<D>& box, int axis) noexcept {
    return (double{box.min[axis]} + double{box.max[axis]}) / 2;
  }

  double max_cell_;
  std::array<double, D> low_;
  std::array<double, D> scale_;
};

/// Codes of up to 32 bits are sorted as 32-bit keys, longer ones as 64-bit keys.
template <int D, typename Key>
class KarrasLbvh final : public Searcher<D> {
 public:
  explicit KarrasLbvh(int axis_bits) : axis_bits_(axis_bits) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    const std::span<const Box<D>> boxes = input.boxes;
    const MortonCurve<D> curve(boxes, axis_bits_);
    const std::size_t left = input.left_count;
    sort(curve, boxes, left, boxes.size());
    const std::size_t leaves = codes_.size();
    if (leaves > 1) build();
    Checkpoint checkpoint(input.workers.checkpoint);
    if (left > 0) {
      if (leaves > 0) search_from_left(curve, boxes.first(left), checkpoint, pairs);
    } else {
      for (std::size_t i = 0; i + 1 < leaves; ++i)
        checkpoint.count(search(leaf_boxes_[i], ids_[i], i + 1, pairs));
    }
    return std::nullopt;
  }

 private:
  /// An internal node. A child is the index of an internal node or, with `leaf_bit`, of a leaf.
  struct Node {
    std::array<Box<D>, 2> bounds;  // of the children: one visit tests both
    std::array<std::uint32_t, 2> children;
    std::array<std::uint32_t, 2> last;  // the last leaf below each child
    std::uint32_t parent;
    std::uint32_t arrived;
  };

  static constexpr std::uint32_t leaf_bit = 0x80000000U;
  // Codes have up to 64 bits and indices 32; each level of the tree shares at least one bit more.
  static constexpr std::size_t max_levels = 96;

  /// Sorts the leaves: the boxes from `begin` to `end`, by their codes.
  void sort(const MortonCurve<D>& curve, std::span<const Box<D>> boxes, std::size_t begin, std::size_t end) {
    const auto entries = sorter_.entries(end - begin);
    for (std::size_t i = begin; i < end; ++i)
      entries[i - begin] = {static_cast<Key>(curve.code(boxes[i])), static_cast<std::uint32_t>(i)};
    const auto sorted = sorter_.sort();
    codes_.resize(sorted.size());
    ids_.resize(sorted.size());
    leaf_boxes_.resize(sorted.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      codes_[i] = sorted[i].key;
      ids_[i] = BoxId{sorted[i].place};
      leaf_boxes_[i] = boxes[sorted[i].place];
    }
  }

  /// The length of the common prefix of two leaves' codes, each followed by the leaf's index so that no two
  /// are equal; -1 if there is no leaf j.
  int prefix(std::int64_t i, std::int64_t j) const noexcept {
    if (j < 0 || j >= static_cast<std::int64_t>(codes_.size())) return -1;
    const Key differing = codes_[static_cast<std::size_t>(i)] ^ codes_[static_cast<std::size_t>(j)];
    if (differing != 0) return std::countl_zero(differing);
    return static_cast<int>(sizeof(Key)) * 8 + std::countl_zero(static_cast<std::uint32_t>(i ^ j));
  }

  /// Karras' algorithm for internal node i: the direction and length of its range, and its split.
  void make_node(std::int64_t i) {
    const int direction = prefix(i, i + 1) > prefix(i, i - 1) ? 1 : -1;
    const int min_prefix = prefix(i, i - direction);
    std::int64_t max_length = 2;
    while (prefix(i, i + max_length * direction) > min_prefix) max_length *= 2;
    std::int64_t length = 0;
    for (std::int64_t step = max_length / 2; step > 0; step /= 2) {
      if (prefix(i, i + (length + step) * direction) > min_prefix) length += step;
    }
    const std::int64_t other_end = i + length * direction;

    const int shared = prefix(i, other_end);
    std::int64_t split = 0;
    for (std::int64_t step = length; step > 1;) {
      step = (step + 1) / 2;
      if (prefix(i, i + (split + step) * direction) > shared) split += step;
    }
    const std::int64_t first = std::min(i, other_end);
    const std::int64_t last = std::max(i, other_end);
    const std::int64_t middle = i + split * direction + std::min(direction, 0);

    Node& node = nodes_[static_cast<std::size_t>(i)];
    node.arrived = 0;
    node.last = {static_cast<std::uint32_t>(middle), static_cast<std::uint32_t>(last)};
    link(node, 0, i, middle, first == middle);
    link(node, 1, i, middle + 1, middle + 1 == last);
  }

  void link(Node& node, std::size_t side, std::int64_t parent, std::int64_t child, bool is_leaf) {
    const auto place = static_cast<std::uint32_t>(child);
    node.children[side] = is_leaf ? place | leaf_bit : place;
    if (is_leaf)
      leaf_parents_[place] = static_cast<std::uint32_t>(parent);
    else
      nodes_[place].parent = static_cast<std::uint32_t>(parent);
  }

  void build() {
    const std::size_t leaves = codes_.size();
    nodes_.resize(leaves - 1);
    leaf_parents_.resize(leaves);
    for (std::size_t i = 0; i + 1 < leaves; ++i) make_node(static_cast<std::int64_t>(i));
    // Bottom up: the second of two children to arrive continues to the parent.
    for (std::size_t leaf = 0; leaf < leaves; ++leaf) {
      Box<D> bounds = leaf_boxes_[leaf];
      std::uint32_t child = static_cast<std::uint32_t>(leaf) | leaf_bit;
      std::uint32_t parent = leaf_parents_[leaf];
      for (;;) {
        Node& node = nodes_[parent];
        node.bounds[node.children[1] == child ? 1 : 0] = bounds;
        if (++node.arrived < 2 || parent == 0) break;
        for (int axis = 0; axis < D; ++axis) {
          bounds.min[axis] = std::min(node.bounds[0].min[axis], node.bounds[1].min[axis]);
          bounds.max[axis] = std::max(node.bounds[0].max[axis], node.bounds[1].max[axis]);
        }
        child = parent;
        parent = node.parent;
      }
    }
  }

  /// Writes the pairs of `box` with the leaves from index `first` on. Returns the number of bounds compared.
  std::uint64_t search(const Box<D>& box, BoxId id, std::size_t first, PairSink& pairs) const {
    std::array<std::uint32_t, max_levels + 1> stack;
    std::uint64_t compared = 0;
    std::size_t depth = 0;
    std::uint32_t place = 0;
    for (;;) {
      const Node& node = nodes_[place];
      std::uint32_t next = leaf_bit;
      compared += 2;
      for (std::size_t side = 0; side < 2; ++side) {
        if (node.last[side] < first || !overlap(box, node.bounds[side])) continue;
        const std::uint32_t child = node.children[side];
        if ((child & leaf_bit) != 0) {
          pairs.add(id, ids_[child & ~leaf_bit]);
        } else if (next == leaf_bit) {
          next = child;
        } else {
          stack[depth++] = child;
        }
      }
      if (next != leaf_bit)
        place = next;
      else if (depth > 0)
        place = stack[--depth];
      else
        return compared;
    }
  }

  void search_from_left(const MortonCurve<D>& curve, std::span<const Box<D>> boxes, Checkpoint& checkpoint,
                        PairSink& pairs) {
    const auto entries = left_sorter_.entries(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
      entries[i] = {static_cast<Key>(curve.code(boxes[i])), static_cast<std::uint32_t>(i)};
    for (const auto& entry : left_sorter_.sort()) {
      const Box<D>& box = boxes[entry.place];
      if (codes_.size() > 1)
        checkpoint.count(search(box, BoxId{entry.place}, 0, pairs));
      else if (overlap(box, leaf_boxes_[0]))
        pairs.add(BoxId{entry.place}, ids_[0]);
    }
  }

  int axis_bits_;
  RadixSort<Key> sorter_;
  RadixSort<Key> left_sorter_;
  std::vector<Key> codes_;  // of the leaves, ascending
  std::vector<BoxId> ids_;
  std::vector<Box<D>> leaf_boxes_;
  std::vector<std::uint32_t> leaf_parents_;
  std::vector<Node> nodes_;  // one fewer than leaves; the first is the root
};

template <int D>
std::unique_ptr<Searcher<D>> make(const Settings& settings) {
  if (settings.text("code") == "64") return std::make_unique<KarrasLbvh<D, std::uint64_t>>(64 / D);
  return std::make_unique<KarrasLbvh<D, std::uint32_t>>(32 / D);
}

}  // namespace

Algorithm karras_lbvh() {
  return {
      .name = "karras_lbvh",
      .summary = "a binary radix tree over Morton codes; each leaf looks for the leaves to its right",
      .source = "Karras 2012, Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d Trees",
      .kind = AlgorithmKind::literature,
      .tunables = {{.name = "code",
                    .summary = "bits of a Morton code: 16 or 32 an axis in 2D, 10 or 21 in 3D",
                    .default_value = "32",
                    .type = Tunable::Type::choice,
                    .choices = {"32", "64"}}},
      .in_2d = {.searcher = make<2>},
      .in_3d = {.searcher = make<3>},
      .limits = {.max_boxes = (std::size_t{1} << 31) - 1},
  };
}

}  // namespace broadside::lab::literature
