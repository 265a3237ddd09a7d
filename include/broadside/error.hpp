// What the library throws. Every message names the thing, the value found and the value expected.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

#include "broadside/cpp_version.hpp"

namespace broadside {

/// A box that no algorithm may see: a NaN, or min > max without being absent. Thrown before anything has
/// changed.
class InvalidInput : public std::invalid_argument {
 public:
  InvalidInput(std::size_t index, const std::string& message)
      : std::invalid_argument(message), index_(index) {}

  /// The index of the first such box in the array that was handed in.
  std::size_t index() const noexcept { return index_; }

 private:
  std::size_t index_;
};

/// A spec that cannot be read, or that names an algorithm or a tunable that does not exist or a value out of
/// range.
class InvalidSpec : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// A handle that names no box of this world: never issued, removed, or another world's.
class InvalidHandle : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// Bytes that are no snapshot of a world, or not of one like this.
class InvalidSnapshot : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

}  // namespace broadside
