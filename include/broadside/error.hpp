// The library's exceptions. Each message names the thing, the value found and the value expected.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "broadside/export.hpp"

namespace broadside {

/// An invalid box: it has a NaN, or min > max and is not absent. A box that is added to a world must not be
/// absent either. Thrown before anything has changed.
class BROADSIDE_PUBLIC InvalidInput : public std::invalid_argument {
 public:
  InvalidInput(std::size_t index, const std::string& message)
      : std::invalid_argument(message), index_(index) {}

  /// The index of the first invalid box in the caller's array; 0 for a single box.
  [[nodiscard]] std::size_t index() const noexcept { return index_; }

 private:
  std::size_t index_;
};

/// Arguments that contradict each other: too many boxes, a different number of filters than of boxes, an id
/// in `changed` that is out of range, a change that is not listed. Thrown before anything has changed.
class BROADSIDE_PUBLIC InvalidFrame : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// A query with a NaN, or with an infinity where that is not allowed.
class BROADSIDE_PUBLIC InvalidQuery : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// A spec that cannot be parsed, or has an unknown algorithm, an unknown tunable or a value out of range.
class BROADSIDE_PUBLIC InvalidSpec : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// A handle that names no box of this world: never issued, removed, or from another world.
class BROADSIDE_PUBLIC InvalidHandle : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// Bytes that are no snapshot, or the snapshot of another kind of world.
class BROADSIDE_PUBLIC InvalidSnapshot : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// What happens to an invalid box: one that has a NaN, or min > max and is not absent. It is the same in
/// every build, for every algorithm, and for floats and doubles. No algorithm ever sees an invalid box.
/// Infinite boxes are valid.
enum class BadInput : std::uint8_t {
  reject,     ///< InvalidInput is thrown before anything has changed; it names the first invalid box
  quarantine  ///< the box counts as absent and is listed by quarantined()
};

}  // namespace broadside
