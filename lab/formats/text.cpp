// Why a text is no number: the ways in which other programs and countries write one.
#include "lab/formats/text.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "lab/formats/csv/text.hpp"

namespace broadside::lab::readers {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return std::tolower(c); });
  return result;
}

/// Takes what separates groups of digits, which is UTF-8 for the narrow and the fixed blank; 0 bytes if the
/// text does not begin with one.
std::size_t separator_bytes(std::string_view text) {
  constexpr std::array<std::string_view, 9> separators = {
      ",", ".", " ", "'", "_", "\xC2\xA0", "\xE2\x80\xAF", "\xE2\x80\x89", "\xE2\x80\x99"};
  for (const std::string_view separator : separators) {
    if (text.starts_with(separator)) return separator.size();
  }
  return 0;
}

/// Whether digits stand in groups of three behind a first one: "1,234,567.8", "1 234", "1.234,5".
bool is_grouped(std::string_view text) {
  const auto digits = [&text] {
    const auto end = std::ranges::find_if_not(text, is_digit);
    const auto count = static_cast<std::size_t>(end - text.begin());
    text.remove_prefix(count);
    return count;
  };
  const std::size_t first = digits();
  if (first == 0 || first > 3) return false;
  const std::size_t bytes = separator_bytes(text);
  if (bytes == 0) return false;
  const std::string_view separator = text.substr(0, bytes);
  std::size_t groups = 0;
  while (text.starts_with(separator)) {
    text.remove_prefix(bytes);
    if (digits() != 3) return false;
    ++groups;
  }
  // One group behind a point is a number, and the caller asks about texts that are not.
  if (groups == 0) return false;
  if (text.empty()) return true;
  const char point = text.front();
  if ((point != '.' && point != ',') || separator == text.substr(0, 1)) return false;
  text.remove_prefix(1);
  digits();
  return text.empty();
}

/// Whether a comma in place of the point makes it no number.
bool has_decimal_comma(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return false;
  std::string with_point(text);
  with_point[comma] = '.';
  double value = 0;
  return parse_number(std::string_view(with_point), value);
}

}  // namespace

NumberFault number_fault(std::string_view text) {
  if (text.empty()) return {"empty", {}};
  std::string_view digits = text;
  if (digits.front() == '+' || digits.front() == '-') digits.remove_prefix(1);
  if (digits.empty()) return {"text", {}};
  const std::string word = lower(digits);
  if (word.starts_with("nan") || word == "na" || word == "n/a" || word == "null" || word == "none")
    return {word.starts_with("nan") ? "NaN" : "no value", {}};
  // "1,234" may be either.
  if (has_decimal_comma(digits))
    return {is_grouped(digits) ? "with a decimal comma or a thousands separator" : "with a decimal comma",
            "a number with a decimal point"};
  if (is_grouped(digits)) return {"with a thousands separator", "a number without one"};
  if (is_digit(digits.front()) && std::isalpha(static_cast<unsigned char>(digits.back())) != 0 &&
      !word.starts_with("0x"))
    return {"a number with text behind it", {}};
  if (std::ranges::none_of(digits, is_digit)) return {"text", {}};
  return {};
}

}  // namespace broadside::lab::readers
