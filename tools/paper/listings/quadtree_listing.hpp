// The quadtree as in section V of paper.md: Algorithms 7 to 10. docs/paper/errata.md lists the corrections
// and their reasons.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "broadside/executor.hpp"
#include "broadside/searcher.hpp"

#include "paper/listings/algorithm_1.hpp"
#include "paper/listings/world.hpp"

namespace broadside::paper {

/// The points with begin <= x < end on both axes; +inf is in regions that end at +inf.
struct HalfOpenRegion {
  std::array<double, 2> begin;
  std::array<double, 2> end;

  bool holds(double x, double y) const {
    return begin[0] <= x && begin[1] <= y && ends_after(x, 0) && ends_after(y, 1);
  }

  /// Whether all of a present box is in the region, and whether any of it is: exactly then, Algorithm 9 takes
  /// the box to a leaf with this region.
  bool holds(const Box2& e) const {
    return holds(e.min[0], e.min[1]) && ends_after(e.max[0], 0) && ends_after(e.max[1], 1);
  }
  bool meets(const Box2& e) const {
    return e.max[0] >= begin[0] && e.max[1] >= begin[1] && ends_after(e.min[0], 0) && ends_after(e.min[1], 1);
  }

  /// Whether any of the box is beyond the side (-1 or 1) along an axis, and whether all of it is.
  bool is_crossed(const Box2& e, int axis, int side) const {
    return side < 0 ? e.min[axis] < begin[axis] : !ends_after(e.max[axis], axis);
  }
  bool is_left(const Box2& e, int axis, int side) const {
    return side < 0 ? e.max[axis] < begin[axis] : !ends_after(e.min[axis], axis);
  }

 private:
  bool ends_after(double x, int axis) const { return x < end[axis] || std::isinf(end[axis]); }
};

class QuadTreeNode;

/// State shared by all nodes of a tree.
struct QuadTree {
  std::span<const Box2> boxes;
  std::size_t count_max = 0;
  int depth_max = 0;
  Checkpoint* checkpoint = nullptr;  ///< counts tests, and boxes visited on the way to them
  std::size_t nodes = 0;             ///< number of nodes
  std::uint64_t visits = 0;          ///< nodes visited on the ways of boxes to their leaves
  std::uint64_t entries = 0;         ///< added, removed, or examined for that; splits redistribute them

  /// For each box, the leaves that it is in, if section VI-D needs them; otherwise empty.
  std::vector<std::vector<QuadTreeNode*>> leaves{};
};

class QuadTreeNode {
 public:
  /// The root of a tree without boxes, for the given world.
  QuadTreeNode(QuadTree& tree, const World& world);

  /// Algorithm 7, "Add Element".
  void algorithm_7_add_element(BoxId e);

  /// Algorithm 10, "Traverse". Calls test_collide(region, a, b) for the pairs of each leaf.
  template <typename TestCollide>
  void algorithm_10_traverse(TestCollide& test_collide) const {
    if (qi_ != nullptr) qi_->algorithm_10_traverse(test_collide);      // Erratum 10c
    if (qii_ != nullptr) qii_->algorithm_10_traverse(test_collide);    // Erratum 10c
    if (qiii_ != nullptr) qiii_->algorithm_10_traverse(test_collide);  // Erratum 10c
    if (qiv_ != nullptr) qiv_->algorithm_10_traverse(test_collide);    // Erratum 10c
    algorithm_1_brute_force(e_, *tree_->checkpoint, [&](BoxId a, BoxId b) { test_collide(region_, a, b); });
  }

  /// Algorithm 9 from this node, for a box that may already be in some of the leaves: adds it to the others.
  void add_where_missing(BoxId e);

  /// Removes a box from this leaf, if it is there.
  void remove(BoxId e);

  /// Searches this node and all below it for a box, and removes it from its leaves.
  void search_and_remove(BoxId e);

  /// The node on the given side (-1 or 1) of this one along an axis, of the same size or, if there is none,
  /// the larger leaf; null at the border of the world. Finds neighbours as Samet does: a sibling through the
  /// parent, a cousin through the nearest ancestor with a child on that side, and the mirrored path down.
  QuadTreeNode* neighbour(int axis, int side);

  /// Whether that neighbour is a sibling.
  bool has_sibling(int axis, int side) const noexcept { return parent_ != nullptr && sides_[axis] != side; }

  /// Splits a leaf that has become too full while boxes moved.
  void split_if_full();

  /// Appends the regions of the node and its descendants to the levels. Returns the number of leaves among
  /// them.
  std::size_t lay_out(std::vector<std::vector<Box2>>& levels) const;

  /// The entries in this node's leaves.
  std::size_t references() const;

  const HalfOpenRegion& region() const noexcept { return region_; }
  QuadTreeNode* parent() const noexcept { return parent_; }
  bool is_leaf() const noexcept { return qi_ == nullptr; }

 private:
  QuadTreeNode(QuadTreeNode& parent, int x_side, int y_side);

  QuadTreeNode* child(int x_side, int y_side) const;
  void algorithm_8_split();
  void algorithm_9_spanning_add_element(BoxId id);
  bool can_split() const;

  QuadTree* tree_;
  QuadTreeNode* parent_ = nullptr;
  std::array<int, 2> sides_{};  // of the parent, -1 or 1 on each axis
  int depth_ = 0;
  HalfOpenRegion region_;
  double x_origin_;
  double y_origin_;
  double half_width_;
  double half_height_;
  std::size_t count_ = 0;
  std::vector<BoxId> e_;
  std::unique_ptr<QuadTreeNode> qi_;
  std::unique_ptr<QuadTreeNode> qii_;
  std::unique_ptr<QuadTreeNode> qiii_;
  std::unique_ptr<QuadTreeNode> qiv_;
};

/// The number of entries of a present box in all leaves if every node down to `depth` is split; no tree of
/// that depth has more.
double references_at(int depth, const Box2& box, const World& world);

/// The maximum number of references that the leaves may hold, whatever the order in which boxes are added
/// (erratum 7c).
double max_references_in_tree(std::size_t boxes);

/// The maximum depth at which the leaves cannot hold more. Absent boxes do not count.
int choose_depth(std::span<const Box2> boxes, const World& world);

/// Traverses from `root`, and returns the counts.
Statistics search_tree(const QuadTree& tree, const QuadTreeNode& root, PairSink& pairs);

}  // namespace broadside::paper
