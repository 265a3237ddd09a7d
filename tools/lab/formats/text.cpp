// Parses numbers in text, and explains why a text is not a number: other programs and countries write numbers
// differently.
#include "lab/formats/text.hpp"

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <type_traits>
#include <version>

namespace broadside::lab::readers {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The number of digits at the beginning of a text.
std::size_t digits_of(std::string_view text) {
  return std::min(text.find_first_not_of("0123456789"), text.size());
}

/// Whether digits are in groups of three after the first group: "1,234,567.8", "1 234", "1.234,5".
bool is_grouped(std::string_view text) {
  // Some blanks take several bytes in UTF-8: the no-break space and two narrow ones. So does a quote.
  constexpr std::array<std::string_view, 9> separators = {
      ",", ".", " ", "'", "_", "\xC2\xA0", "\xE2\x80\xAF", "\xE2\x80\x89", "\xE2\x80\x99"};
  const std::size_t first = digits_of(text);
  if (first == 0 || first > 3) return false;
  text.remove_prefix(first);
  for (const std::string_view separator : separators) {
    if (!text.starts_with(separator)) continue;
    while (text.starts_with(separator)) {
      text.remove_prefix(separator.size());
      if (digits_of(text) != 3) return false;
      text.remove_prefix(3);
    }
    if (text.empty()) return true;
    const bool has_point = (text[0] == '.' || text[0] == ',') && separator != text.substr(0, 1);
    return has_point && digits_of(text.substr(1)) == text.size() - 1;
  }
  return false;
}

/// Whether the text would be a number if its comma were a point.
bool has_decimal_comma(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return false;
  std::string with_point(text);
  with_point[comma] = '.';
  double value = 0;
  return parse_number(with_point, value);
}

}  // namespace

template <typename Number>
bool parse_any_number(std::string_view text, Number& value) {
  // std::from_chars does not accept a plus sign.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
#if __cpp_lib_to_chars >= 201611L
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return false;
  if (error != std::errc::result_out_of_range) return error == std::errc();
#else
  // Refuses what std::strtod accepts beyond decimal numbers.
  if (text.find_first_of("xX( \t\n\r\f\v") != std::string_view::npos) return false;
#endif
  // Too large, or so small that the nearest double is zero or denormal: std::strtod gives the right value.
  const std::string copy(text);
  char* last = nullptr;
  value = std::is_same_v<Number, float> ? static_cast<Number>(std::strtof(copy.c_str(), &last))
                                        : static_cast<Number>(std::strtod(copy.c_str(), &last));
  const bool is_named = text.find_first_of("iInN") != std::string_view::npos;  // "inf" or "nan"
  return !copy.empty() && last == copy.c_str() + copy.size() && (is_named || std::isfinite(value));
}

template bool parse_any_number(std::string_view, float&);
template bool parse_any_number(std::string_view, double&);

bool parse_number(std::string_view text, double& value) {
  return parse_any_number(text, value) && !std::isnan(value);
}

NumberFault number_fault(std::string_view text) {
  if (text.empty()) return {"empty", {}};
  std::string_view digits = text;
  if (digits.front() == '+' || digits.front() == '-') digits.remove_prefix(1);
  if (digits.empty()) return {"text", {}};
  std::string word(digits);
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (word.starts_with("nan")) return {"NaN", {}};
  if (word == "na" || word == "n/a" || word == "null" || word == "none") return {"no value", {}};
  // "1,234" may have a decimal comma or groups of thousands.
  if (has_decimal_comma(digits))
    return {is_grouped(digits) ? "with a decimal comma or a thousands separator" : "with a decimal comma",
            "a number with a decimal point"};
  if (is_grouped(digits)) return {"with a thousands separator", "a number without one"};
  if (is_digit(digits.front()) && std::isalpha(static_cast<unsigned char>(digits.back())) != 0 &&
      !word.starts_with("0x"))
    return {"a number with text behind it", {}};
  if (digits.find_first_of("0123456789") == std::string_view::npos) return {"text", {}};
  return {};
}

}  // namespace broadside::lab::readers
