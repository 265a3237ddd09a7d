// PairEvents: pairs that begin and pairs that end, on their way to the caller.
#pragma once

#include <cstddef>
#include <vector>

#include "broadside/pair.hpp"

#include "core/grow.hpp"

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

  /// The events without pairs in both lists, which were undone before they were delivered. Sorted.
  PairEvents netted() const;

  /// The pairs that held before the events if `pairs` hold after them. All are sorted.
  std::vector<Pair> undone(const std::vector<Pair>& pairs) const;

  void shrink_to_fit() { core::shrink(begun, ended); }
  std::size_t bytes() const noexcept { return core::bytes_of(begun, ended); }
};

/// The pairs that are in exactly one of the two. All are sorted.
std::vector<Pair> symmetric_difference(const std::vector<Pair>& a, const std::vector<Pair>& b);

}  // namespace broadside::world
