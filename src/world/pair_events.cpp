// PairEvents: pairs that begin and pairs that end, on their way to the caller.
#include "world/pair_events.hpp"

#include <algorithm>
#include <iterator>

#include "broadside/sinks.hpp"

namespace broadside::world {

PairEvents PairEvents::netted() const {
  PairEvents sorted = *this;
  std::vector<Pair> scratch;
  sort_pairs(sorted.begun, scratch);
  sort_pairs(sorted.ended, scratch);
  PairEvents net;
  std::set_difference(sorted.begun.begin(), sorted.begun.end(), sorted.ended.begin(), sorted.ended.end(),
                      std::back_inserter(net.begun));
  std::set_difference(sorted.ended.begin(), sorted.ended.end(), sorted.begun.begin(), sorted.begun.end(),
                      std::back_inserter(net.ended));
  return net;
}

std::vector<Pair> PairEvents::undone(const std::vector<Pair>& pairs) const {
  return symmetric_difference(symmetric_difference(pairs, begun), ended);
}

std::vector<Pair> symmetric_difference(const std::vector<Pair>& a, const std::vector<Pair>& b) {
  std::vector<Pair> pairs;
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(pairs));
  return pairs;
}

}  // namespace broadside::world
