// Rounds boxes of doubles to floats.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "broadside/box.hpp"

#include "core/rounding.hpp"

namespace broadside::kernels {

/// What round_boxes() has seen.
struct RoundedBoxes {
  bool all_present = true;
  bool is_lossless = true;  ///< whether LinearRounding::back() restores every coordinate
  std::uint64_t hash = 0;   ///< as core::hash_of()
};

/// Rounds boxes as core::rounded() does, to `floats`, in one pass. `first_place` is the place of the first
/// box in the array that is hashed. Once a box is not present, the rest is left out, and what is returned
/// says only that.
template <int D>
RoundedBoxes round_boxes(std::span<const Box<D, double>> boxes, std::size_t first_place,
                         const std::array<core::LinearRounding, D>& fit, Box<D>* floats);

/// The same without looking for what was lost, and without a hash, which take most of the time. Returns
/// whether all boxes are present.
template <int D>
bool round_few_boxes(std::span<const Box<D, double>> boxes, const std::array<core::LinearRounding, D>& fit,
                     Box<D>* floats);

}  // namespace broadside::kernels
