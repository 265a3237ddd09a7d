// Frames with every input that a tracker can get (boxes, filters, ignored pairs, failing sinks), and the
// expected output by definition.
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

/// A complete frame, not a difference, so that any frame can be left out and the rest is still a history.
template <int D, typename Real = float>
struct WholeFrame {
  std::vector<Box<D, Real>> boxes;
  std::vector<Filter> filters{};               ///< one for each box, or none
  std::optional<std::vector<Pair>> ignored{};  ///< sorted; nullopt: a null pointer
  std::vector<BoxId> listed{};                 ///< unchanged boxes that are reported as changed
  std::size_t begun_room = no_limit;           ///< capacity of each sink, beyond which it throws
  std::size_t ended_room = no_limit;
};

/// The pairs of a frame by definition, sorted.
template <int D, typename Real>
std::vector<Pair> pairs_of(const WholeFrame<D, Real>& frame);

/// Runs an update. Returns false if it threw and does not count.
using RunUpdate = std::function<bool(const std::function<void()>& update)>;

/// Passes the frames to the tracker in order, and describes the first difference from the expected events,
/// which lead from the pairs of each completed update to those of the next; empty if all agree. Exceptions of
/// the tracker propagate, except those of the sinks. `run` makes updates fail in other ways.
template <int D, typename Real>
std::string divergence(Tracker<D, Real>& tracker, std::span<const WholeFrame<D, Real>> frames,
                       const RunUpdate& run = {});

}  // namespace broadside::laws
