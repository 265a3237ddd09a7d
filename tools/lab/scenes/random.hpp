// Random numbers that are the same on every machine and under every compiler: Vigna's splitmix64, and exact
// arithmetic on top of it, because the standard library's distributions and libm differ from one to the next.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace broadside::lab {

/// A stream of random numbers, fixed by its seed.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// 64 random bits.
  std::uint64_t bits() noexcept {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state_;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9U;
    z = (z ^ z >> 27) * 0x94d049bb133111ebU;
    return z ^ z >> 31;
  }

  /// Uniform in [0, 1).
  double fraction() noexcept { return static_cast<double>(bits() >> 11) * 0x1p-53; }

  /// Uniform in [low, high).
  double between(double low, double high) noexcept { return low + (high - low) * fraction(); }

  /// A whole number in [0, count), for 0 < count <= 2^32.
  std::uint64_t below(std::uint64_t count) noexcept { return (bits() >> 32) * count >> 32; }

  /// True with the given probability.
  bool chance(double probability) noexcept { return fraction() < probability; }

  /// Mean 0, standard deviation 1, nearly normal: the sum of twelve uniform numbers needs no logarithm.
  double gaussian() noexcept {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += fraction();
    return sum;
  }

  /// A vector of length 1 in any direction.
  template <int D>
  std::array<double, D> direction() noexcept {
    for (;;) {
      std::array<double, D> vector;
      double square = 0;
      for (double& component : vector) {
        component = between(-1, 1);
        square += component * component;
      }
      // Only points of the ball: the corners of the cube would be favoured. Not its middle: it rounds badly.
      if (square > 1 || square < 0.01) continue;
      for (double& component : vector) component /= std::sqrt(square);
      return vector;
    }
  }

  /// Puts the first `count` of `values` in a random order, drawn from all of them.
  template <typename T>
  void shuffle(std::vector<T>& values, std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i) std::swap(values[i], values[i + below(values.size() - i)]);
  }

 private:
  std::uint64_t state_;
};

}  // namespace broadside::lab
