// Which boxes an index holds and which boxes query it, if the library has no join of two indexes.
#pragma once

#include <cstddef>

#include "broadside/searcher.hpp"

namespace broadside::lab::peers {

/// Of two sets, the larger one is indexed, since a box costs less in a packed index than as a query. If there
/// is only one set, all of its boxes are indexed.
struct IndexedSet {
  template <int D>
  explicit IndexedSet(const SearchInput<D>& input) : end(input.boxes.size()) {
    const std::size_t left = input.left_count;
    if (left > end / 2) {
      other_begin = left;
      other_end = end;
      end = left;
    } else {
      begin = other_end = left;
    }
  }

  std::size_t begin = 0;
  std::size_t end;
  std::size_t other_begin = 0;
  std::size_t other_end = 0;
};

}  // namespace broadside::lab::peers
