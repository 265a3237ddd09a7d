// IgnoredPairTable: the pairs of boxes that never count, and which of them changed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/filter.hpp"
#include "broadside/pair.hpp"

#include "core/grow.hpp"
#include "world/pair_graph.hpp"

namespace broadside::world {

/// A set of pairs that also finds all pairs of one box, to forget them when the box is removed. Pairs are of
/// slots. Each function is O(1) unless it says otherwise; about 100 bytes per pair.
class IgnoredPairTable {
 public:
  std::size_t size() const noexcept { return pairs_.size(); }
  bool contains(Pair pair) const noexcept { return pairs_.contains(pair); }

  /// The pairs as a tracker takes them.
  const IgnoredPairs& pairs() const noexcept { return pairs_; }

  /// The pairs that were inserted or erased since the last settle(), in that order.
  std::span<const Pair> changed() const noexcept { return changed_; }

  /// Inserts or erases a pair. Returns whether this changed the set. If it throws, nothing has changed.
  bool insert(Pair pair);
  bool erase(Pair pair);

  /// Makes room to forget the pairs of any boxes, so that forget() cannot fail.
  void reserve_forgetting() { core::make_room(changed_, edges_.size()); }

  /// Erases all pairs of a slot. O(pairs of the slot).
  void forget(std::uint32_t slot) noexcept;

  /// At the end of an update: clears changed().
  void settle() noexcept { changed_.clear(); }

  /// Gives back the memory that the pairs do not need. O(pairs).
  void shrink_to_fit();

  std::size_t bytes() const noexcept { return core::bytes_of(changed_) + edges_.bytes() + pairs_.bytes(); }

  /// Takes the pairs of a snapshot, each once.
  void restore(std::span<const Pair> pairs, std::vector<Pair> changed);

 private:
  IgnoredPairs pairs_;
  PairGraph edges_;  // the same, by slot
  std::vector<Pair> changed_;
};

}  // namespace broadside::world
