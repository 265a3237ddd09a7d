// Random numbers that are the same on every machine and with every compiler: Vigna's splitmix64, and exact
// arithmetic, because the distributions of the standard library and the functions of libm differ between
// implementations.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace broadside::lab {

/// A stream of random numbers, determined by its seed.
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

  /// An integer in [0, count), for 0 < count <= 2^32.
  std::uint64_t below(std::uint64_t count) noexcept { return (bits() >> 32) * count >> 32; }

  /// True with the given probability.
  bool chance(double probability) noexcept { return fraction() < probability; }

  /// Approximately normal with mean 0 and standard deviation 1: the sum of twelve uniform numbers, which
  /// needs no logarithm.
  double gaussian() noexcept {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += fraction();
    return sum;
  }

  /// A vector of length 1 in a random direction.
  template <int D>
  std::array<double, D> direction() noexcept {
    for (;;) {
      std::array<double, D> vector;
      double square = 0;
      for (double& component : vector) {
        component = between(-1, 1);
        square += component * component;
      }
      // Accepts only points of the ball, because the corners of the cube would bias directions; rejects its
      // centre, where rounding is poor.
      if (square > 1 || square < 0.01) continue;
      for (double& component : vector) component /= std::sqrt(square);
      return vector;
    }
  }

  /// Moves a random choice of `count` of the values to the front, in random order.
  template <typename T>
  void shuffle(std::vector<T>& values, std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i) std::swap(values[i], values[i + below(values.size() - i)]);
  }

 private:
  std::uint64_t state_;
};

}  // namespace broadside::lab
