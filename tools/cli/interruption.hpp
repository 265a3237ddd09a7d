// Handles Ctrl-C (SIGINT), SIGTERM and SIGHUP.
#pragma once

#include <exception>
#include <string>

namespace broadside::cli {

/// Reaction to a signal.
enum class OnSignal {
  end,            ///< ends the program at once
  note_then_end,  ///< the first signal is noted for interrupted(), the second ends the program: for work
                  ///< that polls interrupted()
};

/// Sets the text after "interrupted" when a signal ends the program, such as how to resume; empty for none.
void say_at_interruption(const std::string& what);

/// Sets the reaction to signals. If a signal ends the program while it writes a file, the new file is removed
/// and an existing file of that name stays (lab/formats/write_file.hpp).
void on_signal(OnSignal what);

/// Ends the program when it writes to a closed pipe, as users of `| head` expect: without a message, with
/// Exit::closed_pipe. A write beyond the file size limit fails instead of raising a signal, so that it is
/// reported.
void on_failing_write();

/// Whether a signal was noted.
bool interrupted() noexcept;

/// Thrown to stop work after a signal was noted.
class Interruption : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

}  // namespace broadside::cli
