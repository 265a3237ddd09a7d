// WorldState: what is behind a World: its parts, and how they change together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "broadside/box.hpp"
#include "broadside/box_view.hpp"
#include "broadside/world.hpp"

#include "world/pair_events.hpp"
#include "world/query_index.hpp"
#include "world/world_join.hpp"
#include "world/world_parts.hpp"
#include "world/world_tracker.hpp"

namespace broadside::world {

/// Members do what World's of the same name say. The caller has set the default floating-point environment.
template <int D, typename Real>
class WorldState {
 public:
  WorldState(WorldTracker<D, Real> its_tracker, const WorldOptions& options);

  /// Makes room for `count` calls of add(), with a first filter and first user data if there are such.
  void reserve(std::size_t count, bool with_filters, bool with_user_data);

  /// Adds a box that has been checked.
  Handle add(const Box<D, Real>& box, const BoxOptions& options) noexcept;

  /// Moves a box that is in the world.
  void move(std::uint32_t slot, const Box<D, Real>& box, const Point<D, Real>* velocity) {
    parts.boxes.check(box, 0, "for slot", slot);
    if (velocity != nullptr) parts.boxes.check_velocity(*velocity, 0, "for slot", slot);
    parts.boxes.reserve_changes(1);
    parts.boxes.set(slot, box, velocity);
    query_index.mark(slot);
  }

  void add(BoxView<D, Real> boxes, std::span<Handle> handles, std::span<const BoxOptions> options);
  void move(std::span<const Handle> handles, BoxView<D, Real> boxes,
            std::span<const Point<D, Real>> velocities);
  void remove(std::span<const Handle> handles);
  void shift_origin(const Point<D, Real>& origin);
  void set_filter(std::uint32_t slot, const Filter& filter);

  /// Brings the events and the pairs up to date.
  void update();

  /// Gives back memory that is not needed. After an update, before anything else changes.
  void release();

  void restore(std::span<const std::byte> bytes);
  WorldStatistics statistics() const;

  /// This world's side of a join.
  JoinSide<D, Real> join_side() const noexcept {
    return {parts.boxes.boxes(), parts.boxes.filters().values(), parts.slots.generations()};
  }

  WorldParts<D, Real> parts;
  WorldTracker<D, Real> tracker;
  bool wants_release = false;  // by the next update
  mutable WorldJoin<D, Real> joined;
  mutable QueryIndex<D, Real> query_index;

 private:
  void forget(std::uint32_t slot) noexcept;
  void deliver(PairEvents& pairs);
  void settle() noexcept;
};

}  // namespace broadside::world
