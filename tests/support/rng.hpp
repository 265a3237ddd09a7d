// Choices that a test's generator makes: drawn by a seed, or read from bytes, which a fuzzer mutates and
// RapidCheck shrinks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "lab/scenes/random.hpp"

namespace broadside {

/// A source of choices. The first of the alternatives should be the simplest.
class Choices {
 public:
  /// A number from 0 to `count` - 1, for 0 < count <= 2^32.
  virtual std::size_t below(std::size_t count) = 0;

  /// True of one in `count`; false where nothing is left to choose.
  virtual bool one_in(std::size_t count) = 0;

  /// Whether all has been chosen: the rest would be zeros.
  virtual bool is_spent() const { return false; }

  /// A whole number from `min` to `max`, inclusive.
  int whole(int min, int max) { return min + static_cast<int>(below(std::size_t(max - min + 1))); }

  /// A number in [0, 1) with 24 random bits.
  float unit() { return static_cast<float>(below(1 << 24)) * 0x1p-24f; }

  float between(float min, float max) { return min + (max - min) * unit(); }

  template <typename T>
  const T& one_of(std::span<const T> values) {
    return values[below(values.size())];
  }

  template <typename Sequence>
  void shuffle(Sequence& sequence) {
    for (std::size_t i = sequence.size(); i > 1; --i) std::swap(sequence[i - 1], sequence[below(i)]);
  }

 protected:
  ~Choices() = default;
};

/// Seeded random numbers: those of the scenes, which are the same with every compiler and standard library.
class Rng final : public Choices {
 public:
  explicit Rng(std::uint64_t seed) : random_(seed) {}

  std::uint64_t bits() { return random_.bits(); }
  std::size_t below(std::size_t count) override { return static_cast<std::size_t>(random_.below(count)); }
  bool one_in(std::size_t count) override { return below(count) == 0; }

 private:
  lab::Random random_;
};

/// Bytes that others keep, one after the other.
class ByteChoices final : public Choices {
 public:
  explicit ByteChoices(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool is_spent() const override { return bytes_.empty(); }

  std::uint8_t next() {
    if (bytes_.empty()) return 0;
    const std::uint8_t byte = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return byte;
  }

  std::size_t below(std::size_t count) override {
    std::size_t number = next();
    for (std::size_t more = (count - 1) >> 8; more > 0; more >>= 8) number = number << 8 | next();
    return number % count;
  }

  bool one_in(std::size_t count) override { return below(count) == count - 1; }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace broadside
