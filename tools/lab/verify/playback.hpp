// Playback: steps through a recording with pairs, frame by frame.
#pragma once

#include <cstddef>
#include <vector>

#include "lab/formats/recording.hpp"

namespace broadside::lab {

/// Steps through a recording with pairs; starts at its first frame.
template <int D, typename Real>
class Playback {
 public:
  explicit Playback(const Recording<D, Real>& recording)
      : recording_(recording), boxes_(recording.history.boxes) {
    pairs_.apply(recording.pairs.front(), boxes_.size(), {});
  }

  std::size_t frame() const noexcept { return frame_; }
  const std::vector<Box<D, Real>>& boxes() const noexcept { return boxes_; }
  const RecordedFrame& pairs() const noexcept { return pairs_; }

  /// Moves on to the next frame; false if there is none.
  bool next() {
    if (frame_ == recording_.history.steps.size()) return false;
    const Step<D, Real>& step = recording_.history.steps[frame_++];
    std::vector<BoxId> emptied;
    for (std::size_t i = 0; i < step.changed.size(); ++i) {
      if (is_absent(step.boxes[i])) emptied.push_back(step.changed[i]);
    }
    lab::apply(step, boxes_);
    pairs_.apply(recording_.pairs[frame_], boxes_.size(), emptied);
    return true;
  }

 private:
  const Recording<D, Real>& recording_;
  std::size_t frame_ = 0;
  std::vector<Box<D, Real>> boxes_;
  RecordedFrame pairs_;
};

}  // namespace broadside::lab
