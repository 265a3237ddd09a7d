// DeliveredEvents: what the last update of a world brought.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/pair.hpp"
#include "broadside/world.hpp"

#include "core/grow.hpp"
#include "world/pair_events.hpp"
#include "world/slot_column.hpp"

namespace broadside::world {

/// Pairs with the handles and the user data that their boxes had in that update.
class DeliveredEvents {
 public:
  std::span<const HandlePair> begun() const noexcept { return begun_; }
  std::span<const HandlePair> ended() const noexcept { return ended_; }
  Events view() const noexcept { return {begun_, ended_, begun_data_, ended_data_}; }

  /// Makes room for what set() takes, which then does not throw.
  void reserve(const PairEvents& events, bool with_user_data);

  /// Replaces the events by others, of slots with these generations.
  void set(const PairEvents& events, std::span<const std::uint32_t> generations,
           const SlotColumn<std::uint64_t>& user_data) noexcept;

  /// Takes the events of a snapshot.
  void restore(std::vector<HandlePair> begun, std::vector<HandlePair> ended) noexcept;

  void shrink_to_fit() { core::shrink(begun_, ended_, begun_data_, ended_data_); }
  std::size_t bytes() const noexcept { return core::bytes_of(begun_, ended_, begun_data_, ended_data_); }

 private:
  std::vector<HandlePair> begun_;
  std::vector<HandlePair> ended_;
  std::vector<UserDataPair> begun_data_;  // empty without user data
  std::vector<UserDataPair> ended_data_;
};

}  // namespace broadside::world
