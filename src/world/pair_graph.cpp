// PairGraph: a set of pairs with fast lookup of a pair and of all pairs of a box.
#include "world/pair_graph.hpp"

#include <algorithm>
#include <bit>
#include <new>
#include <utility>

#include "broadside/sinks.hpp"

#include "core/grow.hpp"

namespace broadside::world {

std::size_t PairGraph::home(Pair pair) const noexcept { return hash(pair) & (table_.size() - 1); }

/// Where the pair is, or the free place where it would be. The table must not be empty.
std::size_t PairGraph::place_of(Pair pair) const noexcept {
  std::size_t place = home(pair);
  while (table_[place] != none && pairs_[table_[place]] != pair) place = (place + 1) & (table_.size() - 1);
  return place;
}

void PairGraph::reserve(std::size_t size, std::size_t boxes) {
  if (size >= none / 2) throw std::bad_alloc();
  if (first_.size() < boxes) first_.resize(boxes, none);
  const auto make_room = [size](auto& edges) {
    if (edges.capacity() < size) edges.reserve(size + size / 8);
  };
  make_room(pairs_);
  make_room(marks_);
  make_room(links_);
  if (table_.size() < 2 * size) rehash(std::bit_ceil(std::max<std::size_t>(2 * size, 16)));
}

/// Makes two ends neighbours in the list of a box; either may be `none`.
void PairGraph::join(End previous, End next, BoxId box) noexcept {
  (previous == none ? first_[index(box)] : links_[previous / 2].next[previous % 2]) = next;
  if (next != none) links_[next / 2].previous[next % 2] = previous;
}

PairGraph::EdgeId PairGraph::insert(Pair pair, std::uint8_t mark) {
  reserve(size() + 1, std::size_t{index(pair.second)} + 1);
  const auto edge = static_cast<EdgeId>(size());
  table_[place_of(pair)] = edge;
  pairs_.push_back(pair);
  marks_.push_back(mark);
  links_.emplace_back();
  for (const End side : {0U, 1U}) {
    const BoxId box = side == 0 ? pair.first : pair.second;
    join(2 * edge + side, first_[index(box)], box);
    join(none, 2 * edge + side, box);
  }
  return edge;
}

void PairGraph::erase(EdgeId edge) noexcept {
  const Pair pair = pairs_[edge];
  std::size_t hole = place_of(pair);
  const std::size_t mask = table_.size() - 1;
  // Entries after the hole move into it, unless it is before their home.
  for (std::size_t place = (hole + 1) & mask; table_[place] != none; place = (place + 1) & mask) {
    const std::size_t distance = (place - home(pairs_[table_[place]])) & mask;
    if (distance >= ((place - hole) & mask)) table_[std::exchange(hole, place)] = table_[place];
  }
  table_[hole] = none;
  for (const End side : {0U, 1U})
    join(links_[edge].previous[side], links_[edge].next[side], side == 0 ? pair.first : pair.second);
  // The last edge takes the id of the erased one.
  const auto last = static_cast<EdgeId>(size() - 1);
  if (edge != last) {
    const Pair moved = pairs_[last];
    table_[place_of(moved)] = edge;
    pairs_[edge] = moved;
    marks_[edge] = marks_[last];
    links_[edge] = links_[last];
    for (const End side : {0U, 1U}) {
      const BoxId box = side == 0 ? moved.first : moved.second;
      join(links_[edge].previous[side], 2 * edge + side, box);
      join(2 * edge + side, links_[edge].next[side], box);
    }
  }
  pairs_.pop_back();
  marks_.pop_back();
  links_.pop_back();
}

void PairGraph::rehash(std::size_t places) {
  table_ = std::vector<EdgeId>(places, none);
  for (EdgeId edge = 0; edge < size(); ++edge) table_[place_of(pairs_[edge])] = edge;
}

void PairGraph::shrink_to_fit() {
  while (!first_.empty() && first_.back() == none) first_.pop_back();
  core::shrink(pairs_, marks_, links_, first_);
  rehash(pairs_.empty() ? 0 : std::bit_ceil(std::max<std::size_t>(2 * size(), 16)));
}

std::size_t PairGraph::bytes() const noexcept {
  return core::bytes_of(pairs_, marks_, links_, first_, table_);
}

}  // namespace broadside::world
