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

/// Likewise each line of a text that holds several messages, such as a reader's warnings; nothing if empty.
void say_lines(std::string_view text);

/// Prints text to standard output. Throws Unusable where it is not taken.
void print(std::string_view text);

/// Throws Unusable if not all that was printed has been taken.
void flush_output();

/// Where progress is shown.
enum class ShowProgress {
  on_terminal,  ///< where stderr is one
  always,       ///< elsewhere as lines of their own
  never,
};

/// From here on; until then it is on_terminal.
void show_progress(ShowProgress where);

/// What long work is at, on stderr: on a terminal one line, which is gone when this object is; elsewhere, if
/// it is asked for, a line each second.
class ProgressLine {
 public:
  ProgressLine() = default;
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Shows this from now on; at most ten times a second.
  void show(std::string_view what);

  /// Likewise, with the fraction that is done, from 0 to 1, in percent and, after a second, how long the rest
  /// will take if it goes on as it did since this object was made.
  void show(std::string_view what, double done);

  void clear();

 private:
  /// Whether there is anything to be shown now.
  bool is_due();
  void write(std::string_view what);

  bool is_shown_ = false;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point shown_{};
};

/// How long something will take, in whole seconds: "12 s", "3 min 20 s", "2 h 5 min".
std::string roughly(double seconds);

/// An argument or a file that cannot be used; its text names the thing, the value found and what is expected.
class Unusable : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace broadside::cli
