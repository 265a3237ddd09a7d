// QuadtreeFollower: the quadtree, in 3D an octree, stays from frame to frame.
//
// Sections VI-A and VI-D of the paper, in their fastest variant. A mover's descent starts near where it was:
// up through the parents to the first node that contains its old and its new box, and down from there. While
// it stays in one leaf, no entry moves. Everything that it may overlap is in the nodes that it was and is in,
// so it is compared with all boxes there.
//
// An update has three steps: movers are inserted wherever they go, as the bounds of the old and the new box;
// all are compared; then they are removed from where they were. So two movers find each other.
#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include "algorithms/event_sinks.hpp"
#include "algorithms/followers.hpp"
#include "algorithms/quadtree/quadtree_nodes.hpp"
#include "core/grow.hpp"
#include "kernels/find_changes.hpp"

namespace broadside::algorithm {
namespace {

/// Smaller than the searcher's capacity: the searcher sweeps a leaf only once for all of its boxes.
constexpr std::uint32_t default_following_capacity = 32;

template <int D>
class QuadtreeFollower final : public Follower<D> {
  using Nodes = QuadtreeNodes<D>;

 public:
  explicit QuadtreeFollower(const Settings& settings)
      : tree_(static_cast<std::uint32_t>(
            settings.optional_number("capacity").value_or(default_following_capacity))) {}

  std::optional<Statistics> follow(const Change<D>& change, PairSink& begun, PairSink& ended) override {
    movers_.clear();
    append_moved(change, change.changed, movers_);
    const std::size_t boxes = change.now.size();
    moved_since_build_ += movers_.size();
    if (change.rebuild || (tree_.needs_rebuild() && moved_since_build_ > boxes)) {
      tree_.build(change.before);
      moved_since_build_ = 0;
    }
    tree_.resize(boxes);
    Checkpoint checkpoint(change.workers.checkpoint);
    checkpoint_ = &checkpoint;
    EventSinks<D> events(change, begun, ended, &checkpoint);
    std::uint64_t tests = 0;
    // An empty tree is filled in rounds that double it, so that no leaf is overfull for long. In a single
    // round, all movers would be compared with each other.
    constexpr std::uint32_t first_few = 256;
    const auto count = static_cast<std::uint32_t>(movers_.size());
    std::uint32_t end = tree_.references() == 0 ? std::min(first_few, count) : count;
    for (std::uint32_t begin = 0; begin < end; begin = std::exchange(end, std::min(2 * end, count)))
      tests += take(begin, end, events, change);
    return Statistics{.tests = tests,
                      .references = tree_.references(),
                      .cells = tree_.node_count(),
                      .hits = events.candidates()};
  }

  std::size_t bytes() const noexcept override {
    return tree_.bytes() + core::bytes_of(movers_, entries_, looks_, above_, tasks_);
  }

 private:
  static constexpr std::uint32_t bit(std::uint32_t mask, std::uint32_t child) { return mask >> child & 1U; }

  /// Whether a mover's old box, its new box, or a box that it touches may be in a node or below it.
  struct MoverNodes {
    std::uint32_t before;
    std::uint32_t now;
    std::uint32_t seen;
  };

  struct Look {
    std::uint32_t mover;
    std::uint32_t node;
  };

  /// A mover in a node; it stays there if the new box is in the node too.
  struct NodeMover {
    std::uint32_t node;
    std::uint32_t slot;
    std::uint32_t mover;
    std::uint32_t stays;
  };

  /// Processes the movers numbered [begin, end). Returns the number of tests.
  std::uint64_t take(std::uint32_t begin, std::uint32_t end, EventSinks<D>& events, const Change<D>& change) {
    entries_.clear();
    looks_.clear();
    above_.clear();
    for (std::uint32_t mover = begin; mover < end; ++mover) insert(mover);
    look_all();
    const core::ChangeWork work =
        kernels::find_changes<D>(tree_.pool().view(), movers_, tasks_, events.sinks());
    events.flush();
    for (const NodeMover& entry : entries_) {
      if (entry.stays != 0) {
        tree_.pool().set(entry.slot, movers_[entry.mover].now);
        tree_.pool().unmark(entry.slot);
      } else {
        tree_.erase(entry.node, entry.slot);
      }
    }
    tree_.tidy(change.now);
    return work.tests;
  }

  /// Inserts a mover into the nodes that it enters, and notes which nodes to search.
  void insert(std::uint32_t number) {
    const core::MovedBox<D>& mover = movers_[number];
    home_ = tree_.home(index(mover.id));
    std::uint32_t from = Nodes::root;
    if (mover.was_present) {
      from = home_.node;
      if (home_.several == 0 && (!mover.is_present || tree_[from].contains(mover.now))) {
        above_.push_back({number, from});
        note(number, from, home_.slot, mover.is_present);
        looks_.push_back({number, from});
        return;
      }
      const auto holds = [&](std::uint32_t node) {
        return tree_[node].contains(mover.before) && (!mover.is_present || tree_[node].contains(mover.now));
      };
      while (from != Nodes::root && !holds(from)) from = tree_[from].parent;
    }
    above_.push_back({number, from});
    places_ = 0;
    visit(number, from, {mover.was_present, mover.is_present, 0});
    if (!mover.is_present)
      tree_.home(index(mover.id)) = {};
    else if (places_ > 1)
      tree_.home(index(mover.id)).several = 1;
  }

  /// Descends from a node to all nodes that held the mover, will hold it, or may hold boxes that it touches.
  void visit(std::uint32_t number, std::uint32_t at, const MoverNodes& parts) {
    const QuadtreeNode<D>& node = tree_[at];
    const core::MovedBox<D>& mover = movers_[number];
    if (node.is_leaf()) {
      if ((parts.before | parts.now) != 0) place(number, at, parts);
      looks_.push_back({number, at});
      return;
    }
    std::uint32_t before = parts.before != 0 ? node.touched(mover.before) : 0;
    std::uint32_t now = parts.now != 0 ? node.touched(mover.now) : 0;
    const bool kept_before = before != 0 && node.keeps(mover.before, before);
    const bool kept_now = now != 0 && node.keeps(mover.now, now);
    if (kept_before || kept_now) place(number, at, {kept_before, kept_now, 0});
    looks_.push_back({number, at});
    const std::uint32_t seen = kept_before || kept_now || parts.seen != 0 ? node.touched(mover.bounds) : 0;
    if (kept_before) before = 0;
    if (kept_now) now = 0;
    const std::uint32_t children = node.children;
    for (std::uint32_t rest = before | now | seen; rest != 0; rest &= rest - 1) {
      const auto child = static_cast<std::uint32_t>(std::countr_zero(rest));
      visit(number, children + child, {bit(before, child), bit(now, child), bit(seen, child)});
    }
  }

  /// Makes sure that a mover is in a node.
  void place(std::uint32_t number, std::uint32_t node, const MoverNodes& parts) {
    const core::MovedBox<D>& mover = movers_[number];
    checkpoint_->count(1 + tree_[node].count / kernels::block_size);  // the blocks in the node's chain
    std::uint32_t slot;
    if (parts.before == 0)
      slot = tree_.insert(node, mover.bounds, mover.id);
    else if (home_.node == node)
      slot = home_.slot;
    else
      slot = tree_.find(node, mover.id);
    note(number, node, slot, parts.now != 0);
    if (parts.now != 0 && places_++ == 0)
      tree_.home(index(mover.id)) = {node, slot & 0x7fffffffU, !tree_[node].is_leaf()};
  }

  void note(std::uint32_t number, std::uint32_t node, std::uint32_t slot, bool stays) {
    tree_.pool().set(slot, movers_[number].bounds);
    tree_.pool().mark(slot);
    entries_.push_back({node, slot, number, stays});
  }

  /// Makes the tasks, once every mover is inserted: otherwise a mover would miss another inserted after it.
  void look_all() {
    tasks_.clear();
    const auto look = [this](std::uint32_t mover, std::uint32_t node) {
      if (tree_[node].block != kernels::no_slot) tasks_.push_back({mover, tree_[node].block});
    };
    for (const Look& at : looks_) look(at.mover, at.node);
    if (tree_.kept() == 0) return;
    // Boxes kept in the nodes above may touch anything below.
    for (const Look& below : above_) {
      for (std::uint32_t at = tree_[below.node].parent; at != no_node; at = tree_[at].parent)
        look(below.mover, at);
    }
  }

  QuadtreeNodes<D> tree_;
  std::size_t moved_since_build_ = 0;
  std::vector<core::MovedBox<D>> movers_;
  std::vector<NodeMover> entries_;
  std::vector<Look> looks_;
  std::vector<Look> above_;  // for each mover, the uppermost node to search
  std::vector<kernels::BlockTask> tasks_;
  Checkpoint* checkpoint_ = nullptr;  // of this update

  // Of the mover being inserted: its former home, and the number of nodes in which it stays.
  QuadtreeHome home_;
  std::uint32_t places_ = 0;
};

}  // namespace

template <int D>
std::unique_ptr<Follower<D>> make_quadtree_follower(const Settings& settings) {
  return std::make_unique<QuadtreeFollower<D>>(settings);
}

template std::unique_ptr<Follower<2>> make_quadtree_follower(const Settings&);
template std::unique_ptr<Follower<3>> make_quadtree_follower(const Settings&);

}  // namespace broadside::algorithm
