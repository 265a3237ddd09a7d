// The parts of outlines' captions.
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace broadside::core {

/// The number with three digits, such as "3.14" or "1e+06".
inline std::string three_digits(double number) {
  std::array<char, 32> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::general, 3);
  return {text.data(), end.ptr};
}

/// "1 cell" or "3 cells".
inline std::string counted(std::size_t count, std::string_view one) {
  return std::to_string(count) + " " + std::string(one) + (count == 1 ? "" : "s");
}

inline std::string axis_name(int axis) { return {"xyz"[axis]}; }

}  // namespace broadside::core
