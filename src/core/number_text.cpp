// Numbers and text, by the standard library.
#include "core/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace broadside::core {

double number_in(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nan("");
  // Out of range: too large, unless the exponent is negative.
  if (error == std::errc::result_out_of_range)
    return text.find("e-") == text.npos ? std::numeric_limits<double>::infinity() : 0;
  return error == std::errc() ? value : std::nan("");
}

std::string text_of(double value) {
  std::array<char, 32> text;
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

std::string text_of(double value, int digits) {
  std::array<char, 40> text;
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, digits);
  return {text.data(), end};
}

}  // namespace broadside::core
