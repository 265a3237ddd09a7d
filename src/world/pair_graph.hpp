// PairGraph: a set of pairs with fast lookup of a pair and of all pairs of a box.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "broadside/pair.hpp"

namespace broadside::world {

/// Pairs are the edges of a graph of boxes. Arrays by edge hold them without gaps; each box has a list of its
/// edges, and a hash table finds the edge of a pair (open addressing, linear probing, deletion by shifting
/// back: Knuth, TAOCP 3, 6.4, algorithm R). Each function is O(1) unless it says otherwise; 40 to 55 bytes
/// per pair.
class PairGraph {
 public:
  /// An index below size(). Erasing an edge gives its id to the last one.
  using EdgeId = std::uint32_t;

  /// No edge.
  static constexpr EdgeId none = std::numeric_limits<EdgeId>::max();

  std::size_t size() const noexcept { return pairs_.size(); }
  bool contains(Pair pair) const noexcept { return find(pair) != none; }

  /// The pairs by edge, and a byte for each pair, for the owner's use.
  std::span<const Pair> pairs() const noexcept { return pairs_; }
  std::span<const std::uint8_t> marks() const noexcept { return marks_; }
  std::uint8_t& mark(EdgeId edge) noexcept { return marks_[edge]; }

  /// Sets an edge's stamp. Returns whether it was a different one.
  bool renew_stamp(EdgeId edge, std::uint32_t stamp) noexcept {
    return std::exchange(links_[edge].stamp, stamp) != stamp;
  }

  /// Makes room for `size` pairs, and for boxes below `boxes`: inserting these does not throw.
  void reserve(std::size_t size, std::size_t boxes);

  /// Inserts a new pair. If it throws std::bad_alloc, nothing has changed.
  EdgeId insert(Pair pair, std::uint8_t mark = 0);

  void erase(EdgeId edge) noexcept;

  /// The pair's edge, or `none`.
  EdgeId find(Pair pair) const noexcept { return table_.empty() ? none : table_[place_of(pair)]; }

  /// An edge of the box, or `none`.
  EdgeId first_of(BoxId box) const noexcept {
    return index(box) < first_.size() && first_[index(box)] != none ? first_[index(box)] / 2 : none;
  }

  /// Calls `visit(edge)` for each edge of a box. O(its edges).
  template <typename Visit>
  void for_each_of(BoxId box, Visit visit) const {
    if (index(box) >= first_.size()) return;
    for (End end = first_[index(box)]; end != none; end = links_[end / 2].next[end % 2]) visit(end / 2);
  }

  /// Gives back the memory that its pairs do not need. O(size).
  void shrink_to_fit();

  std::size_t bytes() const noexcept;

 private:
  /// One of the two ends of an edge: twice its id, and 1 more for the end at the second box.
  using End = std::uint32_t;

  struct Links {
    std::array<End, 2> next;  ///< in the lists of its first box and of its second
    std::array<End, 2> previous;
    std::uint32_t stamp;
  };

  std::size_t home(Pair pair) const noexcept;
  std::size_t place_of(Pair pair) const noexcept;
  void join(End previous, End next, BoxId box) noexcept;
  void rehash(std::size_t places);

  std::vector<Pair> pairs_;
  std::vector<std::uint8_t> marks_;
  std::vector<Links> links_;
  std::vector<End> first_;     // by box
  std::vector<EdgeId> table_;  // a power of two; load factor at most 1/2
};

}  // namespace broadside::world
