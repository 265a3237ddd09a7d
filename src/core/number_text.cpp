// Numbers and text, by the standard library or, where it has not got them for doubles, by that of C.
#include "core/number_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <clocale>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace broadside::core {

#if __cpp_lib_to_chars >= 201611L

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

#else

// libc++ before version 20. The functions of C write and read the decimal point of the global locale.

namespace {

std::string printed(const char* format, int digits, double value) {
  std::array<char, 400> buffer;
  std::string text(buffer.data(), static_cast<std::size_t>(
                                      std::snprintf(buffer.data(), buffer.size(), format, digits, value)));
  const std::string_view point = std::localeconv()->decimal_point;
  if (const std::size_t at = text.find(point); at != text.npos) text.replace(at, point.size(), ".");
  return text;
}

}  // namespace

double number_in(std::string_view text) {
  // strtod() also takes spaces, a plus, hexadecimal digits and the locale's point.
  if (text.starts_with('+') || text.find_first_not_of("0123456789.eE+-inftyaINFTYA") != text.npos)
    return std::nan("");
  std::string copy(text);
  if (const std::size_t at = copy.find('.'); at != copy.npos)
    copy.replace(at, 1, std::localeconv()->decimal_point);
  char* end = nullptr;
  const double value = std::strtod(copy.c_str(), &end);
  return !copy.empty() && end == copy.c_str() + copy.size() ? value : std::nan("");
}

std::string text_of(double value) {
  std::string text;
  int digits = 0;  // after the first, as few as read back to the value
  for (; digits < 17; ++digits) {
    text = printed("%.*e", digits, value);
    if (number_in(text) == value) break;
  }
  const std::size_t exponent = text.find('e');
  if (exponent == text.npos) return text;  // "inf" or "nan"
  const std::string fixed =
      printed("%.*f", std::max(0, digits - std::atoi(text.c_str() + exponent + 1)), value);
  return fixed.size() <= text.size() ? fixed : text;
}

std::string text_of(double value, int digits) { return printed("%.*g", digits, value); }

#endif

}  // namespace broadside::core
