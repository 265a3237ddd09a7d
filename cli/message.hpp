// What the program says on standard error: messages, progress, and that it cannot use what was given.
#pragma once

#include <chrono>
#include <stdexcept>
#include <string>
#include <string_view>

namespace broadside::cli {

/// Text that may quote a file or an argument, with its control characters written out as \n, \t or \x1b: what
/// a file holds is not to steer a terminal.
std::string printable(std::string_view text);

/// The name by which this program was called, without its folder; "broadside" until it is set. A
/// null-terminated string, so that a signal handler can write it.
void set_program_name(const std::string& name);
const char* program_name() noexcept;

/// Writes "PROGRAM: TEXT" and a line's end to stderr, the text made printable.
void say(std::string_view text);

/// Prints text to standard output. Throws Unusable where it is not taken.
void print(std::string_view text);

/// Throws Unusable if not all that was printed has been taken.
void flush_output();

/// One line on stderr; nothing where stderr is no terminal. It is gone when this object is.
class ProgressLine {
 public:
  ProgressLine() = default;
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Shows this from now on; at most ten times a second.
  void show(std::string_view what);

  void clear();

 private:
  bool is_shown_ = false;
  std::chrono::steady_clock::time_point shown_{};
};

/// An argument or a file that cannot be used; its text names the thing, the value found and what is expected.
class Unusable : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace broadside::cli
