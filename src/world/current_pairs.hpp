// CurrentPairs: the pairs that hold now, and the events of the last update.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "broadside/pair.hpp"
#include "broadside/world.hpp"

#include "world/pair_events.hpp"
#include "world/slot_column.hpp"
#include "world/slot_table.hpp"

namespace broadside::world {

/// The keys of the pairs are in a sorted array. An update with many events brings it up to date; events of
/// other updates wait in a log until there are many, or somebody reads the pairs. The first reader after an
/// update also gives the pairs their handles; several threads may read at once.
class CurrentPairs {
 public:
  /// Without `keeps` it only counts the pairs.
  explicit CurrentPairs(bool keeps) noexcept : keeps_(keeps) {}
  CurrentPairs& operator=(CurrentPairs&& other) noexcept;

  bool keeps() const noexcept { return keeps_; }

  /// The number of pairs that hold.
  std::size_t size() const noexcept { return size_; }

  /// The events of the last update, with the handles and the user data that the boxes had in it.
  Events events() const noexcept {
    return {events_.begun, events_.ended, events_.begun_data, events_.ended_data};
  }

  /// Takes the events of an update out of `events`, both lists sorted. O(events), plus a pass over the array
  /// if the log has grown too long for it. If it throws, nothing has changed.
  void take(PairEvents& events, Generations generations, const SlotColumn<std::uint64_t>& user_data);

  /// The pairs that hold, sorted by slots, and the ones among them that did not begin in the last update.
  /// Only if pairs are kept. Valid until the next call of a non-const member. O(events since the last call),
  /// plus a pass over the pairs if there were any.
  std::span<const HandlePair> pairs(Generations generations) const;
  std::span<const HandlePair> persisting(Generations generations) const;

  /// The same pairs as pairs(), without handles.
  std::vector<Pair> slot_pairs() const;

  /// Gives back memory that is not needed. O(pairs).
  void shrink_to_fit();

  std::size_t bytes() const;

  /// Takes the sorted pairs of a snapshot, their number `size` (even if they are not kept), and the events of
  /// its last update.
  void restore(std::span<const Pair> pairs, std::size_t size, const PairEvents& events,
               Generations generations);

 private:
  struct DeliveredEvents {
    std::vector<HandlePair> begun{};
    std::vector<HandlePair> ended{};
    std::vector<UserDataPair> begun_data{};  ///< empty without user data
    std::vector<UserDataPair> ended_data{};
  };

  void keep(const PairEvents& events);
  void merge() const;
  void apply(std::span<const Pair> begun, std::span<const Pair> ended) const;

  bool keeps_;
  std::size_t size_ = 0;
  DeliveredEvents events_;
  BufferWatch watch_;
  mutable std::mutex reading_;
  mutable std::vector<std::uint64_t> keys_;
  mutable PairEvents log_;  // neither list is sorted; a pair may begin and end several times
  mutable std::vector<std::uint64_t> spare_;  // for the next state of pairs_
  mutable std::vector<Pair> scratch_;         // to sort the log
  mutable std::vector<HandlePair> handles_;   // of the pairs
  mutable std::vector<HandlePair> persisting_;
  mutable std::atomic<bool> has_handles_ = true;      // handles_ is up to date
  mutable std::atomic<bool> has_persisting_ = false;  // persisting_ is up to date
};

}  // namespace broadside::world
