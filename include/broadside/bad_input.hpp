// BadInput: what is done about boxes that are none.
#pragma once

#include <cstdint>

#include "broadside/cpp_version.hpp"

namespace broadside {

/// What is done about an invalid box: one with a NaN, or with min > max without being the absent box. It is
/// the same in every build, for every algorithm, and for floats and doubles; no algorithm ever sees such a
/// box. Infinite boxes are valid.
enum class BadInput : std::uint8_t {
  reject,     ///< InvalidInput is thrown, naming the first one, before anything has changed
  quarantine  ///< it counts as absent, pairs with nothing, and is listed by quarantined()
};

}  // namespace broadside
