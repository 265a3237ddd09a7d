// Statistics of boxes that decide which algorithm suits them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lab/formats/frames.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// The percentiles of sizes.
inline constexpr std::array<double, 5> size_percentiles = {0.01, 0.25, 0.5, 0.75, 0.99};

/// A box that moves further than this many times its longest side in one frame has jumped.
inline constexpr double sides_of_a_jump = 8;

/// How boxes move. Fractions are of the present boxes. A box moves if it is present in two consecutive frames
/// with different bounds.
struct MotionSignals {
  std::size_t frames = 0;         ///< after the first
  double min_moving = 0;          ///< the fraction of boxes that move, in the calmest frame,
  double moving = 0;              ///< in the mean of all frames,
  double max_moving = 0;          ///< and in the busiest one
  std::optional<double> drift{};  ///< distance that a mover's centre goes in a frame, in units of its longest
                                  ///< side: the median over all moves; empty if no box with a size moves
  double jumps = 0;               ///< the fraction of these moves that are jumps
  double added = 0;               ///< boxes added, in the mean frame
  double removed = 0;             ///< boxes removed, likewise
};

/// Statistics of boxes. All but the motion are of the fullest frame: the first one with the maximum number of
/// boxes.
struct Signals {
  int dimension = 2;
  Precision precision = Precision::float32;
  std::size_t boxes = 0;        ///< present boxes
  std::size_t absent = 0;       ///< places without a box
  std::size_t infinite = 0;     ///< boxes that reach to infinity
  std::size_t points = 0;       ///< boxes without any extent
  std::size_t flat = 0;         ///< boxes without extent on some axis but not on all
  bool floats_hold_all = true;  ///< whether floats represent every coordinate of the frame exactly
  std::array<double, size_percentiles.size()> sizes{};  ///< longest sides at size_percentiles: for each, the
                                                        ///< smallest size that this fraction of the boxes
                                                        ///< does not exceed
  double largest = 0;                                   ///< the maximum longest side, without infinite ones
  std::vector<double> axis_tests{};  ///< for each axis, the pairs of boxes whose projections on it overlap,
                                     ///< per box: the tests of a sweep along this axis
  double clustering = 1;  ///< pairs of boxes near each other, relative to boxes with the same distribution on
                          ///< each axis but independent axes
  std::optional<double> overlaps{};       ///< mean number of boxes that a box overlaps, if measured
  std::optional<MotionSignals> motion{};  ///< empty if there is only one frame

  /// The axis with the fewest tests.
  std::size_t best_axis() const;
};

/// Cost: O(n log n) for the fullest frame, O(moves log moves) for motion. Boxes must be valid or absent.
template <int D, typename Real>
Signals signals_of(const History<D, Real>& history);

/// The signals as sentences.
std::string text_of(const Signals& signals);

/// "x", "y" or "z".
char axis_name(std::size_t axis) noexcept;

}  // namespace broadside::lab
