// What the program says on stderr, and prints.
#include "cli/message.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>

#include "cli/unusable.hpp"

namespace broadside::cli {
namespace {

std::string program = "broadside";

[[noreturn]] void refuse_output() {
  throw Unusable(fmt::format("standard output: cannot be written: {}",
                             errno != 0 ? std::strerror(errno) : "the stream failed"));
}

}  // namespace

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

void set_program_name(const std::string& name) { program = name; }

const char* program_name() noexcept { return program.c_str(); }

void say(std::string_view text) {
  const std::string line = fmt::format("{}: {}\n", program, printable(text));
  // Nothing can be done about a message that is not taken.
  std::fputs(line.c_str(), stderr);
}

void print(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) refuse_output();
}

void flush_output() {
  errno = 0;
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) refuse_output();
}

}  // namespace broadside::cli
