// FrameLog: the last frames of a history, in bounded memory.
#pragma once

#include <cstddef>
#include <list>
#include <vector>

#include "broadside/debug/history.hpp"

namespace broadside::core {

/// Keeps one earlier frame whole, and what changed since. The oldest changes become a part of the
/// whole frame when there are more of them than allowed, or when they take more bytes than allowed.
template <int D, typename Real>
class FrameLog {
 public:
  FrameLog(std::size_t max_frames, std::size_t max_bytes) : max_frames_(max_frames), max_bytes_(max_bytes) {}

  /// Makes room for a frame, in which `frame.changed` says what changed, and `toggled` which pairs became
  /// ignored or no longer are. It counts when add() has taken it.
  void prepare(const Frame<D, Real>& frame, const std::vector<Pair>& toggled);

  /// Takes the frame that was prepared last.
  void add() noexcept;

  /// The frames that are kept.
  History<D, Real> history() const;

  /// The number of frames taken.
  std::size_t count() const noexcept { return count_; }

  std::size_t bytes() const noexcept { return bytes_; }

 private:
  static std::size_t bytes_of(const Step<D, Real>& step) noexcept;

  std::size_t max_frames_;
  std::size_t max_bytes_;
  Replay<D, Real> first_;
  std::list<Step<D, Real>> steps_;
  std::list<Step<D, Real>> prepared_;  // one at most
  std::size_t bytes_ = 0;              // of the steps
  std::size_t count_ = 0;
};

}  // namespace broadside::core
