// The events that tracking a history must report, frame by frame, and their hash.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "lab/measure/reference.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// Pairs begun and ended in one frame, each sorted.
struct FrameEvents {
  std::vector<Pair> begun;
  std::vector<Pair> ended;

  friend bool operator==(const FrameEvents&, const FrameEvents&) = default;
};

/// The expected events of a history.
struct ExpectedEvents {
  std::vector<FrameEvents> frames;  ///< the first frame's, then one for each step
  std::string fault;                ///< the fault of the reference itself; empty if there is none
};

/// The number of box tests that brute force makes for the events of a history: in each frame, the changed
/// boxes against all, or all against all if more than half of them changed.
template <int D, typename Real>
double tests_by_definition(const History<D, Real>& history);

/// The events of `history` by the reference: the differences between its pairs of consecutive frames. If the
/// reference is not brute force, a sample of its pairs is checked in every frame, each time for different
/// boxes.
template <int D, typename Real>
ExpectedEvents expected_events(const Reference& reference, const History<D, Real>& history,
                               const std::function<void()>& asks = {});

/// Hashes the events of each frame: independent of the order within a frame, dependent on the frame, and on
/// whether a pair begins or ends.
class EventHasher {
 public:
  void add(const FrameEvents& events) noexcept;
  std::uint64_t hash() const noexcept { return hash_; }

 private:
  std::uint64_t hash_ = 0;
};

/// The first difference, with `name`, the frame and the boxes in its text; empty if the events are equal and
/// sorted.
template <int D, typename Real = float>
std::string difference(const FrameEvents& found, const FrameEvents& expected, std::string_view name,
                       std::size_t frame, BoxSpan<D, Real> boxes);

}  // namespace broadside::lab
