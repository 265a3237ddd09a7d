// PairEvents: pairs that begin and pairs that end, on their way to the caller.
#include "world/pair_events.hpp"

#include <algorithm>
#include <iterator>

#include "broadside/sinks.hpp"

#include "core/grow.hpp"

namespace broadside::world {

void PairEvents::cancel() {
  std::vector<Pair> scratch;
  sort_pairs(begun, scratch);
  sort_pairs(ended, scratch);
  std::size_t kept_begun = 0;
  std::size_t kept_ended = 0;
  std::size_t j = 0;
  for (const Pair pair : begun) {
    while (j < ended.size() && ended[j] < pair) ended[kept_ended++] = ended[j++];
    if (j < ended.size() && ended[j] == pair)
      ++j;
    else
      begun[kept_begun++] = pair;
  }
  while (j < ended.size()) ended[kept_ended++] = ended[j++];
  begun.resize(kept_begun);
  ended.resize(kept_ended);
}

PairEvents PairEvents::netted() const {
  PairEvents net = *this;
  net.cancel();
  return net;
}

void PairEvents::shrink_to_fit() { core::shrink(begun, ended); }

std::size_t PairEvents::bytes() const noexcept { return core::bytes_of(begun, ended); }

std::vector<Pair> symmetric_difference(const std::vector<Pair>& a, const std::vector<Pair>& b) {
  std::vector<Pair> pairs;
  std::ranges::set_symmetric_difference(a, b, std::back_inserter(pairs));
  return pairs;
}

}  // namespace broadside::world
