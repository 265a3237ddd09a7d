// Text of files: shown in messages, split into words, and numbers in it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace broadside::lab {

/// Text with '?' for every character that is not printable ASCII.
inline std::string plainly(std::string_view text) {
  std::string plain(text);
  for (char& c : plain) c = c >= ' ' && c <= '~' ? c : '?';
  return plain;
}

/// The beginning of `text` in quotes, with '?' for every character that is not printable ASCII.
inline std::string shown(std::string_view text, std::size_t max_chars = 60) {
  return "'" + plainly(text.substr(0, max_chars)) + (text.size() > max_chars ? "...'" : "'");
}

/// Takes the first word off the text; empty where there is none left.
inline std::string_view next_word(std::string_view& text) {
  constexpr std::string_view blanks = " \t";
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(word.size());
  return word;
}

}  // namespace broadside::lab

namespace broadside::lab::readers {

/// Whether all of `text` is a number, which may be infinite or a NaN; `value` is then the nearest float or
/// double.
template <typename Number>
bool parse_any_number(std::string_view text, Number& value);

/// Whether all of `text` is a number, which may be infinite but not a NaN; `value` is then the nearest
/// double.
bool parse_number(std::string_view text, double& value);

/// Why a text is not a number, and what is expected instead.
struct NumberFault {
  std::string found;  ///< such as "with a decimal comma"; empty where there is no more to say than the text
  std::string expected;  ///< such as "a decimal point"; empty where it depends on what reads the number
};

/// Looks at a text that could not be read as a number.
NumberFault number_fault(std::string_view text);

}  // namespace broadside::lab::readers
