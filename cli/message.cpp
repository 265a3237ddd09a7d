// What the program says on stderr.
#include "cli/message.hpp"

#include <cstdio>

#include <fmt/format.h>

namespace broadside::cli {

std::string printable(std::string_view text) {
  std::string shown;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\n')
      shown += "\\n";
    else if (c == '\t')
      shown += "\\t";
    else if (byte < 0x20 || byte == 0x7f)
      shown += fmt::format("\\x{:02x}", byte);
    else
      shown += c;
  }
  return shown;
}

void say(std::string_view text) { fmt::print(stderr, "broadside: {}\n", printable(text)); }

}  // namespace broadside::cli
