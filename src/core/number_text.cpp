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
  if (error == std::errc::result_out_of_range) {
    const bool is_negative = text.starts_with('-');
    const std::size_t exponent = text.find_first_of("eE");
    const bool is_small = exponent == text.npos ? text.substr(is_negative ? 1 : 0).starts_with("0.")
                                                : text.substr(exponent + 1).starts_with('-');
    const double found = is_small ? 0 : std::numeric_limits<double>::infinity();
    return is_negative ? -found : found;
  }
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
