// The command-line program as a function: all its verbs, including for your own algorithms. Link
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
/// `algorithms` are available by name beside those of the library and its peers. Algorithms of kind `own`,
/// the default, belong to the group "own". A name that is already taken is refused like any unusable
/// argument. Messages begin with the file name in values[0].
///
/// Call it once, as the whole body of main(): it handles SIGINT, SIGTERM, SIGHUP and SIGPIPE, which end the
/// process, and ignores SIGXFSZ. Throws nothing; errors are reported on stderr.
inline int run_program(int count, const char* const* values, const std::vector<Algorithm>& algorithms = {}) {
  return detail::run_program(count, values, algorithms);
}

}  // namespace broadside
