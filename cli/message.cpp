// What the program says on standard error.
#include "cli/message.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>
#include <unistd.h>

namespace broadside::cli {

namespace {

std::string name_of_program = "broadside";

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

void set_program_name(const std::string& name) { name_of_program = name; }

const char* program_name() noexcept { return name_of_program.c_str(); }

void say(std::string_view text) {
  const std::string line = fmt::format("{}: {}\n", name_of_program, printable(text));
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

void ProgressLine::show(std::string_view what) {
  static const bool on_terminal = isatty(STDERR_FILENO) != 0;
  const auto now = std::chrono::steady_clock::now();
  if (!on_terminal || now - shown_ < std::chrono::milliseconds(100)) return;
  shown_ = now;
  is_shown_ = true;
  // A longer line would wrap and could not be written over.
  fmt::print(stderr, "\r\x1b[K{}", printable(what.substr(0, 78)));
}

void ProgressLine::clear() {
  if (is_shown_) fmt::print(stderr, "\r\x1b[K");
  is_shown_ = false;
}

}  // namespace broadside::cli
