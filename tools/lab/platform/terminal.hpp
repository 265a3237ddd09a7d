// The terminal, the command line and what interrupts a program, as the system has them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace broadside::lab::platform {

/// Whether a descriptor is a terminal's.
bool is_terminal(int descriptor);

/// The columns of the terminal on standard output; 0 if there is none.
std::size_t terminal_width();

/// Has the standard streams pass bytes unchanged, and a terminal show UTF-8 and obey its escape sequences.
void prepare_standard_streams();

/// The arguments of main() in UTF-8.
std::vector<std::string> arguments(int count, const char* const* values);

/// Has `handle` called where the user or the system asks the process to end: at Ctrl-C, at SIGTERM and,
/// unless it is ignored, at SIGHUP. It may do what a signal's handler may.
void on_interruption(void (*handle)());

/// Has `handle` called, as above, at a write to a pipe that nothing reads any more, and a write beyond the
/// greatest size of a file fail. Where the system has no such signals, both fail.
void on_failing_write(void (*handle)());

}  // namespace broadside::lab::platform
