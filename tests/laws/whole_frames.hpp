// Frames with all that a tracker can be given: boxes, filters, ignored pairs, sinks that fail; and what it
// must answer, by definition.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadside/filter.hpp"
#include "broadside/tracker.hpp"

#include "law_sinks.hpp"

namespace broadside::laws {

/// A frame whole, not what changed in it: so any frame can be left out and the rest still is a history.
template <int D, typename Real = float>
struct WholeFrame {
  std::vector<Box<D, Real>> boxes;
  std::vector<Filter> filters{};               ///< one for each box, or none
  std::optional<std::vector<Pair>> ignored{};  ///< sorted; nothing: a null pointer
  std::vector<BoxId> listed{};        ///< places said to change besides those that do, within the boxes
  std::size_t begun_room = no_limit;  ///< how many pairs the sinks take before they throw
  std::size_t ended_room = no_limit;
};

/// The pairs that hold in a frame, sorted: by definition and nothing else.
template <int D, typename Real>
std::vector<Pair> pairs_of(const WholeFrame<D, Real>& frame);

/// Runs an update. Returns false if it threw and counts as not taken.
using RunUpdate = std::function<bool(const std::function<void()>& update)>;

/// Hands the frames to the tracker, one after the other, and says what differs first from the events that
/// lead from each whole update's pairs to the next one's; empty if nothing does. Throws what the tracker
/// throws, but for what sinks threw. `run` makes updates fail in other ways.
template <int D, typename Real>
std::string divergence(Tracker<D, Real>& tracker, std::span<const WholeFrame<D, Real>> frames,
                       const RunUpdate& run = {});

}  // namespace broadside::laws
