// BvhFollower: moves boxes in a dynamic bounding volume hierarchy and finds the pairs that begin or end. Some
// boxes that leave the bounds of their leaf are reinserted.
//
// Boxes move one after the other: each is compared with all others as they are at its turn. So a pair of two
// movers may seem to begin and to end again; only such pairs are tested twice. When movers take far more
// tests than after the last build, the tree is built anew.
#include <algorithm>
#include <span>
#include <vector>

#include "algorithms/bvh/bvh_index.hpp"
#include "algorithms/event_sinks.hpp"
#include "algorithms/followers.hpp"
#include "core/grow.hpp"
#include "kernels/bvh.hpp"

namespace broadside::algorithm {
namespace {

/// One in this many boxes that leave the bounds of their leaf is reinserted; for the others the bounds grow.
/// Of 1, 2, 4, 8, 16 and 32, greater values were faster for 20,000 drifting boxes (2D and 3D, 1 to 25 %
/// moving: 1 took about 1.3 times as long as 8), but they leave more to the next build.
constexpr std::uint64_t departures_per_insertion = 8;

/// The number of movers to count before their tests are judged.
constexpr std::uint64_t movers_to_judge = 512;

/// The number of boxes per call of the kernel: few enough to stay in the cache.
constexpr std::size_t moves_at_once = 2048;

/// Takes the pairs that begin (if `begins`) or end at one box's turn. If `change.wants_candidates`, writes
/// them all to `begun` untested.
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
      if (tests > change.max_tests) break;
      mend();
    }
    begins.flush();
    ends.flush();
    judge(tests, movers);
    // The tracker keeps these filters until the next frame.
    tree_index_.take_filters(change.filters_now);
    return Statistics{.tests = tests, .references = tree_.size(), .cells = tree_.nodes()};
  }

  const BoxIndex<D, float>* box_index() const noexcept override { return &index_; }

  std::size_t bytes() const noexcept override {
    return index_.bytes() + core::bytes_of(packed_, moved_, calls_for_);
  }

 private:
  /// Builds the tree anew from the boxes as they were, and arrivals as they are now.
  void build(const Change<D>& change) {
    packed_.assign(change.before.begin(), change.before.end());
    for (const BoxId id : change.changed) {
      if (!is_present(packed_[id])) packed_[id] = change.now[id];
    }
    tree_.build(packed_, change.workers);
    judged_tests_ = judged_movers_ = usual_tests_ = usual_movers_ = moves_ = 0;
    is_worse_ = false;
  }

  /// Inserts arrivals where they are now; they count as moved there. Sets the slots of all movers.
  void insert_arrivals() {
    for (const kernels::MovedBox<D>& box : moved_) {
      if (!box.was_present && tree_.slot(box.id) == kernels::no_slot) tree_.insert(box.id, box.now);
    }
    for (kernels::MovedBox<D>& box : moved_) box.slot = tree_.slot(box.id);
  }

  /// After boxes moved: removes departed boxes, refits bounds, and reinserts all boxes that jumped and some
  /// boxes that left their leaves. Removals come first, since no other step may meet an empty lane among a
  /// node's children.
  void mend() {
    for (const kernels::MovedBox<D>& box : moved_) {
      if (!box.is_present) tree_.remove(box.id);
    }
    for (std::size_t i = 0; i < moved_.size(); ++i) {
      if (!moved_[i].is_present) continue;
      const bool left = (calls_for_[i] & kernels::left_leaf) != 0;
      if (left &&
          (!overlap(moved_[i].before, moved_[i].now) || ++departures_ % departures_per_insertion == 0))
        tree_.reinsert(moved_[i].id);
      else if (calls_for_[i] != 0)
        tree_.refit(moved_[i].id);
    }
  }

  /// Compares the tests per mover now with the tests per mover after the last build.
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

  /// Whether a build pays: many boxes arrive; or as many have moved as there are, and movers take too many
  /// tests or most lanes are empty.
  bool needs_rebuild(const Change<D>& change) const {
    std::size_t arrivals = 0;
    for (const BoxId id : change.changed)
      arrivals += static_cast<std::size_t>(is_present(change.now[id]) && !is_present(change.before[id]));
    if (arrivals > tree_.size() / 4 + 16) return true;
    return moves_ >= tree_.size() &&
           (is_worse_ || tree_.nodes() * kernels::fan_out > 4 * tree_.size() + 4096);
  }

  BoxIndex<D> index_;  // answers queries from tree_
  BvhIndex<D, float>& tree_index_ = BvhIndex<D, float>::of(index_);
  DynamicBvh<D>& tree_ = tree_index_.tree();
  std::vector<Box<D>> packed_;
  std::vector<kernels::MovedBox<D>> moved_;
  std::vector<std::uint8_t> calls_for_;  // for each of moved_: bits set by follow()

  std::uint64_t judged_tests_ = 0;
  std::uint64_t judged_movers_ = 0;
  std::uint64_t usual_tests_ = 0;   // right after the last build
  std::uint64_t usual_movers_ = 0;  // likewise
  std::size_t moves_ = 0;           // since the last build
  bool is_worse_ = false;
  std::uint64_t departures_ = 0;  // boxes that left their leaf without a jump
};

}  // namespace

template <int D>
std::unique_ptr<Follower<D>> make_bvh_follower(const Settings&) {
  return std::make_unique<BvhFollower<D>>();
}

template std::unique_ptr<Follower<2>> make_bvh_follower(const Settings&);
template std::unique_ptr<Follower<3>> make_bvh_follower(const Settings&);

}  // namespace broadside::algorithm
