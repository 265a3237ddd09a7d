// PairTracker: what every tracker does around its algorithm.
#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "broadside/broad_phase.hpp"
#include "broadside/error.hpp"
#include "broadside/sinks.hpp"

#include "core/float_environment.hpp"
#include "core/grow.hpp"
#include "core/sort_pairs.hpp"
#include "interface/input_check.hpp"

namespace broadside {
namespace {

/// About what an IgnoredPairs holds for each pair: a node and its place in the table.
constexpr std::size_t ignored_pair_bytes = 40;

}  // namespace

template <int D, typename Real>
void PairTracker<D, Real>::update(const Frame<D, Real>& frame, PairSink& begun, PairSink& ended) {
  const core::DefaultEnvironment environment;
  check(frame);
  const bool rebuild = std::exchange(dirty_, true);  // until the end of this update
  take(frame, rebuild);
  take_ignored(frame, rebuild);

  begun_.clear();
  ended_.clear();
  statistics_.reset();
  const Change<D, Real> change{before_,         now_,         changed_, flags_, rebuild,
                               filters_before_, filters_now_, &frame};
  {
    PairCollector begun_pairs(begun_);
    PairCollector ended_pairs(ended_);
    update_valid(change, begun_pairs, ended_pairs);
    begun_pairs.flush();
    ended_pairs.flush();
  }
  drop_ignored(change);
  core::sort_unique(begun_, sorting_);
  core::sort_unique(ended_, sorting_);
  // The pairs that are ignored from now on come first.
  const auto middle = std::partition(toggled_.begin(), toggled_.end(),
                                     [this](Pair pair) { return !ignored_.contains(pair); });
  const std::span<const Pair> newly(toggled_.begin(), middle);
  const std::span<const Pair> no_longer(middle, toggled_.end());
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

/// Throws if anything is wrong with the frame, before anything changes. A box beyond the ones known is new
/// and counts as listed; after a failed update every box does. The first wrong one is named, whatever the
/// order of the list.
template <int D, typename Real>
void PairTracker<D, Real>::check(const Frame<D, Real>& frame) const {
  const std::span<const Box<D, Real>> boxes = frame.boxes;
  const std::size_t size = std::max(boxes.size(), before_.size());
  core::check_count(boxes.size());
  if (!frame.filters.empty() && frame.filters.size() != boxes.size()) {
    throw InvalidFrame(std::to_string(frame.filters.size()) + " filters for a frame of " +
                       std::to_string(boxes.size()) + " boxes; expected one for each box, or none");
  }
  std::size_t first = dirty_ ? 0 : std::min(before_.size(), boxes.size());
  for (const BoxId id : frame.changed) {
    if (index(id) >= size) {
      throw InvalidFrame("changed box " + std::to_string(index(id)) + " of a frame of " +
                         std::to_string(boxes.size()) + " boxes; expected a place in this frame or the last");
    }
    if (index(id) < first && core::is_invalid(boxes[index(id)])) first = index(id);
  }
  if (bad_input_ == BadInput::reject) core::check_boxes(boxes, first);
}

/// Sets now_, changed_, invalid_ and flags_, and makes everything as long as the longer frame.
template <int D, typename Real>
void PairTracker<D, Real>::take(const Frame<D, Real>& frame, bool rebuild) {
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
  const auto take = [&](std::size_t i) {
    if (flags_[i] != 0) return;
    flags_[i] = 1;
    changed_.push_back(BoxId(i));
    now_[i] = i < boxes.size() ? boxes[i] : absent_box<D, Real>();
    if (core::is_invalid(now_[i])) {
      now_[i] = absent_box<D, Real>();
      invalid_.push_back(BoxId(i));
    }
    if (!filters_now_.empty()) filters_now_[i] = i < frame.filters.size() ? frame.filters[i] : Filter{};
  };
  if (rebuild || frame.filters.empty() == had_filters) {
    for (std::size_t i = 0; i < size; ++i) take(i);
  } else {
    for (const BoxId id : frame.changed) take(index(id));
    for (std::size_t i = std::min(taken_, boxes.size()); i < size; ++i) take(i);
  }
}

/// Sets toggled_.
template <int D, typename Real>
void PairTracker<D, Real>::take_ignored(const Frame<D, Real>& frame, bool rebuild) {
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
void PairTracker<D, Real>::drop_ignored(const Change<D, Real>& change) {
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
void PairTracker<D, Real>::keep(const Frame<D, Real>& frame) noexcept {
  const std::size_t size = frame.boxes.size();
  if (!quarantined_.empty() || !invalid_.empty()) {
    std::erase_if(quarantined_, [this](BoxId id) { return flags_[index(id)] != 0; });
    quarantined_.insert(quarantined_.end(), invalid_.begin(), invalid_.end());
    std::ranges::sort(quarantined_);
  }
  for (const BoxId id : changed_) {
    before_[index(id)] = now_[index(id)];
    flags_[index(id)] = 0;
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
std::size_t PairTracker<D, Real>::bytes() const noexcept {
  return (before_.capacity() + now_.capacity()) * sizeof(Box<D, Real>) +
         (filters_before_.capacity() + filters_now_.capacity()) * sizeof(Filter) +
         (changed_.capacity() + invalid_.capacity() + quarantined_.capacity()) * sizeof(BoxId) +
         flags_.capacity() +
         (begun_.capacity() + ended_.capacity() + sorting_.capacity() + toggled_.capacity()) * sizeof(Pair) +
         ignored_.size() * ignored_pair_bytes + algorithm_bytes();
}

template <int D, typename Real>
void PairTracker<D, Real>::update_with(PairTracker& other, const Change<D, Real>& change, PairSink& begun,
                                       PairSink& ended) {
  other.set_workers(workers_);
  other.statistics_.reset();
  other.update_valid(change, begun, ended);
  statistics_ = other.statistics_;
}

template class PairTracker<2, float>;
template class PairTracker<2, double>;
template class PairTracker<3, float>;
template class PairTracker<3, double>;

}  // namespace broadside
