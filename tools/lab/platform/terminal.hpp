// The terminal, the command line and interruptions of a program, on every system.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace broadside::lab::platform {

/// Whether a descriptor is a terminal.
bool is_terminal(int descriptor);

/// The columns of the terminal on standard output; 0 if there is none.
std::size_t terminal_width();

/// Makes the standard streams pass bytes unchanged, and a terminal show UTF-8 and interpret escape sequences.
void prepare_standard_streams();

/// The arguments of main() in UTF-8.
std::vector<std::string> arguments(int count, const char* const* values);

/// Calls `handle` when the user or the system asks the process to end: on Ctrl-C, SIGTERM and, unless it is
/// ignored, SIGHUP. `handle` must be async-signal-safe.
void on_interruption(void (*handle)());

/// Calls `handle`, as above, on a write to a pipe without a reader, and makes a write beyond the maximum file
/// size fail. On systems without such signals, both writes fail.
void on_failing_write(void (*handle)());

}  // namespace broadside::lab::platform
