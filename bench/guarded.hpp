// The frame of a benchmark's main().
#pragma once

#include <cstddef>
#include <cstdio>
#include <exception>
#include <string>

#include <fmt/format.h>

namespace broadside::bench {

/// What `run()` returns; where it throws, `failure`, after a line on standard error.
template <typename Run>
int guarded(const char* program, int failure, Run run) {
  try {
    return run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", program, error.what());
    return failure;
  }
}

/// The argument at `place` as a number; `standard` where there are fewer arguments.
inline std::size_t number_at(int count, char** arguments, int place, std::size_t standard) {
  return count > place ? std::stoul(arguments[place]) : standard;
}

/// Likewise as text.
inline std::string text_at(int count, char** arguments, int place, const std::string& standard) {
  return count > place ? arguments[place] : standard;
}

}  // namespace broadside::bench
