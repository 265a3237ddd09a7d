// PairEvents: pairs that begin and pairs that end, on their way to the caller.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
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

/// Tells when buffers that are filled in each update have long been far larger than needed, as after the
/// first update of a large world.
class BufferWatch {
 public:
  /// To be called in each update with the number of elements used and the number reserved.
  bool wastes(std::size_t used, std::size_t reserved) noexcept {
    max_used_ = std::max(max_used_, used);
    if (++updates_ < watched_updates) return false;
    updates_ = 0;
    return reserved > min_reserved && std::exchange(max_used_, 0) < reserved / 8;
  }

 private:
  static constexpr unsigned watched_updates = 16;
  static constexpr std::size_t min_reserved = 4096;

  std::size_t max_used_ = 0;
  unsigned updates_ = 0;
};

/// The pairs that are in exactly one of the two. All are sorted.
std::vector<Pair> symmetric_difference(const std::vector<Pair>& a, const std::vector<Pair>& b);

}  // namespace broadside::world
