// What the program says on stderr.
#pragma once

#include <string>
#include <string_view>

namespace broadside::cli {

/// Text that may quote a file or an argument, with its control characters written out as \n, \t or \x1b: what
/// a file holds is not to steer a terminal.
std::string printable(std::string_view text);

/// Writes "broadside: TEXT" and a line's end to stderr, the text made printable.
void say(std::string_view text);

}  // namespace broadside::cli
