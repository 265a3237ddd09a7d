// Passes on some of the pairs that a search writes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "broadside/pair.hpp"

namespace broadside::lab {

/// Writes the pairs of `found` that `keeps` accepts to `pairs`. Does not use add(), which orders the two
/// boxes of a pair: they may belong to two sets.
template <typename Keeps>
void write_if(std::span<const Pair> found, PairSink& pairs, Keeps keeps) {
  while (!found.empty()) {
    const std::span<const Pair> chunk = found.first(std::min(found.size(), PairSink::max_room));
    found = found.subspan(chunk.size());
    Pair* const room = pairs.room(chunk.size());
    std::size_t kept = 0;
    for (const Pair pair : chunk) {
      room[kept] = pair;
      kept += keeps(pair) ? 1 : 0;
    }
    pairs.commit(kept);
  }
}

}  // namespace broadside::lab
