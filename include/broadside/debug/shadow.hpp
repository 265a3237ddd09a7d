// ShadowTracker: runs a tracker and brute force side by side, and reports where they first differ.
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

/// A Divergence with a history whose last frame shows the fault.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC DivergenceOf final : public Divergence {
 public:
  DivergenceOf(const Divergence& divergence, History<D, Real> history, bool reproduced)
      : Divergence(divergence),
        history_(std::make_shared<const History<D, Real>>(std::move(history))),
        reproduced_(reproduced) {}

  /// If reproduced(): the smallest history found on which a new tracker fails, with boxes renumbered.
  /// Otherwise what the pair's two boxes, now 0 and 1, did in the frames that were kept.
  [[nodiscard]] const History<D, Real>& history() const noexcept { return *history_; }

  [[nodiscard]] bool reproduced() const noexcept { return reproduced_; }

 private:
  std::shared_ptr<const History<D, Real>> history_;  // shared, so that a copy does not throw
  bool reproduced_;
};

/// Limits of a ShadowTracker's memory and time.
struct ShadowOptions {
  /// The number of earlier frames it keeps to show how a fault came about. It keeps fewer, but at least one,
  /// if their changes take more than `bytes`.
  std::size_t frames = 256;
  std::size_t bytes = std::size_t{64} << 20;

  /// The approximate number of box tests spent on minimising a history.
  std::uint64_t tests = 2'000'000'000;
};

/// Runs a tracker, compares its events with brute force in every frame, and throws the first difference as a
/// DivergenceOf<D, Real>. Use it to look for faults in an algorithm or in your list of changes.
///
/// Cost of a frame: the tracker's, and n^2 / 2 tests. Memory: four copies of the boxes, the pairs, and
/// ShadowOptions::frames.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC ShadowTracker final {
 public:
  using Make = std::function<Tracker<D, Real>()>;

  /// Shadows a tracker of the library. Throws InvalidSpec.
  explicit ShadowTracker(const Spec& spec, const ShadowOptions& options = {});

  /// Shadows a tracker from `make`, which is called again to minimise a history.
  explicit ShadowTracker(Make make, const ShadowOptions& options = {});

  /// Shadows this tracker. Without a way to make others, it does not minimise histories.
  explicit ShadowTracker(Tracker<D, Real> tracker, const ShadowOptions& options = {});

  ShadowTracker(ShadowTracker&& other) noexcept;
  ShadowTracker& operator=(ShadowTracker&& other) noexcept;
  ~ShadowTracker();

  /// As Tracker::update(). Also throws DivergenceOf, and then the same one at every call; and InvalidFrame,
  /// before the tracker is called, if a changed box, filter or ignored pair is not listed.
  std::optional<Statistics> update(const Frame<D, Real>& frame, PairSink& begun, PairSink& ended);

  /// The tracker that is shadowed: for its explanation, its bytes and its workers.
  [[nodiscard]] const Tracker<D, Real>& tracker() const noexcept;
  Tracker<D, Real>& tracker() noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace broadside
