// Error handling and arguments shared by the benchmarks' main() functions.
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

/// Returns the result of `run()`. If it throws, prints a line on standard error and returns `failure`.
template <typename Run>
int guarded(const char* program, int failure, Run run) {
  try {
    return run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", program, error.what());
    return failure;
  }
}

/// The argument at `place` as a number, or `default_value` if there are fewer arguments. Throws
/// std::invalid_argument if it is not a number.
inline std::size_t number_at(int count, char** arguments, int place, std::size_t default_value) {
  if (count <= place) return default_value;
  const std::string_view text = arguments[place];
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size())
    throw std::invalid_argument(fmt::format("argument {} is '{}'; expected a whole number", place, text));
  return number;
}

/// The argument at `place`, or `default_value` if there are fewer arguments.
inline std::string text_at(int count, char** arguments, int place, const std::string& default_value) {
  return count > place ? arguments[place] : default_value;
}

}  // namespace broadside::bench
