// SweepAndPruneFollower: keeps boxes sorted along an axis, and moves movers within the order.
//
// Section VI-C of the paper, in its fastest variant: a mover is compared with the boxes that touch its old or
// its new box on the axis, and then moved to its new place, found by binary search. Only the boxes between
// the two places shift.
#include <algorithm>
#include <array>
#include <vector>

#include "algorithms/event_sinks.hpp"
#include "algorithms/followers.hpp"
#include "algorithms/sweep_and_prune/sweep_order.hpp"
#include "core/sample.hpp"
#include "core/sorted_boxes.hpp"

namespace broadside::algorithm {
namespace {

/// After this many tests, plus this many per box, another look at the axes pays.
constexpr std::uint64_t tests_between_looks = 1'000'000;
constexpr std::uint64_t tests_of_a_box_between_looks = 64;

template <int D>
class SweepAndPruneFollower final : public Follower<D> {
 public:
  explicit SweepAndPruneFollower(const Settings& settings) : axis_(axis_of(settings)) {}

  std::optional<Statistics> follow(const Change<D>& change, PairSink& begun, PairSink& ended) override {
    if (change.rebuild || has_better_axis_) start(change);
    moved_.clear();
    append_moved(change, change.changed, moved_);
    EventSinks<D> events(change, begun, ended);
    Checkpoint checkpoint(change.workers.checkpoint);
    std::uint64_t tests = 0;
    bool comes_or_goes = false;
    for (core::MovedBox<D>& box : moved_) {
      box.before = turned(box.before);
      box.now = turned(box.now);
      comes_or_goes |= !box.was_present || !box.is_present;
      if (!box.was_present) continue;
      const std::size_t place = order_.find({box.before.min[0], box.id});
      const std::uint64_t compared = order_.find_changes(box, place, events.sinks());
      tests += compared;
      std::size_t moved = 0;
      if (box.is_present)
        moved = order_.move(place, box.now);
      else
        order_.remove(place);
      checkpoint.count(compared + moved);
    }
    if (comes_or_goes) merge(change);
    for (const core::MovedBox<D>& box : moved_) {
      if (box.was_present) continue;
      const std::uint64_t compared =
          order_.find_changes(box, order_.find({box.now.min[0], box.id}), events.sinks());
      tests += compared;
      checkpoint.count(compared);
    }
    events.flush();
    compare_axes(change, tests);
    return Statistics{.tests = tests, .references = order_.size(), .hits = events.candidates()};
  }

  std::size_t bytes() const noexcept override {
    return order_.bytes() + core::bytes_of(moved_, entries_, merged_, coming_);
  }

 private:
  Box<D> turned(const Box<D>& box) const { return core::turned(box, axes_); }

  /// Removes departed boxes from the order and merges arrivals into it.
  void merge(const Change<D>& change) {
    entries_.clear();
    coming_.clear();
    for (const core::MovedBox<D>& box : moved_) {
      if (!box.was_present) coming_.push_back({{box.now.min[0], box.id}, SweepEntry::is_new});
    }
    for (std::size_t place = 0; place < order_.size(); ++place) {
      const SweepKey key = order_.key(place);
      if (is_present(change.now[index(key.id)])) entries_.push_back({key, static_cast<std::uint32_t>(place)});
    }
    std::sort(coming_.begin(), coming_.end());
    merged_.resize(entries_.size() + coming_.size());
    std::merge(entries_.begin(), entries_.end(), coming_.begin(), coming_.end(), merged_.begin());
    assign(merged_, change.now);
  }

  void assign(std::span<const SweepEntry> entries, std::span<const Box<D>> boxes) {
    order_.assign(entries, [&](BoxId id) { return turned(boxes[index(id)]); });
  }

  void start(const Change<D>& change) {
    sample(change);
    axes_ = sample_.axes_from(axis_);
    entries_.clear();
    for (std::size_t i = 0; i < change.before.size(); ++i) {
      if (is_present(change.before[i]))
        entries_.push_back({{turned(change.before[i]).min[0], BoxId(i)}, SweepEntry::is_new});
    }
    std::sort(entries_.begin(), entries_.end());
    assign(entries_, change.before);
    has_better_axis_ = false;
    tests_ = 0;
  }

  /// Samples a few of the present boxes.
  void sample(const Change<D>& change) {
    sampled_.clear();
    core::for_present_sample(change.now, 256, [this](const Box<D>& box) { sampled_.push_back(box); });
    sample_.take(sampled_);
  }

  /// From time to time, once enough tests pay for it, checks whether another axis has become much better.
  void compare_axes(const Change<D>& change, std::uint64_t tests) {
    tests_ += tests;
    if (axis_ >= 0 || tests_ < tests_of_a_box_between_looks * order_.size() + tests_between_looks) return;
    tests_ = 0;
    sample(change);
    has_better_axis_ = 2 * sample_[sample_.axes_by_overlap()[0]].overlap < sample_[axes_[0]].overlap;
  }

  int axis_;  // -1: to be chosen

  std::array<int, D> axes_{};
  SweepOrder<D> order_;
  std::vector<core::MovedBox<D>> moved_;
  std::vector<SweepEntry> entries_;
  std::vector<SweepEntry> merged_;
  std::vector<SweepEntry> coming_;
  core::Sample<D> sample_;
  std::vector<Box<D>> sampled_;
  bool has_better_axis_ = false;
  std::uint64_t tests_ = 0;  // since the last look at the axes
};

}  // namespace

int axis_of(const Settings& settings) {
  return settings.is_auto("axis") ? -1 : settings.text("axis")[0] - 'x';
}

template <int D>
std::unique_ptr<Follower<D>> make_sweep_and_prune_follower(const Settings& settings) {
  return std::make_unique<SweepAndPruneFollower<D>>(settings);
}

template std::unique_ptr<Follower<2>> make_sweep_and_prune_follower(const Settings&);
template std::unique_ptr<Follower<3>> make_sweep_and_prune_follower(const Settings&);

}  // namespace broadside::algorithm
