// Text in files: shown in messages, split into words, and parsed as numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace broadside::lab {

/// Text with '?' in place of every character that is not printable ASCII.
inline std::string plainly(std::string_view text) {
  std::string plain(text);
  for (char& c : plain) c = c >= ' ' && c <= '~' ? c : '?';
  return plain;
}

/// The beginning of `text` in quotes, with '?' in place of every character that is not printable ASCII.
inline std::string shown(std::string_view text, std::size_t max_chars = 60) {
  return "'" + plainly(text.substr(0, max_chars)) + (text.size() > max_chars ? "...'" : "'");
}

/// Removes the first word from the text and returns it; empty if there is none left.
inline std::string_view next_word(std::string_view& text) {
  constexpr std::string_view blanks = " \t";
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(word.size());
  return word;
}

}  // namespace broadside::lab

namespace broadside::lab::readers {

/// Whether all of `text` is a number, possibly infinite or NaN; if so, `value` becomes the nearest float or
/// double.
template <typename Number>
bool parse_any_number(std::string_view text, Number& value);

/// Whether all of `text` is a number, possibly infinite but not NaN; if so, `value` becomes the nearest
/// double.
bool parse_number(std::string_view text, double& value);

/// Why a text is not a number, and what is expected instead.
struct NumberFault {
  std::string found;     ///< such as "with a decimal comma"; empty if the text itself says enough
  std::string expected;  ///< such as "a decimal point"; empty if it depends on the reader
};

/// Examines a text that is not a number.
NumberFault number_fault(std::string_view text);

}  // namespace broadside::lab::readers
