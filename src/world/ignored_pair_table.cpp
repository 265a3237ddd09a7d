// IgnoredPairTable: the pairs of boxes that never count, and which of them changed.
#include "world/ignored_pair_table.hpp"

#include <utility>

namespace broadside::world {

bool IgnoredPairTable::insert(Pair pair) {
  if (contains(pair)) return false;
  core::make_room(changed_, 1);
  edges_.reserve(edges_.size() + 1, std::size_t{index(pair.second)} + 1);
  pairs_.insert(pair);
  edges_.insert(pair);
  changed_.push_back(pair);
  return true;
}

bool IgnoredPairTable::erase(Pair pair) {
  if (!contains(pair)) return false;
  core::make_room(changed_, 1);
  pairs_.erase(pair);
  edges_.erase(edges_.find(pair));
  changed_.push_back(pair);
  return true;
}

void IgnoredPairTable::forget(std::uint32_t slot) noexcept {
  PairGraph::EdgeId edge;
  while ((edge = edges_.first_of(BoxId{slot})) != PairGraph::none) {
    const Pair pair = edges_.pairs()[edge];
    pairs_.erase(pair);
    edges_.erase(edge);
    changed_.push_back(pair);
  }
}

void IgnoredPairTable::shrink_to_fit() {
  edges_.shrink_to_fit();
  changed_.shrink_to_fit();
}

void IgnoredPairTable::restore(std::span<const Pair> pairs, std::vector<Pair> changed) {
  *this = {};
  for (const Pair pair : pairs) {
    pairs_.insert(pair);
    edges_.insert(pair);
  }
  changed_ = std::move(changed);
}

}  // namespace broadside::world
