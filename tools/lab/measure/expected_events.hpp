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
  std::string fault;                ///< what is wrong with the reference itself; empty if nothing is
};

/// How many tests of two boxes the definition's events of a history take: in each frame the changed boxes
/// against all, or all against all where more than half of them changed.
template <int D, typename Real>
double tests_by_definition(const History<D, Real>& history);

/// The events of `history` by the reference: what differs between its pairs of one frame and the next. Where
/// the reference is not the definition, its pairs are sampled in every frame, each time those of other boxes.
template <int D, typename Real>
ExpectedEvents expected_events(const Reference& reference, const History<D, Real>& history,
                               const std::function<void()>& asks = {});

/// Hashes the events of frame after frame: the same for any order within a frame, different for another
/// frame, and for a pair that ends instead of beginning.
class EventHasher {
 public:
  void add(const FrameEvents& events) noexcept;
  std::uint64_t hash() const noexcept { return hash_; }

 private:
  std::uint64_t hash_ = 0;
};

/// What differs first, with `name`, the frame and the boxes in its text; empty if the events are equal and
/// sorted.
template <int D, typename Real = float>
std::string difference(const FrameEvents& found, const FrameEvents& expected, std::string_view name,
                       std::size_t frame, BoxSpan<D, Real> boxes);

}  // namespace broadside::lab
