// World: boxes that come, move and go under stable handles, and the pairs that begin and end. The face for
// engines.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"
#include "broadside/broad_phase.hpp"

namespace broadside {

/// Names one box of a world for as long as it lives. A slot is used again, under another generation.
struct Handle {
  std::uint32_t slot = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t generation = 0;

  friend constexpr auto operator<=>(const Handle&, const Handle&) = default;
};

/// Two boxes of a world; first.slot < second.slot.
struct HandlePair {
  Handle first;
  Handle second;

  friend constexpr auto operator<=>(const HandlePair&, const HandlePair&) = default;
};

/// What one update brought, sorted by slots. Valid until the next update of the world it came from.
struct Events {
  std::span<const HandlePair> begun;
  std::span<const HandlePair> ended;
};

/// A set of boxes that changes, and its overlapping pairs.
///
/// Of boxes of floats or of doubles. add(), move() and remove() cost O(1) and show their effect on pairs at
/// the next update(). One thread at a time; several may read between updates. A world that was moved from may
/// only be assigned to or destroyed.
template <int D, typename Real = float>
class World {
 public:
  /// A world whose pairs are found by one of the library's algorithms. Throws InvalidSpec.
  explicit World(std::string_view spec = default_algorithm);

  /// A world over a tracker of the caller's.
  explicit World(std::unique_ptr<PairTracker<D, Real>> tracker);

  /// Adds a box and names it. Throws InvalidInput if the box has a NaN or min > max.
  Handle add(const Box<D, Real>& box);

  /// Replaces a box. Throws InvalidHandle if it is not in the world, InvalidInput as add() does.
  void move(Handle handle, const Box<D, Real>& box);

  /// Takes a box out. Its pairs end at the next update. Throws InvalidHandle if it is not in the world.
  void remove(Handle handle);

  /// Who does the work of update(): one thread, unless the spec or set_workers() says otherwise.
  const Workers& workers() const noexcept { return tracker_->workers(); }
  void set_workers(const Workers& workers) { tracker_->set_workers(workers); }

  /// Brings the pairs up to date. Cost: the tracker's, and one pass over the current pairs if any began or
  /// ended.
  Events update();

  /// The pairs that hold since the last update, sorted by slots. Valid until the next update.
  std::span<const HandlePair> pairs() const noexcept { return pairs_; }

  /// Whether the box is in the world: added and not removed.
  bool contains(Handle handle) const noexcept;

  /// The box as it was last set. A removed one stays readable until the update after the one that reported
  /// its removal, so that whoever handles its ended pairs can look at it. The reference holds until the next
  /// add(), remove() or update(). Throws InvalidHandle.
  const Box<D, Real>& box(Handle handle) const;

  /// The number of boxes in the world.
  std::size_t size() const noexcept { return size_; }

 private:
  enum class SlotState : std::uint8_t { free, live, removed, reported };

  struct Slot {
    std::uint32_t generation = 0;
    SlotState state = SlotState::free;
    bool changed = false;
  };

  void mark_changed(std::uint32_t slot);
  [[noreturn]] void refuse(Handle handle, const char* action) const;
  void collect(std::span<const Pair> pairs, std::vector<HandlePair>& handles) const;

  std::unique_ptr<PairTracker<D, Real>> tracker_;
  std::vector<Box<D, Real>> boxes_;  // by slot; absent where nothing lives
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> removed_;                          // since the last update
  std::vector<std::uint32_t> reported_;                         // whose removal the last update reported
  std::unordered_map<std::uint32_t, Box<D, Real>> last_boxes_;  // of those two
  std::vector<BoxId> changed_;
  std::vector<Pair> begun_ids_;
  std::vector<Pair> ended_ids_;
  std::vector<HandlePair> begun_;
  std::vector<HandlePair> ended_;
  std::vector<HandlePair> pairs_;
  std::vector<HandlePair> merged_;
  std::size_t size_ = 0;
};

using World2 = World<2>;
using World3 = World<3>;
using DoubleWorld2 = World<2, double>;
using DoubleWorld3 = World<3, double>;

}  // namespace broadside
