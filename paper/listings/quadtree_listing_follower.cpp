// Section VI-D of paper.md: the references of boxes that changed are put into other leaves, then Algorithm 10
// traverses the tree. What was mended in the text, and why, is in docs/paper/errata.md.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "paper/listings/coherent_follower.hpp"
#include "paper/listings/followers.hpp"
#include "paper/listings/quadtree_listing.hpp"

namespace broadside::paper {
namespace {

/// Where the insertion of a box that changed begins.
enum class ReinsertFrom {
  rebuild,   ///< with all others: the tree is built anew
  root,      ///< "reinserting at the root"
  relative,  ///< "insert based on relative position": at the least node above its leaf that holds it
  siblings,  ///< "translate references across siblings", each reference by itself; where that fails, at the
             ///< root
  cousins    ///< where that fails, "go to the cousin by traversing through the parent"
};

ReinsertFrom reinsert_from_of(const Settings& settings) {
  const std::string& text = settings.text("update");
  if (text == "root") return ReinsertFrom::root;
  if (text == "relative") return ReinsertFrom::relative;
  if (text == "siblings") return ReinsertFrom::siblings;
  return text == "cousins" ? ReinsertFrom::cousins : ReinsertFrom::rebuild;
}

class QuadtreeListingFollower final : public CoherentFollower<2> {
 public:
  explicit QuadtreeListingFollower(const Settings& settings)
      : CoherentFollower(settings),
        from_(reinsert_from_of(settings)),
        world_settings_(settings),
        capacity_(static_cast<std::size_t>(settings.integer("capacity"))) {}

 private:
  void build() override {
    world_ = world_settings_.around(boxes());
    tree_ = {.boxes = boxes(),
             .count_max = capacity_,
             .depth_max = choose_depth(boxes(), world_),
             .checkpoint = &checkpoint()};
    if (from_ != ReinsertFrom::rebuild) tree_.leaves.resize(boxes().size());
    root_.emplace(tree_, world_);
    most_references_ = 0;
    for (std::size_t i = 0; i < boxes().size(); ++i) {
      if (!is_present(boxes()[i])) continue;
      root_->algorithm_7_add_element(BoxId(i));
      most_references_ += references_at(tree_.depth_max, boxes()[i], world_);
    }
    nodes_built_ = tree_.nodes;
  }

  bool mend(std::span<const BoxId> movers, std::span<const Box2> now) override {
    tree_.visits = 0;
    // Nothing joins subnodes that boxes have left (erratum T11).
    if (from_ == ReinsertFrom::rebuild || tree_.nodes > 2 * nodes_built_ + 16 * present() + 64) return false;
    tree_.boxes = boxes();
    tree_.leaves.resize(boxes().size());
    for (const BoxId id : movers) {
      const Box2 to = now[index(id)];
      const Box2 from = std::exchange(boxes()[index(id)], to);
      if (is_present(from)) most_references_ -= references_at(tree_.depth_max, from, world_);
      if (is_present(to)) most_references_ += references_at(tree_.depth_max, to, world_);
      if (most_references_ > most_references_in_tree(present())) return false;  // erratum 7c
      if (!is_present(from)) {
        if (is_present(to)) root_->algorithm_7_add_element(id);
      } else if (!is_present(to)) {
        remove_everywhere(id);
      } else {
        reposition(id, to);
      }
    }
    counts().visited += tree_.visits;
    return true;
  }

  void reposition(BoxId id, const Box2& to) {
    std::vector<QuadTreeNode*>& leaves = tree_.leaves[index(id)];
    counts().visited += leaves.size();
    if (leaves.size() == 1 && leaves.front()->region().holds(to)) {
      leaves.front()->split_if_full();
      return;
    }
    switch (from_) {
      case ReinsertFrom::relative: {
        QuadTreeNode* const node = holder(leaves.front(), to);
        remove_everywhere(id);
        insert(*node, id);
        break;
      }
      case ReinsertFrom::siblings:
      case ReinsertFrom::cousins:
        translate(id, to);
        break;
      default:
        remove_everywhere(id);
        insert(*root_, id);
    }
  }

  /// Each reference by itself: it climbs from its leaf to the least node that holds the box, and goes down
  /// from there to the leaves that the box is in and that have none yet. A reference whose leaf the box is
  /// still in stays; but if all do, the first one climbs for all, since the box may have grown (erratum T12).
  void translate(BoxId id, const Box2& to) {
    const std::vector<QuadTreeNode*> before = tree_.leaves[index(id)];
    bool has_climbed = false;
    for (QuadTreeNode* const leaf : before) {
      if (leaf->region().meets(to)) continue;
      remove(*leaf, id);
      if (!spread(*leaf, id, to)) return;
      has_climbed = true;
    }
    if (has_climbed) return;
    for (QuadTreeNode* const leaf : before) leaf->split_if_full();
    spread(*before.front(), id, to);
  }

  /// From the leaf by way of the node that holds the box. False where that is beyond its siblings and cousins
  /// are not asked: then the box has been inserted from the root.
  bool spread(QuadTreeNode& leaf, BoxId id, const Box2& to) {
    QuadTreeNode* node = &leaf;
    if (from_ == ReinsertFrom::siblings) {
      if (leaf.parent() != nullptr) node = leaf.parent();
      ++counts().visited;
      if (!node->region().holds(to)) {
        remove_everywhere(id);
        insert(*root_, id);
        return false;
      }
    } else {
      node = holder(node, to);
    }
    const std::size_t had = tree_.leaves[index(id)].size();
    node->add_where_missing(id);
    counts().moved += tree_.leaves[index(id)].size() - had;
    return true;
  }

  /// The least node from `node` upwards that holds the box.
  QuadTreeNode* holder(QuadTreeNode* node, const Box2& to) {
    for (; node->parent() != nullptr && !node->region().holds(to); node = node->parent()) ++counts().visited;
    return node;
  }

  void insert(QuadTreeNode& node, BoxId id) {
    node.algorithm_7_add_element(id);
    counts().moved += tree_.leaves[index(id)].size();
  }

  void remove(QuadTreeNode& leaf, BoxId id) {
    leaf.remove(id);
    std::erase(tree_.leaves[index(id)], &leaf);
    ++counts().moved;
  }

  void remove_everywhere(BoxId id) {
    for (QuadTreeNode* const leaf : tree_.leaves[index(id)]) leaf->remove(id);
    counts().moved += tree_.leaves[index(id)].size();
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

  ReinsertFrom from_;
  WorldSettings world_settings_;
  std::size_t capacity_;
  World world_{};
  QuadTree tree_;
  std::optional<QuadTreeNode> root_;
  double most_references_ = 0;  // of a full tree of this depth
  std::size_t nodes_built_ = 0;
};

}  // namespace

std::unique_ptr<Follower<2>> make_quadtree_follower(const Settings& settings) {
  return std::make_unique<QuadtreeListingFollower>(settings);
}

}  // namespace broadside::paper
