// What the program says on stderr, and prints.
#pragma once

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

}  // namespace broadside::cli
