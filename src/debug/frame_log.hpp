// FrameLog: the last frames of a history, in bounded memory.
#pragma once

#include <cstddef>
#include <list>
#include <utility>
#include <vector>

#include "broadside/debug/history.hpp"

#include "core/grow.hpp"

namespace broadside::debug {

/// Keeps one earlier frame whole, and the changes since. The oldest changes are applied to that frame when
/// there are more than allowed, or when they take more bytes than allowed.
template <int D, typename Real>
class FrameLog {
 public:
  FrameLog(std::size_t max_frames, std::size_t max_bytes) : max_frames_(max_frames), max_bytes_(max_bytes) {}

  /// Prepares a frame: `frame.changed` lists what changed, and `toggled` the pairs that became ignored or no
  /// longer are. The frame counts once add() has taken it.
  void prepare(const Frame<D, Real>& frame, const std::vector<Pair>& toggled) {
    Step<D, Real> step{frame.boxes.size(), {frame.changed.begin(), frame.changed.end()}, {}, {}, toggled};
    for (const BoxId id : step.changed) {
      const bool is_there = index(id) < frame.boxes.size();
      step.boxes.push_back(is_there ? frame.boxes[index(id)] : absent_box<D, Real>());
      if (!frame.filters.empty()) step.filters.push_back(is_there ? frame.filters[index(id)] : Filter{});
    }
    if (count_ == 0) {
      first_ = {};
      first_.next(step);
      return;
    }
    while (!steps_.empty() && (steps_.size() >= max_frames_ || bytes_ + bytes_of(step) > max_bytes_)) {
      Replay<D, Real> second = first_;  // a copy: a half-applied step could not be applied again
      second.next(steps_.front());
      first_ = std::move(second);
      bytes_ -= bytes_of(steps_.front());
      steps_.pop_front();
    }
    prepared_.clear();
    prepared_.push_back(std::move(step));
  }

  /// Takes the frame that was prepared last.
  void add() noexcept {
    if (count_++ == 0) return;
    bytes_ += bytes_of(prepared_.front());
    steps_.splice(steps_.end(), prepared_);
  }

  /// The frames that are kept.
  History<D, Real> history() const { return history_of(first_.frame(), {steps_.begin(), steps_.end()}); }

  /// The number of frames taken.
  std::size_t count() const noexcept { return count_; }

 private:
  static std::size_t bytes_of(const Step<D, Real>& step) noexcept {
    return sizeof step + core::bytes_of(step.changed, step.boxes, step.filters, step.toggled);
  }

  std::size_t max_frames_;
  std::size_t max_bytes_;
  Replay<D, Real> first_;
  std::list<Step<D, Real>> steps_;
  std::list<Step<D, Real>> prepared_;  // one at most
  std::size_t bytes_ = 0;              // of the steps
  std::size_t count_ = 0;
};

}  // namespace broadside::debug
