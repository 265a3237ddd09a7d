// What the library throws. Every message names the thing, the value found and the value expected.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "broadside/export.hpp"

namespace broadside {

/// A box that no algorithm may see: a NaN, or min > max without being absent; or, where a box is added to a
/// world, an absent one. Thrown before anything has changed.
class BROADSIDE_PUBLIC InvalidInput : public std::invalid_argument {
 public:
  InvalidInput(std::size_t index, const std::string& message)
      : std::invalid_argument(message), index_(index) {}

  /// The place of the first such box in the array that it was handed in with; 0 for one box alone.
  std::size_t index() const noexcept { return index_; }

 private:
  std::size_t index_;
};

/// A frame or an array whose parts do not fit together: too many boxes, a filter missing, a listed place that
/// is none, a change that is not listed. Thrown before anything has changed.
class BROADSIDE_PUBLIC InvalidFrame : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// A question with a NaN, or with an infinity where there may be none.
class BROADSIDE_PUBLIC InvalidQuery : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// A spec that cannot be read, or that names an algorithm or a tunable that does not exist or a value out of
/// range.
class BROADSIDE_PUBLIC InvalidSpec : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// A handle that names no box of this world: never issued, removed, or another world's.
class BROADSIDE_PUBLIC InvalidHandle : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// Bytes that are no snapshot of a world, or not of one like this.
class BROADSIDE_PUBLIC InvalidSnapshot : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// What is done about an invalid box: one with a NaN, or with min > max without being the absent box. It is
/// the same in every build, for every algorithm, and for floats and doubles; no algorithm ever sees such a
/// box. Infinite boxes are valid.
enum class BadInput : std::uint8_t {
  reject,     ///< InvalidInput is thrown, naming the first one, before anything has changed
  quarantine  ///< it counts as absent, pairs with nothing, and is listed by quarantined()
};

/// " (did you mean 'grid'?)" for the one of `known` that is closest to `found`: at most two letters are
/// missing, too many, wrong or swapped (one where `found` has fewer than five), or `found` is how it begins.
/// Case is not looked at. Empty where none is that close.
BROADSIDE_PUBLIC std::string did_you_mean(std::string_view found, std::span<const std::string> known);

}  // namespace broadside
