// SlotTable: the slots of a world, and the handles that name the boxes in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"
#include "broadside/world.hpp"

#include "core/grow.hpp"
#include "world/slot_set.hpp"

namespace broadside::world {

/// A slot is free, live, removed (no update has reported it yet), reported (the last update reported the
/// removal, and the box can still be read), and free again; or retired, if its generations are used up.
enum class SlotState : std::uint8_t { free, live, removed, reported, retired };

/// The generation of each slot.
using Generations = std::span<const std::uint32_t>;

inline Pair slots_of(const HandlePair& pair) noexcept {
  return {BoxId{pair.first.slot}, BoxId{pair.second.slot}};
}

inline std::vector<Pair> slots_of(std::span<const HandlePair> handles) {
  std::vector<Pair> pairs;
  pairs.reserve(handles.size());
  for (const HandlePair& pair : handles) pairs.push_back(slots_of(pair));
  return pairs;
}

inline HandlePair handles_of(Pair pair, Generations generations) noexcept {
  return {{index(pair.first), generations[index(pair.first)]},
          {index(pair.second), generations[index(pair.second)]}};
}

/// The number of handles of a long list that are looked at together.
inline constexpr std::size_t handles_at_once = 64;

/// Whether the handles are of consecutive slots from `first` on.
inline bool are_in_a_row(std::span<const Handle> handles, std::uint32_t first) noexcept {
  std::uint32_t differing = 0;
  for (std::size_t i = 0; i < handles.size(); ++i)
    differing |= handles[i].slot ^ (first + static_cast<std::uint32_t>(i));
  return differing == 0;
}

/// A box that was removed and can still be read.
template <int D, typename Real>
struct RemovedBox {
  std::uint32_t slot;
  Box<D, Real> box;
};

/// Hands out slots with generations, so that no handle ever names a second box. New boxes get the lowest
/// free slot, which keeps arrays by slot dense. Each function is O(1) unless it says otherwise.
template <int D, typename Real>
class SlotTable {
 public:
  using Removed = RemovedBox<D, Real>;

  /// A table without slots. `first_generation` is the generation of the first handles.
  explicit SlotTable(std::uint32_t first_generation) noexcept
      : table_generation_(first_generation), first_generation_(first_generation) {}

  /// The number of slots, including free ones.
  std::size_t size() const noexcept { return states_.size(); }

  /// The number of boxes in the world.
  std::size_t live() const noexcept { return live_; }

  SlotState state(std::uint32_t slot) const noexcept { return states_[slot]; }
  std::span<const SlotState> states() const noexcept { return states_; }
  Generations generations() const noexcept { return generations_; }

  /// The generation of slots that do not exist yet: above that of any slot that was dropped.
  std::uint32_t first_generation() const noexcept { return first_generation_; }

  Handle handle(BoxId id) const noexcept { return {index(id), generations_[index(id)]}; }

  bool is_live(Handle handle) const noexcept {
    return handle.slot < generations_.size() && generations_[handle.slot] == handle.generation &&
           states_[handle.slot] == SlotState::live;
  }

  /// Whether all boxes are in the world.
  bool are_live(std::span<const Handle> handles) const noexcept;

  /// Whether the slot may be part of a pair that holds, or of a pair that has ended and is not reported yet.
  bool is_paired(std::uint32_t slot) const noexcept {
    return states_[slot] == SlotState::live || states_[slot] == SlotState::removed;
  }

  /// The slot of a box in the world. Throws InvalidHandle, which names the `action`, if it is not there.
  std::uint32_t live_slot(Handle handle, const char* action) const {
    if (!is_live(handle)) refuse(handle, action);
    return handle.slot;
  }

  /// The slot of a box that can be read: one in the world, or removed a short while ago. Throws
  /// InvalidHandle.
  std::uint32_t readable_slot(Handle handle) const;

  /// The box that was removed from a slot that is removed or reported; null for other slots.
  const Box<D, Real>* removed_box(std::uint32_t slot) const noexcept;

  /// Throws InvalidHandle, which says why the handle names no box. `times` follows "a box", as in "a box
  /// twice".
  [[noreturn]] void refuse(Handle handle, const char* action, const char* times = "") const;

  /// Makes room for `count` calls of add(), and returns how many slots they will append. Throws InvalidFrame
  /// if there would be more slots than ids.
  std::size_t reserve(std::size_t count);

  /// The slot that add() will give: the lowest free one, or size().
  std::uint32_t next() const noexcept {
    return free_.empty() ? static_cast<std::uint32_t>(states_.size()) : free_.lowest();
  }

  Handle add() noexcept;

  /// Removes the boxes of all handles or, if one handle is refused, none. `boxes` are by slot. Returns these
  /// removals. Throws InvalidHandle.
  std::span<const Removed> remove(std::span<const Handle> handles, std::span<const Box<D, Real>> boxes);

  /// The removals since the last update, and the removals that the last update reported.
  std::span<Removed> removed() noexcept { return removed_; }
  std::span<const Removed> removed() const noexcept { return removed_; }
  std::span<Removed> reported() noexcept { return reported_; }
  std::span<const Removed> reported() const noexcept { return reported_; }

  /// At the end of an update: frees the slots that the previous update reported, and marks the removed ones
  /// as reported. O(removals).
  void recycle() noexcept;

  /// Drops free slots at the end once many slots are free (hysteresis: a few that come and go cost nothing).
  /// Returns whether any was dropped.
  bool trim() noexcept;

  /// Whether most of the slots that memory was taken for are gone.
  bool is_mostly_gone() const noexcept;

  /// Gives back the memory that the slots do not need. O(slots).
  void shrink_to_fit();

  /// The bytes of slots, and of removed boxes.
  std::size_t bytes() const noexcept {
    return core::bytes_of(generations_, places_, states_) + free_.bytes();
  }
  std::size_t removed_bytes() const noexcept { return core::bytes_of(removed_, reported_); }

  /// Takes the checked slots of a snapshot.
  void restore(std::uint32_t first_generation, std::vector<std::uint32_t> generations,
               std::vector<SlotState> states, std::vector<Removed> removed, std::vector<Removed> reported);

 private:
  bool are_live_in_a_row(std::span<const Handle> handles) const noexcept;

  std::vector<std::uint32_t> generations_;
  std::vector<std::uint32_t> places_;  // in removed_ or reported_
  std::vector<SlotState> states_;
  SlotSet free_;
  std::vector<Removed> removed_;
  std::vector<Removed> reported_;
  std::uint32_t table_generation_;  // of this table's first handles
  std::uint32_t first_generation_;
  std::size_t live_ = 0;
  std::size_t max_slots_ = 0;  // since memory was last given back
};

}  // namespace broadside::world
