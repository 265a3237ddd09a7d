// The KD-tree of Serpa and Rodrigues: each box is in the lowest node whose planes it does not touch.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "lab/literature/centres.hpp"
#include "lab/literature/sorted_boxes.hpp"

namespace broadside::lab::literature {

/// A box that touches a node's plane is stored in that node, any other box below it. So each box is in one
/// node, and the boxes of a pair are in the same node, or in two nodes with one above the other.
template <int D>
class KdTree {
 public:
  explicit KdTree(std::size_t leaf_boxes) : leaf_boxes_(leaf_boxes) {}

  /// Removes all boxes.
  void clear(std::size_t places) {
    nodes_.assign(1, Node());
    nodes_[0].region.min.fill(-infinity);
    nodes_[0].region.max.fill(infinity);
    free_.clear();
    homes_.assign(places, {});
  }

  void resize(std::size_t places) { homes_.resize(places); }

  /// Inserts a box at the root, moves it to the node where it now belongs, or removes it.
  void add(std::uint32_t id) { put(root, id); }
  void move(std::uint32_t id, const Box<D>& box) {
    const std::uint32_t from = homes_[id].node;
    std::uint32_t node = from;
    while (node != root && !is_inside(box, nodes_[node].region)) node = nodes_[node].parent;
    node = descend(node, box);
    if (node == from) return;
    take(id);
    put(node, id);
  }
  void remove(std::uint32_t id) { take(id); }

  /// Rebalances the tree for `boxes`: splits leaves with too many boxes, turns nodes with too few into
  /// leaves, and moves a plane that divides badly to the mean, or gives it up.
  void refine(std::span<const Box<D>> boxes) {
    stack_.assign(1, root);
    while (!stack_.empty()) {
      const std::uint32_t at = stack_.back();
      stack_.pop_back();
      if (!nodes_[at].is_leaf()) {
        sift(at, boxes);  // boxes released by a moved plane, or passed down from above
        if (has_too_few(nodes_[at])) {
          collapse(at);
        } else if (divides_badly(nodes_[at])) {
          const bool was_translated = nodes_[at].translated;
          collapse(at);
          if (!was_translated) {
            split(at, boxes, nodes_[at].axis);
            nodes_[at].translated = true;
            stack_.push_back(at);
            continue;
          }
        }
        nodes_[at].translated = false;
      }
      if (nodes_[at].is_leaf() && nodes_[at].boxes.size() > leaf_boxes_) split(at, boxes, any_axis);
      if (nodes_[at].is_leaf()) continue;
      stack_.push_back(nodes_[at].children[1]);
      stack_.push_back(nodes_[at].children[0]);
    }
  }

  /// Writes the pairs with at least one flagged box; with `across`, the pairs with exactly one.
  void search(std::span<const Box<D>> boxes, std::span<const std::uint8_t> flags, bool across,
              Checkpoint& checkpoint, PairSink& pairs) {
    search_ = {boxes, flags, across, &checkpoint, &pairs};
    count_flagged(root);
    for (std::vector<std::uint32_t>& list : above_) list.clear();
    search_below(root);
  }

 private:
  static constexpr float infinity = std::numeric_limits<float>::infinity();
  static constexpr std::uint32_t root = 0;
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  static constexpr int any_axis = -1;

  struct Node {
    bool is_leaf() const noexcept { return children[0] == none; }

    std::array<std::uint32_t, 2> children = {none, none};
    std::uint32_t parent = none;
    int axis = 0;
    float position = 0;  // of the plane
    bool translated = false;
    Box<D> region{};  // open, except at infinity
    std::size_t population = 0;
    std::size_t flagged = 0;  // number of flagged boxes in the population, during a search
    std::vector<std::uint32_t> boxes;
  };

  /// The position of a box in the tree.
  struct Home {
    std::uint32_t node = none;
    std::uint32_t slot = 0;
  };

  /// The state of one search.
  struct JoinContext {
    std::span<const Box<D>> boxes;
    std::span<const std::uint8_t> flags;
    bool across = false;
    Checkpoint* checkpoint = nullptr;
    PairSink* pairs = nullptr;
  };

  static bool is_inside(const Box<D>& box, const Box<D>& region) noexcept {
    bool inside = true;
    for (int axis = 0; axis < D; ++axis) {
      inside &= box.min[axis] > region.min[axis] || region.min[axis] == -infinity;
      inside &= box.max[axis] < region.max[axis] || region.max[axis] == infinity;
    }
    return inside;
  }

  /// The child in which a box belongs, or no child.
  static std::uint32_t child_for(const Node& node, const Box<D>& box) noexcept {
    if (box.max[node.axis] < node.position) return node.children[0];
    return box.min[node.axis] > node.position ? node.children[1] : none;
  }

  std::uint32_t descend(std::uint32_t node, const Box<D>& box) const noexcept {
    while (!nodes_[node].is_leaf()) {
      const std::uint32_t child = child_for(nodes_[node], box);
      if (child == none) break;
      node = child;
    }
    return node;
  }

  void put(std::uint32_t node, std::uint32_t id) {
    homes_[id] = {node, static_cast<std::uint32_t>(nodes_[node].boxes.size())};
    nodes_[node].boxes.push_back(id);
    for (std::uint32_t above = node; above != none; above = nodes_[above].parent) ++nodes_[above].population;
  }

  void take(std::uint32_t id) {
    const Home home = homes_[id];
    std::vector<std::uint32_t>& from = nodes_[home.node].boxes;
    homes_[from.back()].slot = home.slot;
    from[home.slot] = from.back();
    from.pop_back();
    homes_[id].node = none;
    for (std::uint32_t above = home.node; above != none; above = nodes_[above].parent)
      --nodes_[above].population;
  }

  /// Passes an inner node's boxes that do not touch its plane down to its children.
  void sift(std::uint32_t at, std::span<const Box<D>> boxes) {
    Node& node = nodes_[at];
    std::size_t kept = 0;
    for (const std::uint32_t id : node.boxes) {
      const std::uint32_t child = child_for(node, boxes[id]);
      const std::uint32_t home = child == none ? at : child;
      if (child == none) {
        homes_[id] = {at, static_cast<std::uint32_t>(kept)};
        node.boxes[kept++] = id;
      } else {
        homes_[id] = {home, static_cast<std::uint32_t>(nodes_[home].boxes.size())};
        nodes_[home].boxes.push_back(id);
        ++nodes_[home].population;
      }
    }
    node.boxes.resize(kept);
  }

  std::uint32_t make_child(std::uint32_t parent, std::size_t side) {
    std::uint32_t child = static_cast<std::uint32_t>(nodes_.size());
    if (free_.empty()) {
      nodes_.emplace_back();
    } else {
      child = free_.back();
      free_.pop_back();
    }
    const Node& above = nodes_[parent];
    Node& node = nodes_[child];
    node.parent = parent;
    node.region = above.region;
    node.translated = false;
    (side == 0 ? node.region.max : node.region.min)[above.axis] = above.position;
    return child;
  }

  /// Gives a leaf a plane at the mean of its boxes' centres, on the axis of maximum variance or on `axis`. No
  /// plane if all boxes touch it, or are on one side.
  void split(std::uint32_t at, std::span<const Box<D>> boxes, int axis) {
    Centres<D> centres;
    for (const std::uint32_t id : nodes_[at].boxes) centres.add(boxes[id]);
    nodes_[at].axis = axis == any_axis ? centres.widest_axis() : axis;
    nodes_[at].position = static_cast<float>(centres.mean(nodes_[at].axis));
    std::array<bool, 2> any{};
    for (const std::uint32_t id : nodes_[at].boxes) {
      any[0] |= boxes[id].max[nodes_[at].axis] < nodes_[at].position;
      any[1] |= boxes[id].min[nodes_[at].axis] > nodes_[at].position;
    }
    if (!any[0] || !any[1]) return;
    for (std::size_t side = 0; side < 2; ++side) {
      const std::uint32_t child = make_child(at, side);
      nodes_[at].children[side] = child;
    }
    sift(at, boxes);
  }

  /// Turns a node into a leaf with all boxes below it.
  void collapse(std::uint32_t at) {
    std::vector<std::uint32_t> below(nodes_[at].children.begin(), nodes_[at].children.end());
    while (!below.empty()) {
      const std::uint32_t child = below.back();
      below.pop_back();
      for (const std::uint32_t id : nodes_[child].boxes) {
        homes_[id] = {at, static_cast<std::uint32_t>(nodes_[at].boxes.size())};
        nodes_[at].boxes.push_back(id);
      }
      if (!nodes_[child].is_leaf())
        below.insert(below.end(), nodes_[child].children.begin(), nodes_[child].children.end());
      nodes_[child].children = {none, none};
      nodes_[child].boxes.clear();
      nodes_[child].population = 0;
      free_.push_back(child);
    }
    nodes_[at].children = {none, none};
  }

  bool has_too_few(const Node& node) const noexcept {
    return node.population < leaf_boxes_ || nodes_[node.children[0]].population == 0 ||
           nodes_[node.children[1]].population == 0;
  }

  /// The published measure: the pairs left to test, from 0 for a perfect plane to 1 for no gain, against how
  /// evenly the plane divides.
  bool divides_badly(const Node& node) const noexcept {
    const auto all = static_cast<double>(node.population);
    const auto left = static_cast<double>(nodes_[node.children[0]].population);
    const auto right = static_cast<double>(nodes_[node.children[1]].population);
    const double here = all - left - right;
    const double max_tests = (all * all - all) / 2;
    const double min_tests = all * all / 4 - all / 2;
    const double tests = (here * here + left * left + right * right - all) / 2 + here * (left + right);
    const double balance = left < right ? left / (right + here) : right / (left + here);
    return (tests - min_tests) / (max_tests - min_tests) > balance;
  }

  bool is_flagged(std::uint32_t id) const noexcept { return search_.flags.empty() || search_.flags[id] != 0; }

  std::size_t count_flagged(std::uint32_t at) {
    std::size_t count = 0;
    for (const std::uint32_t id : nodes_[at].boxes) count += is_flagged(id) ? 1 : 0;
    if (!nodes_[at].is_leaf()) {
      for (const std::uint32_t child : nodes_[at].children) count += count_flagged(child);
    }
    return nodes_[at].flagged = count;
  }

  /// Sweeps a node's boxes against each other and against above_, the boxes of the nodes above that reach
  /// into this one; then searches its children.
  void search_below(std::uint32_t at) {
    const Node& node = nodes_[at];
    // No flagged box is in this node or reaches into it.
    if (node.flagged == 0 && above_[1].empty()) return;
    if (!node.boxes.empty()) sweep_node(node);
    if (node.is_leaf()) return;
    for (std::size_t side = 0; side < 2; ++side) {
      std::array<std::vector<std::uint32_t>, 2> outer;
      for (std::size_t flag = 0; flag < 2; ++flag) {
        for (const std::uint32_t id : above_[flag]) {
          if (reaches(node, search_.boxes[id], side)) outer[flag].push_back(id);
        }
      }
      for (const std::uint32_t id : node.boxes) outer[is_flagged(id) ? 1 : 0].push_back(id);
      outer.swap(above_);
      search_below(node.children[side]);
      outer.swap(above_);
    }
  }

  static bool reaches(const Node& node, const Box<D>& box, std::size_t side) noexcept {
    return side == 0 ? box.min[node.axis] < node.position : box.max[node.axis] > node.position;
  }

  void sweep_node(const Node& node) {
    Centres<D> centres;
    for (std::vector<std::uint32_t>& list : here_) list.clear();
    for (const std::uint32_t id : node.boxes) {
      centres.add(search_.boxes[id]);
      here_[is_flagged(id) ? 1 : 0].push_back(id);
    }
    const int axis = centres.widest_axis();
    for (std::size_t flag = 0; flag < 2; ++flag) {
      sort(here_[flag], axis, sorted_here_[flag]);
      sort(above_[flag], axis, sorted_above_[flag]);
    }
    Checkpoint& checkpoint = *search_.checkpoint;
    checkpoint.count(above_[0].size() + above_[1].size());
    PairSink& pairs = *search_.pairs;
    if (!search_.across) {
      sweep(sorted_here_[1], checkpoint, pairs);
      sweep(sorted_here_[1], sorted_above_[1], checkpoint, pairs);
    }
    sweep(sorted_here_[1], sorted_here_[0], checkpoint, pairs);
    sweep(sorted_here_[1], sorted_above_[0], checkpoint, pairs);
    sweep(sorted_here_[0], sorted_above_[1], checkpoint, pairs);
  }

  void sort(std::span<const std::uint32_t> ids, int axis, SortedBoxes<D>& sorted) {
    keys_.clear();
    for (const std::uint32_t id : ids)
      keys_.push_back(std::uint64_t{sort_key(search_.boxes[id].min[axis])} << 32 | id);
    std::ranges::sort(keys_);
    sorted.resize(keys_.size());
    for (std::size_t i = 0; i < keys_.size(); ++i) {
      const auto id = static_cast<std::uint32_t>(keys_[i]);
      sorted.set(i, search_.boxes[id], BoxId{id}, axis);
    }
  }

  std::size_t leaf_boxes_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> free_;  // nodes not in use
  std::vector<Home> homes_;          // by box
  std::vector<std::uint32_t> stack_;

  // During a search: boxes without a flag and with one.
  JoinContext search_;
  std::array<std::vector<std::uint32_t>, 2> above_;
  std::array<std::vector<std::uint32_t>, 2> here_;
  std::array<SortedBoxes<D>, 2> sorted_here_;
  std::array<SortedBoxes<D>, 2> sorted_above_;
  std::vector<std::uint64_t> keys_;
};

}  // namespace broadside::lab::literature
