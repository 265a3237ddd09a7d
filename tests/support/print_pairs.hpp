// How GoogleTest prints a pair. CMake includes this file in each source of a test program, because the linker
// keeps one printer of each type, and all sources must agree on it.
#pragma once

#include <ostream>

#include "broadside/pair.hpp"

namespace broadside {

inline void PrintTo(const Pair& pair, std::ostream* out) {
  *out << '(' << index(pair.first) << ", " << index(pair.second) << ')';
}

}  // namespace broadside
