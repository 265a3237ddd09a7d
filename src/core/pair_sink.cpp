// Sinks: their functions that are not inline.
#include <algorithm>
#include <stdexcept>

#include "broadside/pair.hpp"
#include "broadside/sinks.hpp"

#include "core/large_array.hpp"

namespace broadside {

void PairSink::merge(PairSink&) {
  throw std::logic_error("a PairSink has empty_clone() but no merge(); expected both or none");
}

void PairCollector::consume(std::span<const Pair> pairs) {
  const std::size_t size = pairs_->size() + pairs.size();
  if (size > pairs_->capacity()) core::reserve_large(*pairs_, std::max(size, 2 * pairs_->capacity()));
  pairs_->insert(pairs_->end(), pairs.begin(), pairs.end());
}

}  // namespace broadside
