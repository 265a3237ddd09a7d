// PairTracker: what every tracker does around its algorithm.
#include "broadside/tracker.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "broadside/error.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

#include "core/float_environment.hpp"
#include "core/grow.hpp"
#include "core/lean.hpp"
#include "core/parallel.hpp"
#include "core/sort_pairs.hpp"
#include "interface/input_check.hpp"

namespace broadside {
namespace {

/// Changes whose boxes are copied in the time that a search takes for a box.
constexpr std::size_t changes_a_box = 8;

}  // namespace

template <int D, typename Real>
class BROADSIDE_HIDDEN PairTracker<D, Real>::State {
 public:
  void check(const Frame<D, Real>& frame) const {
    core::check_frame(frame, before_.size(), dirty_, bad_input);
  }
  void update(PairTracker& tracker, const Frame<D, Real>& frame, bool lists_once, PairSink& begun,
              PairSink& ended);
  Frame<D, Real> last_frame() const noexcept;
  std::size_t bytes() const noexcept;
  bool is_whole() const noexcept { return !dirty_; }
  std::span<const BoxId> quarantined() const noexcept { return quarantined_; }

  BadInput bad_input = BadInput::reject;
  std::optional<Statistics> statistics;
  Workers workers;

 private:
  void take(const Frame<D, Real>& frame, bool rebuild, bool lists_once);
  void take_ignored(const Frame<D, Real>& frame, bool rebuild);
  void drop_ignored(const Change<D, Real>& change);
  void keep(const Frame<D, Real>& frame) noexcept;

  std::vector<Box<D, Real>> before_;  // the boxes of the last whole update
  std::size_t taken_ = 0;             // how many boxes that had
  std::vector<Box<D, Real>> now_;
  std::vector<Filter> filters_before_;  // both empty until there are filters
  std::vector<Filter> filters_now_;
  IgnoredPairs ignored_;       // those of the last whole update
  bool had_ignored_ = false;   // whether it was given a set
  std::vector<Pair> toggled_;  // pairs that are ignored in one of the two frames, sorted
  std::vector<BoxId> changed_;
  std::vector<std::uint8_t> flags_;
  std::vector<BoxId> invalid_;      // of the changed ones
  std::vector<BoxId> quarantined_;  // those of the last whole update
  std::vector<Pair> begun_;
  std::vector<Pair> ended_;
  std::vector<Pair> sorting_;
  core::Parallel parallel_;
  bool dirty_ = true;  // the last update did not end, or there was none
};

/// `lists_once`: no box is listed twice.
template <int D, typename Real>
void PairTracker<D, Real>::State::update(PairTracker& tracker, const Frame<D, Real>& frame, bool lists_once,
                                         PairSink& begun, PairSink& ended) {
  const bool rebuild = std::exchange(dirty_, true);  // until the end of this update
  parallel_.start(workers, frame.changed.size() / changes_a_box);
  take(frame, rebuild, lists_once);
  take_ignored(frame, rebuild);

  begun_.clear();
  ended_.clear();
  statistics.reset();
  const Change<D, Real> change{before_,         now_,         changed_, flags_, rebuild,
                               filters_before_, filters_now_, &frame};
  {
    PairCollector begun_pairs(begun_);
    PairCollector ended_pairs(ended_);
    tracker.update_valid(change, begun_pairs, ended_pairs);
    begun_pairs.flush();
    ended_pairs.flush();
  }
  drop_ignored(change);
  core::sort_unique(begun_, sorting_);
  core::sort_unique(ended_, sorting_);
  // The pairs that are ignored from now on come first.
  const auto middle = std::partition(toggled_.begin(), toggled_.end(),
                                     [this](Pair pair) { return !ignored_.contains(pair); });
  const auto newly_ignored = static_cast<std::size_t>(middle - toggled_.begin());
  const std::span<const Pair> newly = std::span(toggled_).first(newly_ignored);
  const std::span<const Pair> no_longer = std::span(toggled_).subspan(newly_ignored);
  try {
    // All memory is taken before the events are delivered, so that nothing can fail after them.
    for (const Pair pair : newly) ignored_.insert(pair);
    quarantined_.reserve(quarantined_.size() + invalid_.size());
    const core::CallersEnvironment callers;
    begun.put(begun_);
    ended.put(ended_);
  } catch (...) {
    for (const Pair pair : newly) ignored_.erase(pair);
    begun.discard();
    ended.discard();
    throw;
  }
  for (const Pair pair : no_longer) ignored_.erase(pair);
  keep(frame);
  dirty_ = false;
}

/// Sets now_, changed_, invalid_ and flags_, and makes everything as long as the longer frame.
template <int D, typename Real>
void PairTracker<D, Real>::State::take(const Frame<D, Real>& frame, bool rebuild, bool lists_once) {
  const std::span<const Box<D, Real>> boxes = frame.boxes;
  const std::size_t size = std::max(boxes.size(), taken_);
  const bool had_filters = !filters_before_.empty();
  core::resize_by_eighths(before_, size, absent_box<D, Real>());
  core::resize_by_eighths(now_, size, absent_box<D, Real>());
  if (!frame.filters.empty() || had_filters) {
    core::resize_by_eighths(filters_before_, size);
    core::resize_by_eighths(filters_now_, size);
  }
  // Flags are all 0 between two updates, unless the last one failed.
  if (rebuild) std::fill(flags_.begin(), flags_.end(), std::uint8_t{0});
  core::resize_by_eighths(flags_, size);
  changed_.clear();
  invalid_.clear();
  const auto copy = [&](std::size_t i) {
    flags_[i] = 1;
    now_[i] = i < boxes.size() ? boxes[i] : absent_box<D, Real>();
    if (!filters_now_.empty()) filters_now_[i] = i < frame.filters.size() ? frame.filters[i] : Filter{};
  };
  const auto take = [&](std::size_t i) {
    if (flags_[i] != 0) return;
    copy(i);
    changed_.push_back(BoxId(i));
    if (!core::is_lean && core::is_invalid(now_[i])) {
      now_[i] = absent_box<D, Real>();
      invalid_.push_back(BoxId(i));
    }
  };
  if (rebuild || frame.filters.empty() == had_filters) {
    for (std::size_t i = 0; i < size; ++i) take(i);
    return;
  }
  if (lists_once) {
    changed_.assign(frame.changed.begin(), frame.changed.end());
    parallel_.for_ranges(changed_.size(), [&](core::Range range, std::size_t) {
      for (std::size_t i = range.begin; i < range.end; ++i) copy(index(changed_[i]));
    });
  } else {
    for (const BoxId id : frame.changed) {
      // Another thread may have written to the list since it was checked.
      const std::size_t place = index(id);
      if (place < size) take(place);
    }
  }
  for (std::size_t i = std::min(taken_, boxes.size()); i < size; ++i) take(i);
}

/// Sets toggled_.
template <int D, typename Real>
void PairTracker<D, Real>::State::take_ignored(const Frame<D, Real>& frame, bool rebuild) {
  const auto is_ignored = [&frame](Pair pair) {
    return frame.ignored != nullptr && frame.ignored->contains(pair);
  };
  toggled_.clear();
  const auto take = [&](Pair pair) {
    if (pair.second < pair.first) std::swap(pair.first, pair.second);
    if (is_ignored(pair) != ignored_.contains(pair)) toggled_.push_back(pair);
  };
  if (rebuild || (frame.ignored != nullptr) != had_ignored_) {
    ignored_.for_each(take);
    if (frame.ignored != nullptr) frame.ignored->for_each(take);
  } else {
    for (const Pair pair : frame.ignored_changed) take(pair);
  }
  core::sort_unique(toggled_, sorting_);
}

/// Drops the events of ignored pairs, and adds events of pairs that became ignored or no longer are.
template <int D, typename Real>
void PairTracker<D, Real>::State::drop_ignored(const Change<D, Real>& change) {
  if (toggled_.empty() && ignored_.empty()) return;
  const auto is_dropped = [this](Pair pair) {
    return ignored_.contains(pair) || std::ranges::binary_search(toggled_, pair);
  };
  std::erase_if(begun_, is_dropped);
  std::erase_if(ended_, is_dropped);
  for (const Pair pair : toggled_) {
    if (index(pair.second) >= change.now.size()) continue;
    if (ignored_.contains(pair)) {
      if (change.holds(pair.first, pair.second)) begun_.push_back(pair);
    } else {
      if (change.held(pair.first, pair.second)) ended_.push_back(pair);
    }
  }
}

/// Makes this frame the one before, except for its ignored pairs. There is room in quarantined_.
template <int D, typename Real>
void PairTracker<D, Real>::State::keep(const Frame<D, Real>& frame) noexcept {
  const std::size_t size = frame.boxes.size();
  if (!core::is_lean && (!quarantined_.empty() || !invalid_.empty())) {
    std::erase_if(quarantined_, [this](BoxId id) { return flags_[index(id)] != 0; });
    quarantined_.insert(quarantined_.end(), invalid_.begin(), invalid_.end());
    std::ranges::sort(quarantined_);
  }
  const auto keep_changed = [this](core::Range range, std::size_t) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      before_[index(changed_[i])] = now_[index(changed_[i])];
      flags_[index(changed_[i])] = 0;
    }
  };
  try {
    parallel_.for_ranges(changed_.size(), keep_changed);
  } catch (...) {  // the executor's, after some of its tasks
    keep_changed({0, changed_.size()}, 0);
  }
  if (!filters_now_.empty()) {
    for (const BoxId id : changed_) filters_before_[index(id)] = filters_now_[index(id)];
    filters_before_.resize(frame.filters.size());
    filters_now_.resize(frame.filters.size());
  }
  before_.resize(size);
  now_.resize(size);
  flags_.resize(size);
  taken_ = size;
  had_ignored_ = frame.ignored != nullptr;
}

template <int D, typename Real>
Frame<D, Real> PairTracker<D, Real>::State::last_frame() const noexcept {
  // An update that failed may have made them longer.
  const std::span<const Filter> filters = filters_before_;
  return {std::span(before_).first(taken_),
          {},
          filters.first(filters.empty() ? 0 : taken_),
          had_ignored_ ? &ignored_ : nullptr,
          {}};
}

template <int D, typename Real>
std::size_t PairTracker<D, Real>::State::bytes() const noexcept {
  return (before_.capacity() + now_.capacity()) * sizeof(Box<D, Real>) +
         (filters_before_.capacity() + filters_now_.capacity()) * sizeof(Filter) +
         (changed_.capacity() + invalid_.capacity() + quarantined_.capacity()) * sizeof(BoxId) +
         flags_.capacity() +
         (begun_.capacity() + ended_.capacity() + sorting_.capacity() + toggled_.capacity()) * sizeof(Pair) +
         ignored_.bytes();
}

template <int D, typename Real>
PairTracker<D, Real>::PairTracker() : state_(std::make_unique<State>()) {}

template <int D, typename Real>
PairTracker<D, Real>::~PairTracker() = default;

template <int D, typename Real>
void PairTracker<D, Real>::update(const Frame<D, Real>& frame, PairSink& begun, PairSink& ended) {
  const core::DefaultEnvironment environment;
  state_->check(frame);
  state_->update(*this, frame, false, begun, ended);
}

template <int D, typename Real>
void PairTracker<D, Real>::update_checked(const Frame<D, Real>& frame, PairSink& begun, PairSink& ended) {
  const core::DefaultEnvironment environment;
  state_->update(*this, frame, true, begun, ended);
}

template <int D, typename Real>
BadInput PairTracker<D, Real>::bad_input() const noexcept {
  return state_->bad_input;
}

template <int D, typename Real>
void PairTracker<D, Real>::set_bad_input(BadInput bad_input) noexcept {
  state_->bad_input = bad_input;
}

template <int D, typename Real>
std::span<const BoxId> PairTracker<D, Real>::quarantined() const noexcept {
  return state_->quarantined();
}

template <int D, typename Real>
Frame<D, Real> PairTracker<D, Real>::last_frame() const noexcept {
  return state_->last_frame();
}

template <int D, typename Real>
const BoxIndex<D, Real>* PairTracker<D, Real>::box_index() const noexcept {
  return state_->is_whole() ? algorithm_index() : nullptr;
}

template <int D, typename Real>
const std::optional<Statistics>& PairTracker<D, Real>::statistics() const noexcept {
  return state_->statistics;
}

template <int D, typename Real>
std::size_t PairTracker<D, Real>::bytes() const noexcept {
  return core::is_lean ? 0 : state_->bytes() + algorithm_bytes();
}

template <int D, typename Real>
const Workers& PairTracker<D, Real>::workers() const noexcept {
  return state_->workers;
}

template <int D, typename Real>
void PairTracker<D, Real>::set_workers(const Workers& workers) {
  if constexpr (core::is_lean) return;
  state_->workers = workers;
  workers_changed();
}

template <int D, typename Real>
void PairTracker<D, Real>::count(const std::optional<Statistics>& statistics) {
  state_->statistics = statistics;
}

template <int D, typename Real>
void PairTracker<D, Real>::update_with(PairTracker& other, const Change<D, Real>& change, PairSink& begun,
                                       PairSink& ended) {
  other.set_workers(workers());
  other.state_->statistics.reset();
  other.update_valid(change, begun, ended);
  state_->statistics = other.state_->statistics;
}

template class PairTracker<2, float>;
template class PairTracker<2, double>;
template class PairTracker<3, float>;
template class PairTracker<3, double>;

}  // namespace broadside
