// WorldState: the parts of a world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"
#include "broadside/world.hpp"

#include "world/box_table.hpp"
#include "world/current_pairs.hpp"
#include "world/ignored_pair_table.hpp"
#include "world/pair_refiner.hpp"
#include "world/query_index.hpp"
#include "world/slot_column.hpp"
#include "world/slot_table.hpp"
#include "world/world_tracker.hpp"

namespace broadside::world {

/// The parts that a world's future depends on: its snapshots hold them. All arrays by slot are as long as
/// `slots`.
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
  SlotColumn<std::uint64_t> user_data;  // in use from the first value on that is not 0
  IgnoredPairTable ignored;
  PairRefiner refiner;
  CurrentPairs current;
  bool has_updated = false;
  bool update_failed = false;  // the last update failed, or is in progress

  /// Whether the last update did not fail and nothing has changed since.
  bool is_settled() const noexcept {
    return !update_failed && boxes.changed().empty() && ignored.changed().empty();
  }

  /// The next frame for the tracker.
  Frame<D, Real> frame() const noexcept {
    return {boxes.shown(), boxes.shown_changes(), boxes.filters().values(), &ignored.pairs(),
            ignored.changed()};
  }
};

/// Everything that a world holds. Functions do what World's of the same name do, after World's checks.
template <int D, typename Real>
struct WorldState {
  WorldState(WorldTracker<D, Real> its_tracker, const WorldOptions& options)
      : parts(options), tracker(std::move(its_tracker)) {}

  /// Throws std::logic_error if the world's own predicate calls `function`, which would change the world.
  void refuse_from_predicate(const char* function) const;

  /// Makes room for `count` calls of add(), and begins to use filters and user data if asked to.
  void reserve(std::size_t count, bool with_filters, bool with_user_data);

  /// Adds a box that has been checked.
  Handle add(const Box<D, Real>& box, const BoxOptions& options) noexcept;

  void add(BoxView<D, Real> boxes, std::span<Handle> handles, std::span<const BoxOptions> options);
  void shift_origin(const Point<D, Real>& origin);

  /// Gives back unused memory: always, or if it is due. To be called after an update, before anything else
  /// changes.
  void release();
  void release_if_due() noexcept;

  void set_overlap_flags(std::span<const HandlePair> pairs, std::span<std::uint8_t> flags) const;
  void join(const WorldState& other, detail::Output<HandlePair>& pairs);
  WorldStatistics statistics() const;
  void restore(std::span<const std::byte> bytes);

  WorldParts<D, Real> parts;
  WorldTracker<D, Real> tracker;
  QueryIndex<D, Real> query_index;
  std::mutex joining;
  std::optional<Finder<D, Real>> joiner;  // none until worlds are joined
  bool wants_release = false;             // by the next update
  bool is_updating = false;
};

}  // namespace broadside::world
