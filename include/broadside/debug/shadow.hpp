// ShadowTracker: any tracker with brute force beside it, which says where the two first differ.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "broadside/debug/history.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"
#include "broadside/tracker.hpp"

namespace broadside {

/// Thrown if a tracker's events differ from the definition. The message names the pair, the frame and both
/// boxes, says what was expected, and ends with a short history that shows the fault.
class BROADSIDE_PUBLIC Divergence : public std::logic_error {
 public:
  Divergence(const std::string& message, Pair pair, std::size_t frame, bool holds)
      : std::logic_error(message), pair_(pair), frame_(frame), holds_(holds) {}

  /// The first wrong pair, in order of ids.
  [[nodiscard]] Pair pair() const noexcept { return pair_; }

  /// The frame, counted from the ShadowTracker's first frame, which is 0.
  [[nodiscard]] std::size_t frame() const noexcept { return frame_; }

  /// Whether the pair holds in that frame, by the definition.
  [[nodiscard]] bool holds() const noexcept { return holds_; }

 private:
  Pair pair_;
  std::size_t frame_;
  bool holds_;
};

/// A Divergence with its history, which tracks wrongly in its last frame.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC DivergenceOf final : public Divergence {
 public:
  DivergenceOf(const Divergence& divergence, History<D, Real> history, bool reproduced)
      : Divergence(divergence),
        history_(std::make_shared<const History<D, Real>>(std::move(history))),
        reproduced_(reproduced) {}

  /// If reproduced(): the smallest history found on which a new tracker fails. Boxes are counted anew.
  /// Otherwise what the two boxes of the pair, now 0 and 1, did in the frames that were kept.
  [[nodiscard]] const History<D, Real>& history() const noexcept { return *history_; }

  [[nodiscard]] bool reproduced() const noexcept { return reproduced_; }

 private:
  std::shared_ptr<const History<D, Real>> history_;  // shared, so that a copy does not throw
  bool reproduced_;
};

/// What a ShadowTracker spends.
struct ShadowOptions {
  /// How many frames back it can show how a fault came about; fewer, but at least one, if their changes take
  /// more than `bytes`.
  std::size_t frames = 256;
  std::size_t bytes = std::size_t{64} << 20;

  /// About how many pairs of boxes are compared to make a history small.
  std::uint64_t tests = 2'000'000'000;
};

/// Runs a tracker and compares its events with those of brute force, by the definition, in every frame; the
/// first difference is thrown as a DivergenceOf<D, Real>. For looking for faults, in the algorithm and in the
/// caller's list of what changed.
///
/// Cost of a frame: the tracker's, and n^2 / 2 tests. Memory: four copies of the boxes, the pairs, and the
/// frames of ShadowOptions.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC ShadowTracker final {
 public:
  using Make = std::function<Tracker<D, Real>()>;

  /// Shadows a tracker of the library's. Throws InvalidSpec.
  explicit ShadowTracker(const Spec& spec, const ShadowOptions& options = {});

  /// Shadows what `make` makes; it is called again to make a history small.
  explicit ShadowTracker(Make make, const ShadowOptions& options = {});

  /// Shadows the one tracker that there is: a history is not made small.
  explicit ShadowTracker(Tracker<D, Real> tracker, const ShadowOptions& options = {});

  ShadowTracker(ShadowTracker&& other) noexcept;
  ShadowTracker& operator=(ShadowTracker&& other) noexcept;
  ~ShadowTracker();

  /// As Tracker::update(). Throws, besides: DivergenceOf, and from then on the same each time; InvalidFrame,
  /// before the tracker is asked, if a box, a filter or an ignored pair has changed and is not listed.
  std::optional<Statistics> update(const Frame<D, Real>& frame, PairSink& begun, PairSink& ended);

  /// The tracker that is shadowed: for its explanation, its bytes, its workers.
  [[nodiscard]] const Tracker<D, Real>& tracker() const noexcept;
  Tracker<D, Real>& tracker() noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace broadside
