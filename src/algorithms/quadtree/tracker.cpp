// A quadtree, in 3D an octree, that stays from frame to frame and is told what moved.
//
// Section VI-A and VI-D of the paper. A box that moves is filed anew either by a descent from the root, or
// relative to where it was: from its leaf up through parents until a node holds all of the way that it went,
// and from there down to siblings and cousins; or each of its references by itself, from leaf to leaf. While
// it stays in one leaf, nothing has to be filed at all.
// What is near a mover is in the nodes that it was and is in: there it is compared with everything.
//
// A frame has three parts. Movers are filed in addition wherever they go, as bounds of the old and the new
// box; then all of them are compared; then they leave where they were. So two that move see each other.
#include "algorithms/quadtree/tracker.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "broadside/broad_phase.hpp"

#include "algorithms/quadtree/nodes.hpp"
#include "algorithms/quadtree/siblings.hpp"
#include "interface/incremental_tracker.hpp"
#include "kernels/packs.hpp"

namespace broadside::own {
namespace {

/// Of boxes in a leaf. Smaller ones than the finder's, which sweeps a leaf once for all of its boxes.
constexpr std::uint32_t tracking_capacity = 32;

/// The fraction of changed boxes from which finding all pairs anew is not slower.
template <int D>
constexpr double worthwhile = D == 2 ? 0.3 : 0.2;

/// Takes pairs that may have begun or ended.
template <int D>
class Candidates final : public PairSink {
 public:
  Candidates(const Change<D>& change, PairSink& begun, PairSink& ended)
      : change_(change), begun_(begun), ended_(ended) {}

 private:
  void consume(std::span<const Pair> pairs) override {
    for (const Pair pair : pairs) change_.report(pair.first, pair.second, begun_, ended_);
  }

  const Change<D>& change_;
  PairSink& begun_;
  PairSink& ended_;
};

/// From where a mover is filed anew: the root; where it was; each leaf in which it was; or, where it was if
/// that is one leaf, else the root.
enum class From { root, home, siblings, automatic };

template <int D>
class QuadtreeTracker final : public core::IncrementalTracker<D> {
  using Base = core::IncrementalTracker<D>;
  using Nodes = QuadtreeNodes<D>;

 public:
  QuadtreeTracker(typename Base::Way way, From from, std::uint32_t capacity,
                  std::unique_ptr<PairFinder<D>> finder)
      : Base(way, worthwhile<D>, std::move(finder)), from_(from), tree_(capacity) {}

 private:
  static constexpr std::uint32_t bit(std::uint32_t mask, std::uint32_t child) { return mask >> child & 1U; }

  /// Which boxes of a mover are, or could touch something, in a node and below.
  struct Parts {
    std::uint32_t before;
    std::uint32_t now;
    std::uint32_t seen;
  };

  struct Look {
    std::uint32_t mover;
    std::uint32_t node;
  };

  /// A mover in a node; it stays there if the new box is in the node too.
  struct Filed {
    std::uint32_t node;
    std::uint32_t slot;
    std::uint32_t mover;
    std::uint32_t stays;
  };

  void follow(const Change<D>& change, PairSink& begun, PairSink& ended) override {
    take_movers(change);
    const std::size_t boxes = change.now.size();
    moved_since_build_ += movers_.size();
    if (change.rebuild || (tree_.is_degenerate() && moved_since_build_ > boxes)) {
      tree_.build(change.before);
      moved_since_build_ = 0;
    }
    tree_.resize(boxes);
    Candidates<D> candidates(change, begun, ended);
    std::uint64_t tests = 0;
    // Into an empty tree go some, then as many again as are in it, so that no leaf is long much too full: all
    // at once would be compared with each other.
    constexpr std::uint32_t first_few = 256;
    const auto count = static_cast<std::uint32_t>(movers_.size());
    std::uint32_t end = tree_.references() == 0 ? std::min(first_few, count) : count;
    for (std::uint32_t begin = 0; begin < end; begin = std::exchange(end, std::min(2 * end, count)))
      tests += take(begin, end, candidates, change);
    this->count(Statistics{.tests = tests, .references = tree_.references(), .cells = tree_.node_count()});
  }

  /// Takes some of the movers, by their numbers; how many boxes they were compared with.
  std::uint64_t take(std::uint32_t begin, std::uint32_t end, Candidates<D>& candidates,
                     const Change<D>& change) {
    filed_.clear();
    looks_.clear();
    above_.clear();
    for (std::uint32_t mover = begin; mover < end; ++mover) file(mover);
    look_all();

    const std::uint64_t tests = kernels::compare(
        tree_.packs().view(), std::span<const kernels::MovingBox<D>>(movers_), tasks_, candidates);
    candidates.flush();

    for (const Filed& filed : filed_) {
      if (filed.stays != 0) {
        tree_.packs().set(filed.slot, movers_[filed.mover].now);
        tree_.packs().unmark(filed.slot);
      } else {
        tree_.erase(filed.node, filed.slot);
      }
    }
    tree_.tidy(change.now);
    return tests;
  }

  void take_movers(const Change<D>& change) {
    movers_.clear();
    for (const BoxId id : change.changed) {
      const Box<D>& before = change.before[index(id)];
      const Box<D>& now = change.now[index(id)];
      const bool refiltered =
          !change.filters_now.empty() && change.filters_before[index(id)] != change.filters_now[index(id)];
      if (before == now && !refiltered) continue;
      const bool was = is_present(before);
      const bool is = is_present(now);
      if (!was && !is) continue;
      Box<D> both = absent_box<D>();
      for (int axis = 0; axis < D; ++axis) {
        both.min[axis] = std::min(before.min[axis], now.min[axis]);
        both.max[axis] = std::max(before.max[axis], now.max[axis]);
      }
      movers_.push_back({was ? before : kernels::nowhere<D>(), is ? now : kernels::nowhere<D>(), both,
                         index(id), static_cast<std::uint32_t>(refiltered)});
    }
  }

  /// Files a mover wherever it is not yet, and notes which nodes to look at.
  void file(std::uint32_t number) {
    const kernels::MovingBox<D>& mover = movers_[number];
    const bool was = is_present(mover.before);
    const bool is = is_present(mover.now);
    home_ = tree_.home(mover.id);
    std::uint32_t from = Nodes::root;
    if (was && from_ != From::root) {
      from = home_.node;
      if (home_.several == 0 && (!is || tree_[from].contains(mover.now))) {
        above_.push_back({number, from});
        note(number, from, home_.slot, is);
        looks_.push_back({number, from});
        return;
      }
      if (from_ == From::siblings && is && carry(number)) return;
      const auto holds = [&](std::uint32_t node) {
        return tree_[node].contains(mover.before) && (!is || tree_[node].contains(mover.now));
      };
      if (home_.several != 0 && from_ == From::automatic) from = Nodes::root;
      while (from != Nodes::root && !holds(from)) from = tree_[from].parent;
    }
    above_.push_back({number, from});
    places_ = 0;
    visit(number, from, {was, is, 0});
    if (!is)
      tree_.home(mover.id) = {};
    else if (places_ > 1)
      tree_.home(mover.id).several = 1;
  }

  /// Files a mover from leaf to leaf. False if it has been left as it was: not all of its nodes are leaves.
  bool carry(std::uint32_t number) {
    const kernels::MovingBox<D>& mover = movers_[number];
    if (!siblings_.carry(tree_, home_.node, mover.before, mover.now)) return false;
    places_ = 0;
    for (const auto& reference : siblings_.references()) {
      place(number, reference.node, {reference.was, reference.is, 0});
      looks_.push_back({number, reference.node});
      above_.push_back({number, reference.node});
    }
    tree_.home(mover.id).several = places_ > 1 ? 1 : 0;
    return true;
  }

  /// Goes down from a node to all in which the mover is or will be, and where something may be near it.
  void visit(std::uint32_t number, std::uint32_t at, const Parts& parts) {
    const QuadtreeNode<D>& node = tree_[at];
    const kernels::MovingBox<D>& mover = movers_[number];
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
    const std::uint32_t seen = kept_before || kept_now || parts.seen != 0 ? node.touched(mover.both) : 0;
    if (kept_before) before = 0;
    if (kept_now) now = 0;
    const std::uint32_t children = node.children;
    for (std::uint32_t rest = before | now | seen; rest != 0; rest &= rest - 1) {
      const auto child = static_cast<std::uint32_t>(std::countr_zero(rest));
      visit(number, children + child, {bit(before, child), bit(now, child), bit(seen, child)});
    }
  }

  /// Sees to it that a mover is in a node.
  void place(std::uint32_t number, std::uint32_t node, const Parts& parts) {
    const kernels::MovingBox<D>& mover = movers_[number];
    const BoxId id{mover.id};
    std::uint32_t slot;
    if (parts.before == 0)
      slot = tree_.insert(node, mover.both, id);
    else if (home_.node == node)
      slot = home_.slot;
    else
      slot = tree_.find(node, id);
    note(number, node, slot, parts.now != 0);
    if (parts.now != 0 && places_++ == 0)
      tree_.home(mover.id) = {node, slot & 0x7fffffffU, !tree_[node].is_leaf()};
  }

  void note(std::uint32_t number, std::uint32_t node, std::uint32_t slot, bool stays) {
    tree_.packs().set(slot, movers_[number].both);
    tree_.packs().mark(slot);
    filed_.push_back({node, slot, number, stays});
  }

  /// Makes tasks of all that is to be looked at: now that every mover is filed, else one would not see
  /// another that is filed after it.
  void look_all() {
    tasks_.clear();
    const auto look = [this](std::uint32_t mover, std::uint32_t node) {
      if (tree_[node].pack != kernels::no_pack) tasks_.push_back({mover, tree_[node].pack});
    };
    for (const Look& at : looks_) look(at.mover, at.node);
    if (tree_.kept() == 0) return;
    // Boxes that stay in the nodes above may touch anything below. Ways up from several leaves join.
    for (std::size_t i = 0; i < above_.size(); ++i) {
      const Look& below = above_[i];
      if (from_ == From::siblings && (i == 0 || above_[i - 1].mover != below.mover)) siblings_.start(tree_);
      for (std::uint32_t at = tree_[below.node].parent; at != no_node; at = tree_[at].parent) {
        if (from_ == From::siblings && !siblings_.meet(at)) break;
        look(below.mover, at);
      }
    }
  }

  std::size_t structure_bytes() const noexcept override {
    return tree_.bytes() + movers_.capacity() * sizeof(kernels::MovingBox<D>) +
           filed_.capacity() * sizeof(Filed) + (looks_.capacity() + above_.capacity()) * sizeof(Look) +
           tasks_.capacity() * sizeof(kernels::PackTask) + siblings_.bytes();
  }

  From from_;
  QuadtreeNodes<D> tree_;
  QuadtreeSiblings<D> siblings_;
  std::size_t moved_since_build_ = 0;
  std::vector<kernels::MovingBox<D>> movers_;
  std::vector<Filed> filed_;
  std::vector<Look> looks_;
  std::vector<Look> above_;  // for each mover the uppermost nodes it has looked at
  std::vector<kernels::PackTask> tasks_;

  // The mover that is being filed: where it was at home, and in how many nodes it stays.
  QuadtreeHome home_;
  std::uint32_t places_ = 0;
};

}  // namespace

Tunable quadtree_update() {
  return {.name = "update",
          .summary =
              "for tracking only: file a mover anew from the root, or relative to where it was, by way "
              "of the parent that holds both places, or each leaf's reference by itself, across to siblings "
              "and cousins, or find all pairs anew",
          .standard = "auto",
          .type = Tunable::Type::choice,
          .choices = {"root", "relative", "siblings", "rebuild"}};
}

template <int D>
std::unique_ptr<PairTracker<D>> make_quadtree_tracker(const Settings& settings,
                                                      std::unique_ptr<PairFinder<D>> finder) {
  using Way = typename core::IncrementalTracker<D>::Way;
  const std::string& update = settings.text("update");
  const Way way = update == "auto" ? Way::choose : update == "rebuild" ? Way::rebuild : Way::follow;
  const From from = update == "root"       ? From::root
                    : update == "relative" ? From::home
                    : update == "siblings" ? From::siblings
                                           : From::automatic;
  const auto capacity = settings.is_auto("capacity")
                            ? tracking_capacity
                            : static_cast<std::uint32_t>(settings.integer("capacity"));
  return std::make_unique<QuadtreeTracker<D>>(way, from, capacity, std::move(finder));
}

template std::unique_ptr<PairTracker<2>> make_quadtree_tracker(const Settings&,
                                                               std::unique_ptr<PairFinder<2>>);
template std::unique_ptr<PairTracker<3>> make_quadtree_tracker(const Settings&,
                                                               std::unique_ptr<PairFinder<3>>);

}  // namespace broadside::own
