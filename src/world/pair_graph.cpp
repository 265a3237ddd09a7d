// A set of pairs that finds a pair, and all pairs of a box, at once.
#include "world/pair_graph.hpp"

#include <algorithm>
#include <bit>
#include <new>
#include <utility>

#include "broadside/sinks.hpp"

namespace broadside::world {

std::size_t PairGraph::home(Pair pair) const noexcept { return hash(pair) & (table_.size() - 1); }

void PairGraph::reserve(std::size_t size, std::size_t boxes) {
  if (first_.size() < boxes) first_.resize(boxes, none);
  if (edges_.capacity() < size) edges_.reserve(std::max(size, 2 * edges_.capacity()));
  if (table_.size() < 2 * size) rehash(std::bit_ceil(std::max<std::size_t>(2 * size, 16)));
}

PairGraph::EdgeId PairGraph::insert(Pair pair) {
  if (size_ + 1 >= none) throw std::bad_alloc();
  reserve(size_ + 1, std::size_t{index(pair.second)} + 1);
  EdgeId edge = free_;
  if (edge == none) {
    edge = static_cast<EdgeId>(edges_.size());
    edges_.emplace_back();
  } else {
    free_ = edges_[edge].next[0];
  }
  edges_[edge].pair = pair;
  edges_[edge].mark = {};
  link(edge, 0, pair.first);
  link(edge, 1, pair.second);
  std::size_t place = home(pair);
  while (table_[place] != none) place = (place + 1) & (table_.size() - 1);
  table_[place] = edge;
  ++size_;
  return edge;
}

void PairGraph::erase(EdgeId edge) noexcept {
  const Pair pair = edges_[edge].pair;
  unlink(edge, 0, pair.first);
  unlink(edge, 1, pair.second);
  edges_[edge].pair = {BoxId{0}, BoxId{0}};
  edges_[edge].next[0] = std::exchange(free_, edge);
  --size_;
  const std::size_t mask = table_.size() - 1;
  std::size_t hole = home(pair);
  while (table_[hole] != edge) hole = (hole + 1) & mask;
  // The entries behind the hole move into it, unless that is before their home.
  for (std::size_t place = (hole + 1) & mask; table_[place] != none; place = (place + 1) & mask) {
    const std::size_t distance = (place - home(edges_[table_[place]].pair)) & mask;
    if (distance >= ((place - hole) & mask)) table_[std::exchange(hole, place)] = table_[place];
  }
  table_[hole] = none;
}

PairGraph::EdgeId PairGraph::find(Pair pair) const noexcept {
  if (table_.empty()) return none;
  for (std::size_t place = home(pair); table_[place] != none; place = (place + 1) & (table_.size() - 1)) {
    if (edges_[table_[place]].pair == pair) return table_[place];
  }
  return none;
}

void PairGraph::link(EdgeId edge, int side, BoxId box) noexcept {
  EdgeId& first = first_[index(box)];
  edges_[edge].next[side] = first;
  edges_[edge].previous[side] = none;
  if (first != none) edges_[first].previous[edges_[first].pair.first == box ? 0 : 1] = edge;
  first = edge;
}

void PairGraph::unlink(EdgeId edge, int side, BoxId box) noexcept {
  const EdgeId next = edges_[edge].next[side];
  const EdgeId previous = edges_[edge].previous[side];
  if (next != none) edges_[next].previous[edges_[next].pair.first == box ? 0 : 1] = previous;
  if (previous != none)
    edges_[previous].next[edges_[previous].pair.first == box ? 0 : 1] = next;
  else
    first_[index(box)] = next;
}

void PairGraph::rehash(std::size_t places) {
  table_ = std::vector<EdgeId>(places, none);
  for_each([this](EdgeId edge) {
    std::size_t place = home(edges_[edge].pair);
    while (table_[place] != none) place = (place + 1) & (table_.size() - 1);
    table_[place] = edge;
  });
}

void PairGraph::shrink_to_fit() {
  PairGraph packed;
  std::size_t boxes = 0;
  for_each([&](EdgeId edge) { boxes = std::max(boxes, std::size_t{index(edges_[edge].pair.second)} + 1); });
  packed.reserve(size_, boxes);
  for_each([&](EdgeId edge) { packed.mark(packed.insert(edges_[edge].pair)) = edges_[edge].mark; });
  std::swap(*this, packed);
}

std::size_t PairGraph::bytes() const noexcept {
  return edges_.capacity() * sizeof(Edge) + (first_.capacity() + table_.capacity()) * sizeof(EdgeId);
}

}  // namespace broadside::world
