// PairEvents: pairs that begin and pairs that end, on their way to the caller.
#pragma once

#include <cstddef>
#include <vector>

#include "broadside/pair.hpp"

namespace broadside::world {

/// Events that no update has delivered yet. After an update that failed they wait for the next one.
struct PairEvents {
  std::vector<Pair> begun;
  std::vector<Pair> ended;

  bool empty() const noexcept { return begun.empty() && ended.empty(); }
  void clear() noexcept {
    begun.clear();
    ended.clear();
  }

  /// Takes from both what is in both: events that were undone before they were delivered. Sorts both.
  void cancel();

  /// A copy after cancel(): an update that ran out of memory may not have come to that.
  PairEvents netted() const;

  void shrink_to_fit();
  std::size_t bytes() const noexcept;
};

/// The pairs that are in one of the two and not in the other; all sorted.
std::vector<Pair> symmetric_difference(const std::vector<Pair>& a, const std::vector<Pair>& b);

}  // namespace broadside::world
