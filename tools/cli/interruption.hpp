// What the program does at Ctrl-C (SIGINT), at SIGTERM and at SIGHUP.
#pragma once

#include <exception>
#include <string>

namespace broadside::cli {

/// What a signal does.
enum class OnSignal {
  end,            ///< ends the program at once
  note_then_end,  ///< the first is noted for interrupted() to tell, the second ends the program: for work
                  ///< that asks
};

/// From here on, what is said after "interrupted" when a signal ends the program, such as how to go on; empty
/// for nothing.
void say_at_interruption(const std::string& what);

/// From here on, signals do this. A file that is being written when a signal ends the program is removed, and
/// an old one at its place stays (lab/formats/write_file.hpp).
void on_signal(OnSignal what);

/// Has a write to a pipe that nothing reads any more end the program, as users of `| head` expect: without a
/// message, with Exit::closed_pipe. Lets a write beyond the greatest size of a file fail, so that it is
/// reported.
void on_failing_write();

/// Whether a signal was noted.
bool interrupted() noexcept;

/// Thrown where work ends because a signal was noted.
class Interruption : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

}  // namespace broadside::cli
