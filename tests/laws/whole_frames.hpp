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
  std::optional<std::vector<Pair>> ignored{};  ///< sorted; nullopt: a null pointer
  std::vector<BoxId> listed{};                 ///< boxes reported as changed besides those that are
  std::size_t begun_room = no_limit;           ///< capacity of each sink, beyond which it throws
  std::size_t ended_room = no_limit;
};

/// The places that changed from one frame to the next, as a caller would list them: in any order; those of
/// boxes that are new need not be, and no filters where the frame before had none or this one has none.
template <int D, typename Real>
std::vector<BoxId> changed_places(const WholeFrame<D, Real>& from, const WholeFrame<D, Real>& to);

/// The pairs of a frame by definition, sorted.
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
