// FrameStates: the boxes and filters of the last whole frame and of the current one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "broadside/error.hpp"
#include "broadside/follower.hpp"
#include "broadside/tracker.hpp"

#include "core/grow.hpp"
#include "core/input_check.hpp"
#include "core/parallel.hpp"
#include "kernels/all_present.hpp"

namespace broadside::track {

/// Invalid boxes count as absent, and are listed in quarantined() until they change.
template <int D, typename Real>
class FrameStates {
 public:
  /// Takes the next frame. `takes_all`: every box counts as changed. `lists_once`: no box is listed twice,
  /// and each is valid or absent. `lists_all`: core::is_whole() holds.
  void take(const Frame<D, Real>& frame, bool takes_all, bool lists_once, bool lists_all,
            core::Parallel& parallel) {
    const bool had_filters = !filters_before_.empty();
    is_whole_ = !takes_all && lists_all && frame.filters.empty() != had_filters;
    if (is_whole_) {
      if (!had_filters) filters_now_.clear();  // keep() leaves those of the last frame that had filters
      return take_all_boxes(frame, known_, parallel);
    }
    if (std::exchange(now_is_old_, false)) now_ = before_;
    const std::size_t size = std::max(frame.boxes.size(), known_);
    core::resize_by_eighths(before_, size, absent_box<D, Real>());
    core::resize_by_eighths(now_, size, absent_box<D, Real>());
    if (!frame.filters.empty() || had_filters) {
      core::resize_by_eighths(filters_before_, size);
      core::resize_by_eighths(filters_now_, size);
    } else {
      filters_now_.clear();
    }
    core::resize_by_eighths(flags_, size);
    if (takes_all || frame.filters.empty() == had_filters) return take_all_boxes(frame, size, parallel);
    // Flags are all 0, since the last update did not fail.
    changed_.clear();
    invalid_.clear();
    const auto copy = [this, boxes = frame.boxes, filters = frame.filters](std::size_t place) {
      flags_[place] = 1;
      now_[place] = place < boxes.size() ? taken(boxes[place]) : absent_box<D, Real>();
      if (!filters_now_.empty()) filters_now_[place] = place < filters.size() ? filters[place] : Filter{};
    };
    const auto take_once = [&](std::size_t place) {
      if (flags_[place] != 0) return;
      copy(place);
      changed_.push_back(BoxId(place));
      if (core::is_invalid(now_[place])) {
        now_[place] = absent_box<D, Real>();
        invalid_.push_back(BoxId(place));
      }
    };
    if (lists_once) {
      changed_.assign(frame.changed.begin(), frame.changed.end());
      parallel.for_ranges(changed_.size(), [&](core::Range range, std::size_t) {
        for (std::size_t i = range.begin; i < range.end; ++i) copy(index(changed_[i]));
      });
    } else {
      for (const BoxId id : frame.changed) {
        // Another thread may have written to the list since it was checked.
        if (index(id) < size) take_once(index(id));
      }
    }
    for (std::size_t i = std::min(known_, frame.boxes.size()); i < size; ++i) take_once(i);
  }

  /// The change from the last whole frame to the one taken.
  Change<D, Real> change(bool rebuild, const Workers& workers) const noexcept {
    return {.before = before_,
            .now = now_,
            .changed = changed_,
            .flags = flags_,
            .rebuild = rebuild,
            .filters_before = filters_before_,
            .filters_now = filters_now_,
            .workers = workers};
  }

  /// Reserves the memory that keep() needs.
  void prepare_to_keep() { quarantined_.reserve(quarantined_.size() + invalid_.size()); }

  /// Turns the taken frame into the last whole frame.
  void keep(const Frame<D, Real>& frame, core::Parallel& parallel) noexcept {
    const std::size_t size = frame.boxes.size();
    if (!quarantined_.empty() || !invalid_.empty()) {
      std::erase_if(quarantined_, [this](BoxId id) { return flags_[index(id)] != 0; });
      quarantined_.insert(quarantined_.end(), invalid_.begin(), invalid_.end());
      std::sort(quarantined_.begin(), quarantined_.end());
    }
    if (is_whole_) return keep_whole();
    const auto keep_changed = [this](core::Range range, std::size_t) {
      for (std::size_t i = range.begin; i < range.end; ++i) {
        before_[index(changed_[i])] = now_[index(changed_[i])];
        flags_[index(changed_[i])] = 0;
      }
    };
    try {
      parallel.for_ranges(changed_.size(), keep_changed);
    } catch (...) {  // from the executor, after some of its tasks
      keep_changed({0, changed_.size()}, 0);
    }
    if (!filters_now_.empty()) {
      for (const BoxId id : changed_) filters_before_[index(id)] = filters_now_[index(id)];
      filters_before_.resize(frame.filters.size());
    }
    before_.resize(size);
    now_.resize(size);
    flags_.resize(size);
    known_ = size;
  }

  /// The number of boxes of the last frame, whole or not.
  std::size_t size() const noexcept { return before_.size(); }

  /// The boxes of the last whole frame, and their filters.
  std::span<const Box<D, Real>> last_boxes() const noexcept { return std::span(before_).first(known_); }
  std::span<const Filter> last_filters() const noexcept {
    return std::span(filters_before_).first(filters_before_.empty() ? 0 : known_);
  }

  /// The places of the last whole frame's invalid boxes, ascending.
  std::span<const BoxId> quarantined() const noexcept { return quarantined_; }

  std::size_t bytes() const noexcept {
    return core::bytes_of(before_, now_, filters_before_, filters_now_, changed_, flags_, invalid_,
                          quarantined_);
  }

  bool touching = true;  ///< as in Tracker

 private:
  Box<D, Real> taken(const Box<D, Real>& box) const noexcept { return touching ? box : half_open(box); }

  /// Takes every box as changed: array by array, without a look at the list.
  void take_all_boxes(const Frame<D, Real>& frame, std::size_t size, core::Parallel& parallel) {
    // Not a copy: another thread may have written to the list since it was checked.
    changed_.resize(size);
    for (std::size_t i = 0; i < size; ++i) changed_[i] = BoxId(i);
    invalid_.clear();
    std::fill(flags_.begin(), flags_.end(), std::uint8_t{1});
    parallel.for_ranges(frame.boxes.size(), [&](core::Range range, std::size_t) {
      const auto some = frame.boxes.subspan(range.begin, range.size());
      const auto to = now_.begin() + static_cast<std::ptrdiff_t>(range.begin);
      if (touching)
        std::copy(some.begin(), some.end(), to);
      else
        std::transform(some.begin(), some.end(), to, half_open<D, Real>);
    });
    std::fill(now_.begin() + static_cast<std::ptrdiff_t>(frame.boxes.size()), now_.end(),
              absent_box<D, Real>());
    const auto others = std::copy(frame.filters.begin(), frame.filters.end(), filters_now_.begin());
    std::fill(others, filters_now_.end(), Filter{});
    if (kernels::all_present(std::span<const Box<D, Real>>(now_))) return;
    for (std::size_t i = 0; i < size; ++i) {
      if (!core::is_invalid(now_[i])) continue;
      now_[i] = absent_box<D, Real>();
      invalid_.push_back(BoxId(i));
    }
  }

  /// Exchanges the two states instead of copying one. The next frame that is not whole copies it.
  void keep_whole() noexcept {
    before_.swap(now_);
    now_is_old_ = true;
    std::fill(flags_.begin(), flags_.end(), std::uint8_t{0});
    std::copy_n(filters_now_.begin(), filters_before_.size(), filters_before_.begin());
  }

  std::vector<Box<D, Real>> before_;
  std::size_t known_ = 0;  // an update that failed may have left before_ longer
  std::vector<Box<D, Real>> now_;
  bool is_whole_ = false;               // whether the frame lists every box in ascending order
  bool now_is_old_ = false;             // whether now_ has the state before that in before_
  std::vector<Filter> filters_before_;  // both empty until there are filters
  std::vector<Filter> filters_now_;     // keep() does not shorten it: an index may use it
  std::vector<BoxId> changed_;
  std::vector<std::uint8_t> flags_;
  std::vector<BoxId> invalid_;  // among the changed boxes
  std::vector<BoxId> quarantined_;
};

}  // namespace broadside::track
