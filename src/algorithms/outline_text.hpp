// Text helpers for the captions of outlines.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/number_text.hpp"

namespace broadside::algorithm {

/// The number with three significant digits, such as "3.14" or "1e+06".
inline std::string three_digits(double number) { return core::text_of(number, 3); }

/// "1 cell" or "3 cells".
inline std::string counted(std::size_t count, std::string_view one) {
  return std::to_string(count) + " " + std::string(one) + (count == 1 ? "" : "s");
}

inline std::string axis_name(int axis) { return {"xyz"[axis]}; }

}  // namespace broadside::algorithm
