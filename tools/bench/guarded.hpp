// The frame of a benchmark's main().
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

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

/// The argument at `place` as a number; `standard` where there are fewer arguments. Throws
/// std::invalid_argument for what is no number.
inline std::size_t number_at(int count, char** arguments, int place, std::size_t standard) {
  if (count <= place) return standard;
  const std::string_view text = arguments[place];
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size())
    throw std::invalid_argument(fmt::format("argument {} is '{}'; expected a whole number", place, text));
  return number;
}

/// The argument at `place`; `standard` where there are fewer arguments.
inline std::string text_at(int count, char** arguments, int place, const std::string& standard) {
  return count > place ? arguments[place] : standard;
}

}  // namespace broadside::bench
