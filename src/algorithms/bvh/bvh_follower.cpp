// BvhFollower: boxes that moved are looked up in a dynamic bounding volume hierarchy and moved, and some that
// left the bounds of their leaf are inserted anew.
//
// Boxes move one after the other: each is compared with all others as these stand at its turn. So a pair of
// boxes that both moved may be seen to begin and to end again; only such pairs are tested twice. When the
// boxes that moved are compared with far more others than after the last build, the tree is built anew.
#include <algorithm>
#include <span>
#include <vector>

#include "algorithms/bvh/index.hpp"
#include "algorithms/event_sinks.hpp"
#include "algorithms/followers.hpp"
#include "core/grow.hpp"
#include "kernels/bvh.hpp"

namespace broadside::algorithm {
namespace {

/// Of the boxes that leave the bounds of their leaf, one in this many is reinserted; for the others the
/// bounds grow. Of 1, 2, 4, 8, 16 and 32, the greater were the faster for 20,000 drifting boxes (2D and 3D, 1
/// to 25 % moving: 1 took some 1.3 times as long as 8), but they leave more to the next build.
constexpr std::uint64_t departures_per_insertion = 8;

/// Boxes that must have moved before their tests are judged.
constexpr std::uint64_t movers_to_judge = 512;

/// Boxes that are moved in one call of the kernel, so that they stay in the cache.
constexpr std::size_t moves_at_once = 2048;

/// Takes the pairs that begin, or end, at one box's turn. Where the change wants candidates, all are written
/// to `begun` as they are found.
template <int D>
class ToggleSink final : public PairSink {
 public:
  ToggleSink(const Change<D>& change, bool begins, PairSink& begun, PairSink& ended)
      : change_(change),
        is_exact_(change.filters_now.empty()),
        begins_(begins),
        begun_(begun),
        ended_(ended) {}

 private:
  void consume(std::span<const Pair> pairs) override {
    if (change_.wants_candidates) return begun_.put(pairs);
    for (const Pair pair : pairs) {
      if (is_exact_ && (change_.flags[pair.first] & change_.flags[pair.second]) == 0)
        (begins_ ? begun_ : ended_).add(pair.first, pair.second);
      else
        change_.report(pair.first, pair.second, begun_, ended_);
    }
  }

  const Change<D>& change_;
  bool is_exact_;
  bool begins_;
  PairSink& begun_;
  PairSink& ended_;
};

template <int D>
class BvhFollower final : public Follower<D> {
 public:
  std::optional<Statistics> follow(const Change<D>& change, PairSink& begun, PairSink& ended) override {
    if (change.rebuild || needs_rebuild(change)) build(change);
    ToggleSink<D> begins(change, true, begun, ended);
    ToggleSink<D> ends(change, false, begun, ended);
    Checkpoint checkpoint(change.workers.checkpoint);
    std::uint64_t tests = 0;
    std::size_t movers = 0;
    for (std::size_t at = 0; at < change.changed.size(); at += moves_at_once) {
      moved_.clear();
      append_moved(change, change.changed.subspan(at, std::min(moves_at_once, change.changed.size() - at)),
                   moved_);
      if (moved_.empty()) continue;
      insert_arrivals();
      calls_for_.resize(std::max(calls_for_.size(), moved_.size()));
      kernels::WritableBvh<D> tree = tree_.writable();
      tree.checkpoint = &checkpoint;
      tests += kernels::follow(tree, std::span<const kernels::MovedBox<D>>(moved_), calls_for_.data(), begins,
                               ends);
      movers += moved_.size();
      mend();
    }
    begins.flush();
    ends.flush();
    judge(tests, movers);
    // The state's own filters, which stay until the next frame.
    tree_index_.take_filters(change.filters_now);
    return Statistics{.tests = tests, .references = tree_.size(), .cells = tree_.nodes()};
  }

  const BoxIndex<D, float>* box_index() const noexcept override { return &index_; }

  std::size_t bytes() const noexcept override {
    return index_.bytes() + core::bytes_of(packed_, moved_, calls_for_);
  }

 private:
  /// Builds the tree anew from the boxes as they were, with new ones where they are now.
  void build(const Change<D>& change) {
    packed_.assign(change.before.begin(), change.before.end());
    for (const BoxId id : change.changed) {
      if (!is_present(packed_[id])) packed_[id] = change.now[id];
    }
    tree_.build(packed_, change.workers);
    judged_tests_ = judged_movers_ = usual_tests_ = usual_movers_ = moves_ = 0;
    is_worse_ = false;
  }

  /// New boxes are inserted where they are now, and then count as moved there.
  void insert_arrivals() {
    for (const kernels::MovedBox<D>& box : moved_) {
      if (!box.was_present && tree_.slot(box.id) == kernels::no_slot) tree_.insert(box.id, box.now);
    }
    for (kernels::MovedBox<D>& box : moved_) box.slot = tree_.slot(box.id);
  }

  /// After boxes moved: removes boxes that went, refits bounds, and reinserts all boxes that jumped and some
  /// of those that left their leaves. Removals come first: no other step may meet a lane without a box among
  /// a node's children.
  void mend() {
    for (const kernels::MovedBox<D>& box : moved_) {
      if (!box.is_present) tree_.remove(box.id);
    }
    for (std::size_t i = 0; i < moved_.size(); ++i) {
      if (!moved_[i].is_present) continue;
      const bool left = (calls_for_[i] & kernels::left_leaf) != 0;
      if (left && (!overlap(moved_[i].before, moved_[i].now) || ++departures_ % departures_per_insertion == 0))
        tree_.reinsert(moved_[i].id);
      else if (calls_for_[i] != 0)
        tree_.refit(moved_[i].id);
    }
  }

  /// Compares the tests a mover takes now with those it took after the last build.
  void judge(std::uint64_t tests, std::size_t movers) {
    moves_ += movers;
    judged_tests_ += tests;
    judged_movers_ += movers;
    if (judged_movers_ < movers_to_judge) return;
    if (usual_movers_ == 0) {
      usual_tests_ = judged_tests_;
      usual_movers_ = judged_movers_;
    }
    is_worse_ = judged_tests_ * usual_movers_ * 2 > 3 * usual_tests_ * judged_movers_;
    judged_tests_ = judged_movers_ = 0;
  }

  /// Whether a build pays: many boxes come; or, once as many have moved as there are, searches visit too many
  /// leaves or most lanes are empty.
  bool needs_rebuild(const Change<D>& change) const {
    std::size_t arrivals = 0;
    for (const BoxId id : change.changed)
      arrivals += static_cast<std::size_t>(is_present(change.now[id]) && !is_present(change.before[id]));
    if (arrivals > tree_.size() / 4 + 16) return true;
    return moves_ >= tree_.size() &&
           (is_worse_ || tree_.nodes() * kernels::fan_out > 4 * tree_.size() + 4096);
  }

  BoxIndex<D> index_;  // answers queries by tree_
  BvhIndex<D, float>& tree_index_ = BvhIndex<D, float>::of(index_);
  DynamicBvh<D>& tree_ = tree_index_.tree();
  std::vector<Box<D>> packed_;
  std::vector<kernels::MovedBox<D>> moved_;
  std::vector<std::uint8_t> calls_for_;  // of moved_: bits of follow()

  std::uint64_t judged_tests_ = 0;
  std::uint64_t judged_movers_ = 0;
  std::uint64_t usual_tests_ = 0;   // counted right after the last build ...
  std::uint64_t usual_movers_ = 0;  // ... for this many movers
  std::size_t moves_ = 0;           // since then
  bool is_worse_ = false;
  std::uint64_t departures_ = 0;  // of boxes from their leaf, without a jump
};

}  // namespace

template <int D>
std::unique_ptr<Follower<D>> make_bvh_follower(const Settings&) {
  return std::make_unique<BvhFollower<D>>();
}

template std::unique_ptr<Follower<2>> make_bvh_follower(const Settings&);
template std::unique_ptr<Follower<3>> make_bvh_follower(const Settings&);

}  // namespace broadside::algorithm
