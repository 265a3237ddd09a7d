// Sweep and prune, frame after frame: the boxes stay in order along an axis, and those that moved change
// places.
//
// Section VI-C of the paper. A mover is compared with the boxes that touch its old or its new box on the
// axis. The order is then mended: by an insertion sort, by taking the k movers out and merging them in again,
// or by a heap from which all are taken; these make the whole order anew. Or each mover is put into its new
// place by binary search as soon as it has been compared, and only the boxes between its two places make way.
#include "algorithms/sweep_and_prune/tracker.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

#include "algorithms/sweep_and_prune/order.hpp"
#include "core/sample.hpp"
#include "interface/incremental_tracker.hpp"

namespace broadside::own {
namespace {

enum class Mending { insertion, binary, merge, heap };

/// What a mover costs besides its comparisons, and what a search costs a box, in comparisons.
constexpr double mover_cost = 4000;
constexpr double search_cost = 500;

/// An insertion sort that takes more steps a box than this gives way to another sort: the order is lost.
constexpr std::size_t most_steps = 256;

template <int D>
class SweepAndPruneTracker final : public core::IncrementalTracker<D> {
  using Base = core::IncrementalTracker<D>;

 public:
  SweepAndPruneTracker(typename Base::Way way, Mending mending, int axis,
                       std::unique_ptr<PairFinder<D>> finder)
      : Base(way, search_cost / mover_cost, std::move(finder)), mending_(mending), axis_(axis) {}

 private:
  void follow(const Change<D>& change, PairSink& begun, PairSink& ended) override {
    if (change.rebuild || is_outgrown_) start(change);
    statistics_ = {};
    bool comes_or_goes = false;
    moved_.clear();
    for (const BoxId id : change.changed) {
      const Box<D>& before = change.before[index(id)];
      const Box<D>& now = change.now[index(id)];
      if (before == now && !Base::is_refiltered(change, id)) continue;
      comes_or_goes |= is_present(before) != is_present(now);
      if (!is_present(before)) continue;
      const kernels::Mover<D> mover = mover_at(change, id);
      const std::size_t place = order_.find(SweepKey{mover.before.min[0], id});
      compare(change, mover, place, order_, begun, ended);
      if (!is_present(now))
        order_.remove(place);
      else if (mending_ == Mending::binary)
        order_.move(place, mover.now);
      else
        moved_.push_back({{mover.now.min[0], id}, SweepEntry::is_new});
    }
    if (mending_ != Mending::binary || comes_or_goes) mend(change);
    compare_again(change, begun, ended);
    statistics_.references = order_.size();
    this->count(statistics_);
    look_at_axis(change);
  }

  kernels::Mover<D> mover_at(const Change<D>& change, BoxId id) const {
    return kernels::mover_of(turned(change.before[index(id)]), turned(change.now[index(id)]), id,
                             Base::is_refiltered(change, id));
  }

  /// Axes in the sweep's order.
  Box<D> turned(const Box<D>& box) const {
    Box<D> turned;
    for (int axis = 0; axis < D; ++axis) {
      turned.min[axis] = box.min[axes_[axis]];
      turned.max[axis] = box.max[axes_[axis]];
    }
    return turned;
  }

  void compare(const Change<D>& change, const kernels::Mover<D>& mover, std::size_t near,
               SweepOrder<D>& order, PairSink& begun, PairSink& ended) {
    statistics_.tests += order.find_toggles(mover, near, [&](const kernels::Toggle& toggle) {
      Base::report_toggle(change, mover.id, toggle.id, toggle.overlaps, begun, ended);
    });
  }

  /// The second half of the comparisons: where the order was mended after the first half, movers have not yet
  /// been compared as they are now; and what has come has not been compared at all.
  void compare_again(const Change<D>& change, PairSink& begun, PairSink& ended) {
    for (const BoxId id : change.changed) {
      if (is_present(change.before[index(id)]) || !is_present(change.now[index(id)])) continue;
      const kernels::Mover<D> mover = mover_at(change, id);
      compare(change, mover, order_.find(SweepKey{mover.now.min[0], id}), order_, begun, ended);
    }
    if (moved_.size() < 2) return;
    std::sort(moved_.begin(), moved_.end());
    movers_.assign(moved_, [&](BoxId id) { return turned(change.now[index(id)]); });
    for (std::size_t place = 0; place < moved_.size(); ++place)
      compare(change, mover_at(change, moved_[place].key.id), place, movers_, begun, ended);
  }

  /// Makes the order that of the boxes as they are now.
  void mend(const Change<D>& change) {
    entries_.clear();
    coming_.clear();
    for (const BoxId id : change.changed) {
      if (!is_present(change.now[index(id)])) continue;
      // For an insertion sort movers stand where they were.
      if (mending_ == Mending::insertion && is_present(change.before[index(id)])) continue;
      coming_.push_back({{turned(change.now[index(id)]).min[0], id}, SweepEntry::is_new});
    }
    for (std::size_t place = 0; place < order_.size(); ++place) {
      const SweepKey key = order_.key(place);
      if (change.flags[index(key.id)] == 0)
        entries_.push_back({key, static_cast<std::uint32_t>(place)});
      else if (mending_ == Mending::insertion && is_present(change.now[index(key.id)]))
        entries_.push_back({{turned(change.now[index(key.id)]).min[0], key.id}, SweepEntry::is_new});
    }
    if (mending_ == Mending::insertion) sort_by_insertion();
    std::sort(coming_.begin(), coming_.end());
    if (mending_ == Mending::heap) {
      entries_.insert(entries_.end(), coming_.begin(), coming_.end());
      take_from_heap();
    } else {
      merged_.resize(entries_.size() + coming_.size());
      std::merge(entries_.begin(), entries_.end(), coming_.begin(), coming_.end(), merged_.begin());
      std::swap(entries_, merged_);
    }
    assign(change.now);
  }

  void sort_by_insertion() {
    std::size_t steps = 0;
    for (std::size_t i = 1; i < entries_.size(); ++i) {
      const SweepEntry entry = entries_[i];
      std::size_t at = i;
      for (; at > 0 && entry < entries_[at - 1]; --at) entries_[at] = entries_[at - 1];
      entries_[at] = entry;
      steps += i - at;
      if (steps > most_steps * entries_.size()) {
        std::sort(entries_.begin(), entries_.end());
        return;
      }
    }
  }

  void take_from_heap() {
    const auto is_later = [](const SweepEntry& a, const SweepEntry& b) { return b < a; };
    std::make_heap(entries_.begin(), entries_.end(), is_later);
    merged_.clear();
    while (!entries_.empty()) {
      std::pop_heap(entries_.begin(), entries_.end(), is_later);
      merged_.push_back(entries_.back());
      entries_.pop_back();
    }
    std::swap(entries_, merged_);
  }

  void assign(std::span<const Box<D>> boxes) {
    order_.assign(entries_, [&](BoxId id) { return turned(boxes[index(id)]); });
  }

  void start(const Change<D>& change) {
    sample(change);
    axes_ = best_axes();
    entries_.clear();
    for (std::size_t i = 0; i < change.before.size(); ++i) {
      if (is_present(change.before[i]))
        entries_.push_back({{turned(change.before[i]).min[0], BoxId(i)}, SweepEntry::is_new});
    }
    std::sort(entries_.begin(), entries_.end());
    assign(change.before);
    is_outgrown_ = false;
    tests_ = 0;
    const double tests = 1.5 * sample_[axes_[0]].overlap * static_cast<double>(count_);
    this->set_worthwhile(search_cost / (mover_cost + tests));
  }

  void sample(const Change<D>& change) { count_ = this->take_sample(change.now, sample_, sampled_); }

  std::array<int, D> best_axes() const {
    std::array<int, D> axes = sample_.axes_by_overlap();
    for (int i = D - 1; i > 0; --i) {
      if (axes[i] == axis_) std::swap(axes[i], axes[i - 1]);  // the chosen one to the front
    }
    return axes;
  }

  /// Now and then, after work that pays for it: whether another axis would be much better by now.
  void look_at_axis(const Change<D>& change) {
    tests_ += statistics_.tests;
    if (axis_ >= 0 || tests_ < 64 * order_.size() + 1'000'000) return;
    tests_ = 0;
    sample(change);
    is_outgrown_ = 2 * sample_[best_axes()[0]].overlap < sample_[axes_[0]].overlap;
  }

  std::size_t structure_bytes() const noexcept override {
    return order_.bytes() + movers_.bytes() +
           (entries_.capacity() + merged_.capacity() + coming_.capacity() + moved_.capacity()) *
               sizeof(SweepEntry);
  }

  Mending mending_;
  int axis_;  // -1: to be chosen

  std::array<int, D> axes_{};
  SweepOrder<D> order_;
  SweepOrder<D> movers_;
  std::vector<SweepEntry> moved_;  // where the order is mended later
  std::vector<SweepEntry> entries_;
  std::vector<SweepEntry> merged_;
  std::vector<SweepEntry> coming_;
  core::Sample<D> sample_;
  std::vector<Box<D>> sampled_;
  std::size_t count_ = 0;
  bool is_outgrown_ = false;
  std::uint64_t tests_ = 0;  // since the last look at the axis
  Statistics statistics_;
};

constexpr std::array<std::string_view, 4> mendings = {"insertion", "binary", "merge", "heap"};

}  // namespace

Tunable sweep_and_prune_update() {
  return {.name = "update",
          .summary =
              "for tracking only: the order mended by an insertion sort, by binary search for each mover, by "
              "merging the movers in, or by a heap; or all pairs found anew",
          .standard = "auto",
          .type = Tunable::Type::choice,
          .choices = {"insertion", "binary", "merge", "heap", "rebuild"}};
}

template <int D>
std::unique_ptr<PairTracker<D>> make_sweep_and_prune_tracker(const Settings& settings,
                                                             std::unique_ptr<PairFinder<D>> finder) {
  using Way = typename core::IncrementalTracker<D>::Way;
  const std::string& update = settings.text("update");
  const Way way = update == "auto" ? Way::choose : update == "rebuild" ? Way::rebuild : Way::follow;
  const auto* const named = std::find(mendings.begin(), mendings.end(), update);
  const Mending mending =
      named == mendings.end() ? Mending::binary : static_cast<Mending>(named - mendings.begin());
  const int axis = settings.is_auto("axis") ? -1 : settings.text("axis")[0] - 'x';
  return std::make_unique<SweepAndPruneTracker<D>>(way, mending, axis, std::move(finder));
}

template std::unique_ptr<PairTracker<2>> make_sweep_and_prune_tracker(const Settings&,
                                                                      std::unique_ptr<PairFinder<2>>);
template std::unique_ptr<PairTracker<3>> make_sweep_and_prune_tracker(const Settings&,
                                                                      std::unique_ptr<PairFinder<3>>);

}  // namespace broadside::own
