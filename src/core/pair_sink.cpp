// Sinks: their functions that are not inline.
#include <stdexcept>

#include "broadside/pair.hpp"
#include "broadside/sinks.hpp"

#include "core/large_array.hpp"

namespace broadside {

void PairSink::merge(PairSink&) {
  throw std::logic_error("a PairSink has empty_clone() but no merge(); expected both or none");
}

void detail::prefer_large_pages(void* begin, std::size_t bytes) noexcept {
  core::prefer_large_pages(begin, bytes);
}

}  // namespace broadside
