// A bounding volume hierarchy that stays from frame to frame: movers are looked up in it, moved, and put
// into better leaves.
//
// Four ways from today's engines. Refit: a box keeps its leaf, whose bounds follow it. Enlarge (Bullet,
// Box2D): what stands in a leaf is wider than the box by a margin, and nothing is done while the box stays
// within it. Reinsertion: a box that leaves its leaf's bounds goes to the leaf that has to grow least, at
// most so many a frame (Bepu's bounded refinement); who must wait is the debt. And when movers meet far more
// leaves than after the last packing, the tree is packed anew.
//
// Boxes move one after the other: each is compared with all others as these stand at its turn. So a pair of
// movers may be seen to begin and to end again; only such pairs are looked at twice.
#include "algorithms/bvh/tracker.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "broadside/broad_phase.hpp"

#include "algorithms/bvh/kept.hpp"
#include "interface/encloses.hpp"
#include "interface/incremental_tracker.hpp"
#include "kernels/kept_tree.hpp"
#include "kernels/nowhere.hpp"

namespace broadside::own {
namespace {

/// The fraction of changed boxes from which finding all pairs anew is not slower.
template <int D>
constexpr double worthwhile = D == 2 ? 0.3 : 0.25;

/// The margin on each side, in extents of the box, where none is given.
constexpr float standard_margin = 0.25F;

/// So many movers say how many leaves one meets.
constexpr std::uint64_t movers_to_judge = 512;

/// A frame's steps are taken in pieces of so many, which stay in the cache.
constexpr std::size_t steps_at_once = 2048;

/// What leaves do while boxes move: they only follow, hold wider boxes, or let boxes go.
enum class Leaves { follow, widen, exchange };

/// Takes pairs that begin, or end, as they stand at one mover's turn.
template <int D>
class Toggled final : public PairSink {
 public:
  Toggled(const Change<D>& change, bool exact, bool begins, PairSink& begun, PairSink& ended)
      : change_(change),
        exact_(exact && change.filters_now.empty()),
        begins_(begins),
        begun_(begun),
        ended_(ended) {}

 private:
  void consume(std::span<const Pair> pairs) override {
    for (const Pair pair : pairs) {
      if (exact_ && (change_.flags[index(pair.first)] & change_.flags[index(pair.second)]) == 0)
        (begins_ ? begun_ : ended_).add(pair.first, pair.second);
      else
        change_.report(pair.first, pair.second, begun_, ended_);
    }
  }

  const Change<D>& change_;
  bool exact_;
  bool begins_;
  PairSink& begun_;
  PairSink& ended_;
};

template <int D>
class BvhTracker final : public core::IncrementalTracker<D> {
  using Base = core::IncrementalTracker<D>;
  using Step = kernels::KeptStep<D>;

 public:
  BvhTracker(typename Base::Way way, Leaves leaves, std::optional<float> margin, std::size_t budget,
             std::unique_ptr<PairFinder<D>> finder)
      : Base(way, worthwhile<D>, std::move(finder)), leaves_(leaves), margin_(margin), budget_(budget) {}

 private:
  void follow(const Change<D>& change, PairSink& begun, PairSink& ended) override {
    const std::size_t boxes = change.now.size();
    if (change.rebuild || is_worn() || arrivals(change) > spare_) start(change);
    tree_.resize(boxes);
    is_waiting_.resize(boxes, 0);

    const bool exact = leaves_ != Leaves::widen;
    Toggled<D> begins(change, exact, true, begun, ended);
    Toggled<D> ends(change, exact, false, begun, ended);
    std::uint64_t tests = 0;
    std::size_t movers = 0;
    for (std::size_t at = 0; at < change.changed.size(); at += steps_at_once) {
      take(change, change.changed.subspan(at, std::min(steps_at_once, change.changed.size() - at)));
      if (steps_.empty()) continue;
      left_.resize(std::max(left_.size(), steps_.size()));
      const kernels::Followed done =
          kernels::follow(tree_.tree(), std::span<const Step>(steps_), left_.data(), begins, ends);
      tests += done.tests;
      movers += steps_.size();
      settle(change, done.left);
    }
    begins.flush();
    ends.flush();
    reinsert(change);
    tree_.refit();
    judge(tests, movers);
    this->count(Statistics{.tests = tests,
                           .references = tree_.boxes(),
                           .cells = tree_.nodes(),
                           .debt = waiting_.size() - waited_});
  }

  /// Packs the tree anew, of boxes as they were; those that come have their places already.
  void start(const Change<D>& change) {
    packed_.assign(change.before.begin(), change.before.end());
    for (const BoxId id : change.changed) {
      if (!is_present(packed_[index(id)])) packed_[index(id)] = change.now[index(id)];
    }
    tree_.build(packed_, [this](const Box<D>& box) { return stored(box); });
    spare_ = tree_.boxes() / 8 + 16;
    is_waiting_.assign(change.now.size(), 0);
    waiting_.clear();
    waited_ = 0;
    judged_tests_ = judged_movers_ = usual_tests_ = usual_movers_ = moved_ = 0;
  }

  /// How many boxes come, if they are more than a few.
  std::size_t arrivals(const Change<D>& change) const {
    std::size_t count = 0;
    for (const BoxId id : change.changed)
      count += static_cast<std::size_t>(is_present(change.now[index(id)]) &&
                                        !is_present(change.before[index(id)]));
    return count;
  }

  /// What stands in a leaf for a box.
  Box<D> stored(const Box<D>& box) const {
    if (leaves_ != Leaves::widen || !is_present(box)) return box;
    Box<D> wide = box;
    for (int axis = 0; axis < D; ++axis) {
      const float margin = margin_ ? *margin_ : (box.max[axis] - box.min[axis]) * standard_margin;
      if (!(margin <= std::numeric_limits<float>::max())) continue;
      // What is infinite stays so.
      wide.min[axis] = std::min(box.min[axis], box.min[axis] - margin);
      wide.max[axis] = std::max(box.max[axis], box.max[axis] + margin);
    }
    return wide;
  }

  /// Makes steps of changed boxes, and lets those in that come.
  void take(const Change<D>& change, std::span<const BoxId> ids) {
    steps_.clear();
    for (const BoxId id : ids) {
      const Box<D>& before = change.before[index(id)];
      const Box<D>& now = change.now[index(id)];
      const bool refiltered = Base::is_refiltered(change, id);
      if (before == now && !refiltered) continue;
      const bool was = is_present(before);
      const bool is = is_present(now);
      if (!was && !is) continue;
      Step step;
      step.before = was ? before : kernels::nowhere<D>();
      step.now = is ? now : kernels::nowhere<D>();
      step.id = index(id);
      step.every = refiltered || leaves_ == Leaves::widen;
      step.is_far = !was || !is || !overlap(before, now);
      if (is && tree_.place(id) == BvhKept<D>::nowhere) {
        tree_.insert(id, stored(now));
        --spare_;
      }
      step.place = tree_.place(id);
      step.stored = is ? now : absent_box<D>();
      step.writes = true;
      if (leaves_ == Leaves::widen && is) {
        step.stored = tree_.at(step.place);
        step.writes = !core::encloses(step.stored, now);
        if (step.writes) step.stored = stored(now);
      }
      steps_.push_back(step);
    }
  }

  /// After steps: takes out boxes that went, and notes which boxes left their leaves.
  void settle(const Change<D>& change, std::size_t left) {
    for (const Step& step : steps_) {
      if (step.writes) tree_.touch(step.place);
      if (is_present(change.now[step.id])) continue;
      tree_.remove(BoxId(step.id));
      ++spare_;
    }
    if (leaves_ == Leaves::follow) return;
    for (std::size_t i = 0; i < left; ++i) {
      const std::uint32_t id = steps_[left_[i]].id;
      if (std::exchange(is_waiting_[id], std::uint8_t{1}) == 0) waiting_.push_back(id);
    }
  }

  /// Puts boxes that wait into better leaves, as many as there is a budget for.
  void reinsert(const Change<D>& change) {
    const std::size_t end = waited_ + std::min(budget_, waiting_.size() - waited_);
    for (; waited_ < end; ++waited_) {
      const BoxId id{waiting_[waited_]};
      if (index(id) >= change.now.size()) continue;
      is_waiting_[index(id)] = 0;
      if (tree_.place(id) == BvhKept<D>::nowhere) continue;
      const Box<D> box = tree_.at(tree_.place(id));
      tree_.remove(id);
      tree_.insert(id, box);
    }
    if (2 * waited_ >= waiting_.size()) {
      waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(waited_));
      waited_ = 0;
    }
  }

  /// Compares how many boxes movers are compared with now, and were after the tree was packed.
  void judge(std::uint64_t tests, std::size_t movers) {
    moved_ += movers;
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

  /// Whether packing the tree anew pays: it meets too many leaves, or has far more room than boxes. Not
  /// before as many boxes have moved as there are.
  bool is_worn() const {
    if (moved_ < tree_.boxes()) return false;
    return (is_worse_ && leaves_ != Leaves::follow) || tree_.places() > 4 * tree_.boxes() + 4096;
  }

  std::size_t structure_bytes() const noexcept override {
    return tree_.bytes() + steps_.capacity() * sizeof(Step) + packed_.capacity() * sizeof(Box<D>) +
           (left_.capacity() + waiting_.capacity()) * sizeof(std::uint32_t) + is_waiting_.capacity();
  }

  Leaves leaves_;
  std::optional<float> margin_;
  std::size_t budget_;

  BvhKept<D> tree_;
  std::size_t spare_ = 0;  // boxes that may come before the tree is packed anew
  std::vector<Box<D>> packed_;
  std::vector<Step> steps_;
  std::vector<std::uint32_t> left_;

  std::vector<std::uint32_t> waiting_;  // for a better leaf, from waited_ on
  std::size_t waited_ = 0;
  std::vector<std::uint8_t> is_waiting_;

  std::uint64_t judged_tests_ = 0;
  std::uint64_t judged_movers_ = 0;
  std::uint64_t usual_tests_ = 0;  // and of how many movers, after the tree was packed
  std::uint64_t usual_movers_ = 0;
  std::size_t moved_ = 0;
  bool is_worse_ = false;
};

}  // namespace

std::vector<Tunable> bvh_tracking() {
  return {
      {.name = "update",
       .summary = "for tracking only: leaves only follow their boxes, or hold boxes with a margin, or "
                  "boxes that leave go to better leaves; or all pairs are found anew",
       .standard = "auto",
       .type = Tunable::Type::choice,
       .choices = {"refit", "enlarge", "reinsert", "rebuild"}},
      {.name = "margin",
       .summary = "for update=enlarge: on each side of a box, in the boxes' unit; a quarter of its extent",
       .standard = "auto",
       .least = 0},
      {.name = "budget",
       .summary = "for tracking only: the most boxes put into better leaves in a frame; as many as left "
                  "theirs",
       .standard = "auto",
       .type = Tunable::Type::integer,
       .least = 0,
       .most = 1 << 30}};
}

template <int D>
std::unique_ptr<PairTracker<D>> make_bvh_tracker(const Settings& settings,
                                                 std::unique_ptr<PairFinder<D>> finder) {
  using Way = typename core::IncrementalTracker<D>::Way;
  const std::string& update = settings.text("update");
  const Way way = update == "auto" ? Way::choose : update == "rebuild" ? Way::rebuild : Way::follow;
  const Leaves leaves = update == "refit"     ? Leaves::follow
                        : update == "enlarge" ? Leaves::widen
                                              : Leaves::exchange;
  std::optional<float> margin;
  if (!settings.is_auto("margin")) margin = static_cast<float>(settings.number("margin"));
  std::size_t budget = std::numeric_limits<std::size_t>::max();
  if (!settings.is_auto("budget")) budget = static_cast<std::size_t>(settings.integer("budget"));
  return std::make_unique<BvhTracker<D>>(way, leaves, margin, budget, std::move(finder));
}

template std::unique_ptr<PairTracker<2>> make_bvh_tracker(const Settings&, std::unique_ptr<PairFinder<2>>);
template std::unique_ptr<PairTracker<3>> make_bvh_tracker(const Settings&, std::unique_ptr<PairFinder<3>>);

}  // namespace broadside::own
