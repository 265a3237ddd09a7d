// What the program does at Ctrl-C (SIGINT), at SIGTERM and at SIGHUP.
#pragma once

#include <exception>

namespace broadside::cli {

/// What a signal does.
enum class OnSignal {
  end,  ///< it ends the program at once: for work that never asks and has nothing to leave half done
  note_then_end,  ///< the first is noted for interrupted() to tell, the second ends the program: for work
                  ///< that asks
  note            ///< it is only noted: while a file is being written, which would be left half-written
};

/// From here on, signals do this.
void on_signal(OnSignal what);

/// Lets a write to a closed pipe, or beyond the greatest size of a file, fail instead of ending the program,
/// so that it is reported and nothing half-written is left.
void ignore_write_signals();

/// Whether a signal was noted.
bool interrupted() noexcept;

/// Thrown where work ends because a signal was noted. What it had begun to write is removed on the way out.
class Interruption : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

/// Throws Interruption if a signal was noted.
void end_if_interrupted();

}  // namespace broadside::cli
