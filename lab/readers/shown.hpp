// Text of a file, as an error shows it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace broadside::lab {

/// The beginning of `text` in quotes, with '?' for every character that is not printable ASCII.
inline std::string shown(std::string_view text, std::size_t most = 60) {
  std::string shown(text.substr(0, most));
  for (char& c : shown) c = c >= ' ' && c <= '~' ? c : '?';
  return "'" + shown + (text.size() > most ? "...'" : "'");
}

}  // namespace broadside::lab
