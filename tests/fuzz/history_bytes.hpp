// Bytes read as what happens to boxes: the language of the fuzzers of histories. Any bytes mean something.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>

#include "broadside/box.hpp"
#include "broadside/filter.hpp"

namespace broadside::fuzz {

/// Ends the program, which is how a fuzzer learns of a fault.
inline void expect(bool holds, const std::string& what) {
  if (holds) return;
  std::fprintf(stderr, "%s\n", what.c_str());
  std::abort();
}

/// The bytes one after the other, and 0 when there are none left.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  bool empty() const { return left_ == 0; }

  std::uint8_t next() {
    if (left_ == 0) return 0;
    --left_;
    return *data_++;
  }

  /// A number below `count`.
  std::size_t below(std::size_t count) { return next() % count; }

  /// Mostly small whole numbers and their quarters, so that boxes touch; and what floats can do.
  float coordinate() {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr float largest = std::numeric_limits<float>::max();
    constexpr std::array<float, 16> special = {
        infinity, -infinity, largest, -largest, 1e30F,     -1e30F, 1e-30F,
        -0.0F,    16777216,  1e6F,    -1e6F,    1.000001F, 1e-45F, std::numeric_limits<float>::min(),
        -1e-30F,  3e38F};
    const std::uint8_t byte = next();
    if (byte >= 240) return special[byte - 240];
    if (byte >= 200) return static_cast<float>(byte - 220) / 4;
    return static_cast<float>(byte % 32) - 8;
  }

  /// A present box.
  template <int D>
  Box<D> box() {
    Box<D> box;
    for (int axis = 0; axis < D; ++axis) {
      const float a = coordinate();
      const std::uint8_t extent = next();
      const float b = extent < 16 ? a + static_cast<float>(extent % 4) : coordinate();
      box.min[axis] = std::min(a, b);
      box.max[axis] = std::max(a, b);
    }
    return box;
  }

  Filter filter() {
    const std::uint8_t byte = next();
    Filter filter;
    if (byte % 4 != 0) filter.category = 1U << (byte / 4 % 3);
    if (byte % 3 == 0) filter.mask = byte / 3 % 8;
    if (byte % 5 == 0) filter.group = byte / 5 % 5 - 2;
    filter.is_static = byte % 7 == 0;
    return filter;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

/// A box on a small lattice.
template <int D, typename Real>
Box<D, Real> any_box(Bytes& bytes) {
  Box<D, Real> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = static_cast<Real>(bytes.below(12));
    box.max[axis] = box.min[axis] + static_cast<Real>(bytes.below(4));
  }
  return box;
}

/// Boxes that a few bytes stand for: many, spread, the same for the same seed.
template <int D>
class Spread {
 public:
  explicit Spread(std::uint32_t seed) : state_(seed * 2654435761U + 1) {}

  Box<D> next() {
    Box<D> box;
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = static_cast<float>(random() % 24) - 8;
      box.max[axis] = box.min[axis] + static_cast<float>(random() % 8) / 2;
    }
    return box;
  }

 private:
  std::uint32_t random() {
    state_ = state_ * 1664525U + 1013904223U;
    return state_ >> 16;
  }

  std::uint32_t state_;
};

/// Moves a present box by so much, if it then still is one.
template <int D>
void nudge(Box<D>& box, int axis, float by) {
  Box<D> moved = box;
  moved.min[axis] += by;
  moved.max[axis] += by;
  if (is_present(moved)) box = moved;
}

}  // namespace broadside::fuzz
