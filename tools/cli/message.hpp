// Output on standard error: messages, progress, and errors about unusable arguments and files.
#pragma once

#include <chrono>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace broadside::cli {

/// Text that may quote a file or an argument, with control characters escaped as \n, \t or \x1b, so that file
/// contents cannot control a terminal.
std::string printable(std::string_view text);

/// The name by which this program was called, without its folder; "broadside" until it is set. A
/// null-terminated string, so that a signal handler can write it.
void set_program_name(const std::string& name);
const char* program_name() noexcept;

/// Writes "PROGRAM: TEXT" and a newline to stderr, after printable(TEXT).
void say(std::string_view text);

/// say() for each line of a text with several messages, such as a reader's warnings; nothing if empty.
void say_lines(std::string_view text);

/// Prints text to standard output. Throws Unusable if the write fails.
void print(std::string_view text);

/// COLUMNS or, without it, the columns of the terminal on standard output; 0 if there is neither.
std::size_t terminal_columns();

/// The width to fold printed text to: the terminal's columns, at least 40. Output to a file or a pipe is not
/// folded.
std::size_t output_width();

/// Throws Unusable if printed text could not be written.
void flush_output();

/// Where progress is shown.
enum class ShowProgress {
  on_terminal,  ///< only if stderr is a terminal
  always,       ///< also elsewhere, as separate lines
  never,
};

/// Sets where progress is shown; the default is on_terminal.
void show_progress(ShowProgress where);

/// Progress of long work on stderr. On a terminal, one line that disappears with this object; elsewhere, if
/// requested, one line per second.
class ProgressLine {
 public:
  ProgressLine() = default;
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Shows this from now on; updates at most ten times per second.
  void show(std::string_view what);

  /// Also shows the completed fraction, from 0 to 1, in percent and, after a second, the remaining time,
  /// extrapolated from the time since this object was made.
  void show(std::string_view what, double done);

  void clear();

 private:
  /// Whether an update should be shown now.
  bool is_due();
  void write(std::string_view what);

  bool is_shown_ = false;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point shown_{};
};

/// A duration in rounded units: "12 s", "3 min 20 s", "2 h 5 min".
std::string roughly(double seconds);

/// An argument or a file that cannot be used; the text names the thing, the value found and the expected one.
class Unusable : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace broadside::cli
