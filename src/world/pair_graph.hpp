// A set of pairs that finds a pair, and all pairs of a box, at once: edges in lists, one list for each box,
// and a hash table over them (open addressing, linear probing, deletion by shifting back: Knuth, TAOCP
// 3, 6.4, algorithm R).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "broadside/pair.hpp"

namespace broadside::world {

/// Pairs with a mark each. All O(1) unless they say otherwise; some 40 to 50 bytes a pair.
class PairGraph {
 public:
  using EdgeId = std::uint32_t;

  /// No edge.
  static constexpr EdgeId none = std::numeric_limits<EdgeId>::max();

  /// The owner's data about a pair.
  struct Mark {
    bool overlaps = false;    ///< whether the boxes themselves overlap
    bool accepted = false;    ///< what the predicate said since they do
    std::uint32_t stamp = 0;  ///< of the update that looked at it last
  };

  std::size_t size() const noexcept { return size_; }
  bool contains(Pair pair) const noexcept { return find(pair) != none; }

  /// Makes room for `size` pairs, and for boxes below `boxes`: inserting these does not throw.
  void reserve(std::size_t size, std::size_t boxes);

  /// Puts in a pair that is not there. Throws std::bad_alloc, and then has changed nothing.
  EdgeId insert(Pair pair);

  /// Takes an edge out.
  void erase(EdgeId edge) noexcept;

  /// The pair's edge, or `none`.
  EdgeId find(Pair pair) const noexcept;

  Pair pair(EdgeId edge) const noexcept { return edges_[edge].pair; }
  Mark& mark(EdgeId edge) noexcept { return edges_[edge].mark; }
  const Mark& mark(EdgeId edge) const noexcept { return edges_[edge].mark; }

  /// Calls `visit(edge)` for each edge of a box; it may erase that edge.
  template <typename Visit>
  void for_each_of(BoxId box, Visit visit) const {
    if (index(box) >= first_.size()) return;
    for (EdgeId edge = first_[index(box)]; edge != none;) {
      const Edge& current = edges_[edge];
      const EdgeId next = current.next[current.pair.first == box ? 0 : 1];
      visit(edge);
      edge = next;
    }
  }

  /// Calls `visit(edge)` for each edge. O(the most edges there were since the last shrink_to_fit()).
  template <typename Visit>
  void for_each(Visit visit) const {
    for (EdgeId edge = 0; edge < edges_.size(); ++edge) {
      if (edges_[edge].pair.first != edges_[edge].pair.second) visit(edge);
    }
  }

  /// Gives back the memory that its pairs do not need. O(size).
  void shrink_to_fit();

  std::size_t bytes() const noexcept;

 private:
  /// A free edge has two equal boxes, and the next of the free list in next[0].
  struct Edge {
    Pair pair;
    std::array<EdgeId, 2> next;  ///< in the list of its first box, and of its second
    std::array<EdgeId, 2> previous;
    Mark mark;
  };

  std::size_t home(Pair pair) const noexcept;
  void link(EdgeId edge, int side, BoxId box) noexcept;
  void unlink(EdgeId edge, int side, BoxId box) noexcept;
  void rehash(std::size_t places);

  std::vector<Edge> edges_;
  std::vector<EdgeId> first_;  // of each box
  std::vector<EdgeId> table_;  // a power of two; load factor at most 1/2
  EdgeId free_ = none;
  std::size_t size_ = 0;
};

}  // namespace broadside::world
