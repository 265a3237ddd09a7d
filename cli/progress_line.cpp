// What is going on, on a line of stderr that is written over again and again.
#include "cli/progress_line.hpp"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include "cli/message.hpp"

namespace broadside::cli {

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
