// Random numbers for tests: the scenes' generator, which gives the same numbers with every compiler and
// standard library.
#pragma once

#include <cstddef>
#include <span>
#include <utility>

#include "lab/scenes/random.hpp"

namespace broadside {

/// Seeded random numbers.
class Rng : private lab::Random {
 public:
  using lab::Random::bits;
  using lab::Random::Random;

  /// A number from 0 to `count` - 1.
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(lab::Random::below(count)); }

  /// A whole number from `min` to `max`, inclusive.
  int whole(int min, int max) { return min + static_cast<int>(below(std::size_t(max - min + 1))); }

  /// A number in [0, 1) with 24 random bits.
  float unit() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }

  float between(float min, float max) { return min + (max - min) * unit(); }

  bool one_in(std::size_t count) { return below(count) == 0; }

  template <typename T>
  const T& one_of(std::span<const T> values) {
    return values[below(values.size())];
  }

  template <typename Sequence>
  void shuffle(Sequence& sequence) {
    for (std::size_t i = sequence.size(); i > 1; --i) std::swap(sequence[i - 1], sequence[below(i)]);
  }
};

}  // namespace broadside
