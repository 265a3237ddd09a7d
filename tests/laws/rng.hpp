// Random numbers that are the same with every compiler and standard library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <utility>

namespace broadside::laws {

/// Seeded random numbers. Their slight bias does not matter here.
class Rng {
 public:
  explicit Rng(std::uint64_t seed) : engine_(seed) {}

  /// A number from 0 to `count` - 1.
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }

  /// A whole number, both ends included.
  int whole(int least, int most) { return least + static_cast<int>(below(std::size_t(most - least + 1))); }

  /// A number of the unit interval with 24 random bits.
  float unit() { return static_cast<float>(engine_() >> 40) * 0x1p-24f; }

  float between(float least, float most) { return least + (most - least) * unit(); }

  bool one_in(std::size_t count) { return below(count) == 0; }

  template <typename T>
  const T& one_of(std::span<const T> values) {
    return values[below(values.size())];
  }

  template <typename Sequence>
  void shuffle(Sequence& sequence) {
    for (std::size_t i = sequence.size(); i > 1; --i) std::swap(sequence[i - 1], sequence[below(i)]);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace broadside::laws
