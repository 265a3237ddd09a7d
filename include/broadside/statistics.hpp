// Statistics: what a search or an update did, in numbers that do not depend on the machine.
#pragma once

#include <cstdint>

#include "broadside/cpp_version.hpp"

namespace broadside {

/// What one search or one update did, in the paper's units of cost; 0 where an algorithm does not count it.
struct Statistics {
  std::uint64_t tests = 0;       ///< pairs of boxes compared
  std::uint64_t references = 0;  ///< entries of boxes in cells, leaves or lists
  std::uint64_t cells = 0;       ///< cells or nodes that there are
  std::uint64_t hits = 0;  ///< of the tests, those of boxes that overlap; the others are false positives
};

}  // namespace broadside
