// WorldParts: the parts of a world that its future depends on. Its snapshots hold them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "broadside/pair.hpp"
#include "broadside/tracker.hpp"
#include "broadside/world.hpp"

#include "core/lean.hpp"
#include "world/box_table.hpp"
#include "world/current_pairs.hpp"
#include "world/delivered_events.hpp"
#include "world/ignored_pair_table.hpp"
#include "world/pair_refiner.hpp"
#include "world/slot_column.hpp"
#include "world/slot_table.hpp"

namespace broadside::world {

/// Arrays by slot are all as long as `slots`.
template <int D, typename Real>
struct WorldParts {
  /// An empty world. Throws std::invalid_argument, as BoxTable does.
  explicit WorldParts(const WorldOptions& its_options)
      : options(its_options),
        slots(options.first_generation),
        boxes(options),
        refiner(boxes.refines()),
        current(options.keep_pairs) {}

  WorldOptions options;
  SlotTable<D, Real> slots;
  BoxTable<D, Real> boxes;
  SlotColumn<std::uint64_t> user_data;  // in use from the first one on that is not 0
  IgnoredPairTable ignored;
  PairRefiner<D, Real> refiner;
  CurrentPairs current;
  DeliveredEvents events;
  bool has_updated = false;
  bool update_failed = false;  // the last update did, or is in progress

  bool keeps_user_data() const noexcept { return !core::is_lean && user_data.is_used(); }

  /// Whether nothing has changed since the last update, and that one did not fail.
  bool is_settled() const noexcept {
    return !update_failed && boxes.changed().empty() && ignored.changed().empty();
  }

  /// What the tracker is to be shown.
  Frame<D, Real> frame() const noexcept {
    Frame<D, Real> frame;
    frame.boxes = boxes.shown();
    frame.changed = boxes.shown_changes();
    frame.filters = boxes.filters().values();
    frame.ignored = &ignored.pairs();
    frame.ignored_changed = ignored.changed();
    return frame;
  }

  /// The pairs that the tracker found by its last whole update, sorted; nothing where they are not kept.
  std::optional<std::vector<Pair>> tracked_pairs() const {
    if (!refiner.is_refining() && !current.keeps()) return std::nullopt;
    std::vector<Pair> pairs;
    if (!refiner.is_refining()) {
      for (const HandlePair& pair : current.pairs(slots.generations()))
        pairs.push_back({BoxId{pair.first.slot}, BoxId{pair.second.slot}});
    }
    return refiner.tracked(std::move(pairs));
  }
};

}  // namespace broadside::world
