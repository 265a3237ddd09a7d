// Recording: a history of boxes in memory, with the pairs that an engine reported in each frame.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "lab/formats/frames.hpp"
#include "lab/formats/recorded_pairs.hpp"

namespace broadside::lab {

/// The frames of a file, and the pairs that an engine reported in each; empty if no pairs were recorded.
template <int D, typename Real>
struct Recording {
  History<D, Real> history;
  std::vector<RecordedPairs> pairs{};
};

/// Reads the remaining frames into memory, with their recorded pairs.
template <int D, typename Real>
Recording<D, Real> read_recording(FrameReader<D, Real>& frames) {
  Recording<D, Real> recording{{frames.first(), {}}};
  const auto add_pairs = [&] {
    if (frames.recorded() != nullptr) recording.pairs.push_back(*frames.recorded());
  };
  add_pairs();
  for (Step<D, Real> step; frames.next(step);) {
    recording.history.steps.push_back(std::move(step));
    add_pairs();
  }
  return recording;
}

/// The frames of a recording with pairs.
template <int D, typename Real>
class RecordingReader final : public FrameReader<D, Real> {
 public:
  explicit RecordingReader(Recording<D, Real> recording)
      : boxes_(std::move(recording.history)), pairs_(std::move(recording.pairs)) {
    now_.margin = pairs_.at(0).margin;
  }

  std::vector<Box<D, Real>> first() override {
    now_ = pairs_[0];
    return boxes_.first();
  }

  bool next(Step<D, Real>& step) override {
    if (!boxes_.next(step)) return false;
    now_ = pairs_.at(++frame_);
    return true;
  }

  const RecordedPairs* recorded() const override { return &now_; }

 private:
  HistoryReader<D, Real> boxes_;
  std::vector<RecordedPairs> pairs_;
  RecordedPairs now_;
  std::size_t frame_ = 0;
};

}  // namespace broadside::lab
