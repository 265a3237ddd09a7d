// Algorithms 7 to 10 of paper.md, corrected.
#include "paper/listings/quadtree_listing.hpp"

#include <algorithm>
#include <limits>

#include "kernels/observed_tests.hpp"

namespace broadside::paper {
namespace {

/// The maximum depth of a tree: a node there is 2^-48 of the world, less than a float can resolve except near
/// zero.
constexpr int max_depth = 48;

/// The maximum average number of references per box in the leaves.
constexpr double max_references_per_box = 16;

}  // namespace

QuadTreeNode::QuadTreeNode(QuadTree& tree, const World& world)
    : tree_(&tree),
      x_origin_(world.left + world.width * 0.5),
      y_origin_(world.top + world.height * 0.5),
      half_width_(world.width * 0.5),
      half_height_(world.height * 0.5) {
  region_.begin.fill(-std::numeric_limits<double>::infinity());
  region_.end.fill(std::numeric_limits<double>::infinity());
  tree.nodes = 1;
}

/// The new subnode on the given side (-1 or 1) of each axis.
QuadTreeNode::QuadTreeNode(QuadTreeNode& parent, int x_side, int y_side)
    : tree_(parent.tree_),
      parent_(&parent),
      sides_{x_side, y_side},
      depth_(parent.depth_ + 1),
      region_(parent.region_),
      half_width_(parent.half_width_ * 0.5),
      half_height_(parent.half_height_ * 0.5) {
  x_origin_ = parent.x_origin_ + x_side * half_width_;
  y_origin_ = parent.y_origin_ + y_side * half_height_;
  (x_side < 0 ? region_.end : region_.begin)[0] = parent.x_origin_;
  (y_side < 0 ? region_.end : region_.begin)[1] = parent.y_origin_;
  ++tree_->nodes;
}

void QuadTreeNode::algorithm_7_add_element(BoxId e) {
  ++tree_->visits;
  if (qi_ != nullptr) {  // Erratum 7a
    algorithm_9_spanning_add_element(e);
  } else {
    e_.push_back(e);
    ++tree_->entries;
    if (!tree_->leaves.empty()) tree_->leaves[index(e)].push_back(this);
    if (count_ + 1 > tree_->count_max && can_split()) {  // Errata 7b and 7c
      algorithm_8_split();
      count_ = 0;
    } else {
      count_ = count_ + 1;
    }
  }
}

/// Algorithm 8, "Split".
void QuadTreeNode::algorithm_8_split() {
  const auto child = [this](int x_side, int y_side) {
    return std::unique_ptr<QuadTreeNode>(new QuadTreeNode(*this, x_side, y_side));
  };
  qi_ = child(1, -1);    // Erratum 8a
  qii_ = child(-1, -1);  // Erratum 8a
  qiii_ = child(-1, 1);  // Erratum 8a
  qiv_ = child(1, 1);    // Erratum 8a
  const std::uint64_t visits = tree_->visits;
  for (std::size_t i = 0; i < e_.size(); ++i) {  // Erratum 8c
    if (!tree_->leaves.empty()) std::erase(tree_->leaves[index(e_[i])], this);
    algorithm_9_spanning_add_element(e_[i]);
  }
  tree_->visits = visits;  // entries are redistributed; no insertion is under way
  e_ = {};                 // Erratum 8b
}

/// Algorithm 9, "Spanning Add Element".
void QuadTreeNode::algorithm_9_spanning_add_element(BoxId id) {
  const Box2& e = tree_->boxes[index(id)];
  if (e.max[0] >= x_origin_ && e.min[1] < y_origin_) {  // Errata 9a and 9b
    qi_->algorithm_7_add_element(id);
  }
  if (e.min[0] < x_origin_ && e.min[1] < y_origin_) {
    qii_->algorithm_7_add_element(id);
  }
  if (e.min[0] < x_origin_ && e.max[1] >= y_origin_) {  // Errata 9a and 9b
    qiii_->algorithm_7_add_element(id);
  }
  if (e.max[0] >= x_origin_ && e.max[1] >= y_origin_) {  // Errata 9a and 9b
    qiv_->algorithm_7_add_element(id);
  }
}

/// Whether subnodes can help. They cannot if all boxes share a point: some subnode gets all of them, and no
/// test is saved, because every test finds a pair.
bool QuadTreeNode::can_split() const {
  if (depth_ == tree_->depth_max) return false;
  tree_->checkpoint->count(e_.size());
  tree_->entries += e_.size();
  Box2 common = tree_->boxes[index(e_.front())];
  for (const BoxId id : e_) {
    const Box2& e = tree_->boxes[index(id)];
    for (int axis = 0; axis < 2; ++axis) {
      common.min[axis] = std::max(common.min[axis], e.min[axis]);
      common.max[axis] = std::min(common.max[axis], e.max[axis]);
    }
  }
  return !is_present(common);
}

void QuadTreeNode::add_where_missing(BoxId e) {
  if (is_leaf()) {
    const auto& leaves = tree_->leaves[index(e)];
    if (std::find(leaves.begin(), leaves.end(), this) == leaves.end()) return algorithm_7_add_element(e);
  }
  ++tree_->visits;
  if (is_leaf()) return;
  for (QuadTreeNode* const child : {qi_.get(), qii_.get(), qiii_.get(), qiv_.get()}) {
    if (child->region_.meets(tree_->boxes[index(e)])) child->add_where_missing(e);
  }
}

void QuadTreeNode::remove(BoxId e) {
  const auto place = std::find(e_.begin(), e_.end(), e);
  const auto looked_at = static_cast<std::uint64_t>(place - e_.begin());
  tree_->checkpoint->count(looked_at);
  tree_->entries += looked_at;
  if (place == e_.end()) return;
  *place = e_.back();
  e_.pop_back();
  --count_;
  ++tree_->entries;
}

void QuadTreeNode::search_and_remove(BoxId e) {
  ++tree_->visits;
  if (is_leaf()) {
    remove(e);
    return;
  }
  for (QuadTreeNode* const child : {qi_.get(), qii_.get(), qiii_.get(), qiv_.get()})
    child->search_and_remove(e);
}

QuadTreeNode* QuadTreeNode::child(int x_side, int y_side) const {
  if (x_side > 0) return y_side < 0 ? qi_.get() : qiv_.get();
  return y_side < 0 ? qii_.get() : qiii_.get();
}

QuadTreeNode* QuadTreeNode::neighbour(int axis, int side) {
  if (parent_ == nullptr) return nullptr;
  ++tree_->visits;
  const QuadTreeNode* from = parent_;
  if (!has_sibling(axis, side)) {
    QuadTreeNode* const beside = parent_->neighbour(axis, side);
    if (beside == nullptr || beside->is_leaf()) return beside;
    ++tree_->visits;
    from = beside;
  }
  return axis == 0 ? from->child(-sides_[0], sides_[1]) : from->child(sides_[0], -sides_[1]);
}

void QuadTreeNode::split_if_full() {
  if (!is_leaf() || count_ <= tree_->count_max || !can_split()) return;
  algorithm_8_split();
  count_ = 0;
}

std::size_t QuadTreeNode::lay_out(std::vector<std::vector<Box2>>& levels) const {
  const auto depth = static_cast<std::size_t>(depth_);
  levels.resize(std::max(levels.size(), depth + 1));
  Box2 box;
  for (int axis = 0; axis < 2; ++axis) {
    box.min[axis] = static_cast<float>(region_.begin[axis]);
    box.max[axis] = static_cast<float>(region_.end[axis]);
  }
  levels[depth].push_back(box);
  if (is_leaf()) return 1;
  return qi_->lay_out(levels) + qii_->lay_out(levels) + qiii_->lay_out(levels) + qiv_->lay_out(levels);
}

std::size_t QuadTreeNode::references() const {
  if (is_leaf()) return e_.size();
  return qi_->references() + qii_->references() + qiii_->references() + qiv_->references();
}

double references_at(int depth, const Box2& box, const World& world) {
  const double nodes = std::ldexp(1.0, depth);
  const auto spanned = [&](int axis, double begin, double length) {
    const auto node = [&](double x) {
      return std::clamp<double>(std::floor((x - begin) / length * nodes), 0, nodes - 1);
    };
    return node(box.max[axis]) - node(box.min[axis]) + 1;
  };
  return spanned(0, world.left, world.width) * spanned(1, world.top, world.height);
}

double max_references_in_tree(std::size_t boxes) {
  return max_references_per_box * static_cast<double>(boxes);
}

int choose_depth(std::span<const Box2> boxes, const World& world) {
  int fits = 0;
  int beyond = max_depth + 1;
  while (beyond - fits > 1) {
    const int depth = (fits + beyond) / 2;
    double references = 0;
    std::size_t present = 0;
    for (const Box2& box : boxes) {
      if (!is_present(box)) continue;
      ++present;
      references += references_at(depth, box, world);
    }
    (references <= max_references_in_tree(present) ? fits : beyond) = depth;
  }
  return fits;
}

Statistics search_tree(const QuadTree& tree, const QuadTreeNode& root, PairSink& pairs) {
  Statistics statistics{.references = root.references()};
  auto test_collide = [&](const HalfOpenRegion& leaf, BoxId a, BoxId b) {
    ++statistics.tests;
    if constexpr (kernels::is_observing) kernels::observe_test(a, b);
    const Box2& first = tree.boxes[index(a)];
    const Box2& second = tree.boxes[index(b)];
    if (!overlap(first, second)) return;
    const bool here =
        leaf.holds(std::max(first.min[0], second.min[0]), std::max(first.min[1], second.min[1]));
    if (here) pairs.add(a, b);  // Erratum 10a
  };
  root.algorithm_10_traverse(test_collide);
  return statistics;
}

}  // namespace broadside::paper
