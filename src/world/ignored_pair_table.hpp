// IgnoredPairTable: the pairs of boxes that never count, and which of them are new.
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
/// slots. All O(1) unless they say otherwise; some 100 bytes a pair.
class IgnoredPairTable {
 public:
  std::size_t size() const noexcept { return pairs_.size(); }
  bool contains(Pair pair) const noexcept { return pairs_.contains(pair); }

  /// The pairs as a tracker takes them.
  const IgnoredPairs& pairs() const noexcept { return pairs_; }

  /// The pairs that were put in or taken out since the last settle(), in that order.
  std::span<const Pair> changed() const noexcept { return changed_; }

  /// Puts a pair in, or takes it out. Returns whether it was not so already. If it throws, nothing has
  /// changed.
  bool insert(Pair pair);
  bool erase(Pair pair);

  /// Makes room for forgetting the pairs of any boxes: forget() does not throw.
  void reserve_forgetting() { core::make_room(changed_, edges_.size()); }

  /// Takes all pairs of a slot out. O(pairs of the slot).
  void forget(std::uint32_t slot) noexcept;

  /// At the end of an update: nothing has changed since.
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
