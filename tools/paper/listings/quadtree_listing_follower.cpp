// Section VI-D of paper.md: moves the references of changed boxes to other leaves, then Algorithm 10
// traverses the tree. docs/paper/errata.md lists the corrections and their reasons.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "paper/listings/coherent_follower.hpp"
#include "paper/listings/followers.hpp"
#include "paper/listings/quadtree_listing.hpp"

namespace broadside::paper {
namespace {

/// How the references of a changed box get into other leaves.
enum class TreeReposition {
  rebuild,                 ///< with all others: the tree is rebuilt
  search_delete_reinsert,  ///< VI-A: all nodes are searched for it; it is deleted, and inserted at the root
  root,                    ///< "reinserting at the root"; its leaves are known
  relative,  ///< "insert based on relative position": at the lowest node above its leaf that contains it
  siblings,  ///< "translate references across siblings"; without a sibling, it is inserted at the root
  cousins    ///< without a sibling, "go to the cousin by traversing through the parent"
};

TreeReposition tree_reposition_of(const Settings& settings) {
  const std::string& text = settings.text("update");
  if (text == "search_delete_reinsert") return TreeReposition::search_delete_reinsert;
  if (text == "root") return TreeReposition::root;
  if (text == "relative") return TreeReposition::relative;
  if (text == "siblings") return TreeReposition::siblings;
  return text == "cousins" ? TreeReposition::cousins : TreeReposition::rebuild;
}

/// Whether the leaves just beyond a side of a region already have the box: wherever its new place meets them,
/// its previous place did as well.
bool has_crossed(const HalfOpenRegion& region, const Box2& from, const Box2& to, int axis, int side) {
  const int other = 1 - axis;
  return region.meets(from) && region.is_crossed(from, axis, side) &&
         (from.min[other] <= to.min[other] || from.min[other] <= region.begin[other]) &&
         (from.max[other] >= to.max[other] || from.max[other] >= region.end[other]);
}

class QuadtreeListingFollower final : public CoherentFollower<2> {
 public:
  explicit QuadtreeListingFollower(const Settings& settings)
      : CoherentFollower(settings),
        reposition_(tree_reposition_of(settings)),
        world_settings_(settings),
        capacity_(static_cast<std::size_t>(settings.integer("capacity"))) {}

 private:
  void build() override {
    world_ = world_settings_.around(boxes());
    tree_ = {.boxes = boxes(),
             .count_max = capacity_,
             .depth_max = choose_depth(boxes(), world_),
             .checkpoint = &checkpoint()};
    if (knows_leaves()) tree_.leaves.resize(boxes().size());
    root_.emplace(tree_, world_);
    max_references_ = 0;
    for (std::size_t i = 0; i < boxes().size(); ++i) {
      if (!is_present(boxes()[i])) continue;
      root_->algorithm_7_add_element(BoxId(i));
      max_references_ += references_at(tree_.depth_max, boxes()[i], world_);
    }
    nodes_built_ = tree_.nodes;
    counts().visited += tree_.visits;
    counts().moved += tree_.entries;
  }

  bool mend(std::span<const BoxId> movers, std::span<const Box2> now) override {
    // Subnodes that boxes have left are never merged (erratum T11).
    if (reposition_ == TreeReposition::rebuild || tree_.nodes > 2 * nodes_built_ + 16 * present() + 64)
      return false;
    tree_.visits = 0;
    tree_.entries = 0;
    tree_.boxes = boxes();
    if (knows_leaves()) tree_.leaves.resize(boxes().size());
    for (const BoxId id : movers) {
      const Box2 to = now[index(id)];
      const Box2 from = std::exchange(boxes()[index(id)], to);
      if (is_present(from)) max_references_ -= references_at(tree_.depth_max, from, world_);
      if (is_present(to)) max_references_ += references_at(tree_.depth_max, to, world_);
      if (max_references_ > max_references_in_tree(present())) return false;  // erratum 7c
      if (knows_leaves() && is_present(from) && is_present(to)) {
        reposition(id, from, to);
      } else {
        if (is_present(from)) remove_everywhere(id);
        if (is_present(to)) root_->algorithm_7_add_element(id);
      }
    }
    counts().visited += tree_.visits;
    counts().moved += tree_.entries;
    return true;
  }

  /// Whether each box has a list of its leaves, so that they need not be searched for.
  bool knows_leaves() const {
    return reposition_ != TreeReposition::rebuild && reposition_ != TreeReposition::search_delete_reinsert;
  }

  void reposition(BoxId id, const Box2& from, const Box2& to) {
    std::vector<QuadTreeNode*>& leaves = tree_.leaves[index(id)];
    tree_.visits += leaves.size();
    if (leaves.size() == 1 && leaves.front()->region().holds(to)) {
      leaves.front()->split_if_full();
      return;
    }
    if (reposition_ == TreeReposition::siblings || reposition_ == TreeReposition::cousins) {
      if (translate(id, from, to)) return;
    }
    QuadTreeNode* const node = reposition_ == TreeReposition::relative ? holder(leaves.front(), to) : &*root_;
    remove_everywhere(id);
    node->algorithm_7_add_element(id);
  }

  /// Each reference whose leaf the box has left moves across the side through which it left. Then references
  /// move across the sides of leaves over which the box now extends, because it may have grown (erratum T12).
  /// False if this needs more than siblings but only siblings are allowed; changes made until then do no
  /// harm.
  bool translate(BoxId id, const Box2& from, const Box2& to) {
    std::vector<QuadTreeNode*>& leaves = tree_.leaves[index(id)];
    before_ = leaves;
    for (QuadTreeNode* const leaf : before_) {
      if (leaf->region().meets(to)) {
        leaf->split_if_full();
        continue;
      }
      remove(*leaf, id);
      QuadTreeNode* const node = walk(leaf, to);
      if (node == nullptr) return false;
      node->add_where_missing(id);
    }
    for (std::size_t i = 0; i < leaves.size(); ++i) {  // includes the leaves added meanwhile
      for (const int axis : {0, 1}) {
        for (const int side : {-1, 1}) {
          QuadTreeNode& leaf = *leaves[i];
          if (!leaf.region().is_crossed(to, axis, side) || has_crossed(leaf.region(), from, to, axis, side))
            continue;
          QuadTreeNode* const node = beside(leaf, axis, side);
          if (node == nullptr) return false;
          node->add_where_missing(id);
        }
      }
    }
    return true;
  }

  /// Walks by neighbours from a node that the box does not meet to one that it meets. Null if beside() is.
  QuadTreeNode* walk(QuadTreeNode* node, const Box2& to) {
    for (;;) {
      const bool is_left_in_x = node->region().is_left(to, 0, -1) || node->region().is_left(to, 0, 1);
      const int axis = is_left_in_x ? 0 : 1;
      node = beside(*node, axis, node->region().is_left(to, axis, -1) ? -1 : 1);
      if (node == nullptr || node->region().meets(to)) return node;
      ++tree_.visits;
    }
  }

  /// The neighbour on that side, which must exist; null if only siblings are allowed and it is not one.
  QuadTreeNode* beside(QuadTreeNode& node, int axis, int side) {
    if (reposition_ == TreeReposition::siblings && !node.has_sibling(axis, side)) return nullptr;
    return node.neighbour(axis, side);
  }

  /// The lowest node from `node` upwards that contains the box.
  QuadTreeNode* holder(QuadTreeNode* node, const Box2& to) {
    for (; node->parent() != nullptr && !node->region().holds(to); node = node->parent()) ++tree_.visits;
    return node;
  }

  void remove(QuadTreeNode& leaf, BoxId id) {
    leaf.remove(id);
    std::erase(tree_.leaves[index(id)], &leaf);
  }

  void remove_everywhere(BoxId id) {
    if (!knows_leaves()) return root_->search_and_remove(id);
    for (QuadTreeNode* const leaf : tree_.leaves[index(id)]) leaf->remove(id);
    tree_.leaves[index(id)].clear();
  }

  Statistics search(PairSink& pairs) override {
    tree_.boxes = boxes();
    return search_tree(tree_, *root_, pairs);
  }

  std::size_t structure_bytes() const noexcept override {
    std::size_t bytes =
        tree_.nodes * sizeof(QuadTreeNode) + tree_.leaves.capacity() * sizeof(std::vector<QuadTreeNode*>);
    // An entry in a leaf, and one in the list of leaves.
    for (const auto& leaves : tree_.leaves) bytes += leaves.capacity() * (sizeof(void*) + sizeof(BoxId));
    return bytes;
  }

  TreeReposition reposition_;
  WorldSettings world_settings_;
  std::size_t capacity_;
  World world_{};
  QuadTree tree_;
  std::optional<QuadTreeNode> root_;
  std::vector<QuadTreeNode*> before_;  // a mover's leaves
  double max_references_ = 0;          // of a full tree of this depth
  std::size_t nodes_built_ = 0;
};

}  // namespace

std::unique_ptr<Follower<2>> make_quadtree_follower(const Settings& settings) {
  return std::make_unique<QuadtreeListingFollower>(settings);
}

}  // namespace broadside::paper
