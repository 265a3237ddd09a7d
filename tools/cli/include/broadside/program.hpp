// The command-line program as a function: all its verbs, for algorithms of your own as well. Link
// Broadside::program.
#pragma once

#include <span>
#include <vector>

#include "broadside/algorithm.hpp"

namespace broadside {
namespace detail {
int run_program(int count, const char* const* values, std::span<const Algorithm> algorithms);
}  // namespace detail

/// Runs the program `broadside` on the arguments of main(), and returns the exit status.
///
/// `algorithms` are known by their names beside those of the library and its peers. Those of kind `own`,
/// which is the default, belong to the group "own". A name that is taken is refused, as an unusable argument
/// is. Messages begin with the file name in values[0].
///
/// Call it once, as all that main() does: it handles SIGINT, SIGTERM, SIGHUP and SIGPIPE, which end the
/// process, and ignores SIGXFSZ. Throws nothing: whatever goes wrong is said on stderr.
inline int run_program(int count, const char* const* values, const std::vector<Algorithm>& algorithms = {}) {
  return detail::run_program(count, values, algorithms);
}

}  // namespace broadside
