// Words between blanks, as the texts of meshes have them.
#pragma once

#include <algorithm>
#include <string_view>

namespace broadside::lab {

/// Takes the first word off the text; empty where there is none left.
inline std::string_view next_word(std::string_view& text) {
  constexpr std::string_view blanks = " \t";
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(word.size());
  return word;
}

}  // namespace broadside::lab
