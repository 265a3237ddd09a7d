// The pairs that hold now, sorted: an array, and a log of the events that it has not taken in yet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/pair.hpp"
#include "broadside/world.hpp"

namespace broadside::core {

/// An event toggles a pair, so a pair counts as changed if the log has it an odd number of times.
class CurrentPairs {
 public:
  /// The generation of each slot.
  using Generations = std::span<const std::uint32_t>;

  /// The pairs that hold, with what is in the log.
  std::size_t size() const noexcept { return size_; }

  /// Whether pairs() is up to date.
  bool is_merged() const noexcept { return log_.empty(); }

  /// Takes the events of an update, each of the two sorted. O(events), and where the log has grown too long
  /// for the array, merge(). If it throws, nothing has changed.
  void add(std::span<const Pair> begun, std::span<const Pair> ended, Generations generations);

  /// Brings the array up to date. O(log), and a pass over the array where the log is not empty.
  void merge(Generations generations);

  /// Sorted by slots; valid until the next call of a member that is not const. Those as of the last merge().
  std::span<const HandlePair> pairs() const noexcept { return pairs_; }

  /// Gives back memory that is not needed. After merge().
  void shrink_to_fit();

  std::size_t bytes() const noexcept {
    return pairs_.capacity() * sizeof(HandlePair) + (log_.capacity() + scratch_.capacity()) * sizeof(Pair);
  }

 private:
  std::size_t keep_toggled(Generations generations);
  void toggle(std::size_t count, Generations generations);
  std::size_t drop_ended(std::size_t count);
  void insert_begun(std::size_t count, Generations generations);

  std::vector<HandlePair> pairs_;
  std::vector<Pair> log_;
  std::vector<Pair> scratch_;
  std::size_t size_ = 0;
};

}  // namespace broadside::core
