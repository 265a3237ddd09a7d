// Text of a file, as an error shows it.
#pragma once

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
inline std::string shown(std::string_view text, std::size_t most = 60) {
  return "'" + plainly(text.substr(0, most)) + (text.size() > most ? "...'" : "'");
}

}  // namespace broadside::lab
