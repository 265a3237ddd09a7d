// Statistics of boxes: the numbers that decide which algorithm suits them.
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

/// A box that goes further than this many times its longest side from one frame to the next has jumped.
inline constexpr double sides_of_a_jump = 8;

/// How boxes move. Fractions are of the present boxes; a box moves if it is present in two frames and
/// its place or size differs.
struct MotionSignals {
  std::size_t frames = 0;         ///< after the first
  double min_moving = 0;          ///< the fraction of the boxes that move, in the calmest frame,
  double moving = 0;              ///< in the mean of all frames
  double max_moving = 0;          ///< and in the busiest one
  std::optional<double> drift{};  ///< how far a mover's centre goes in a frame, in units of its longest side:
                                  ///< the median of all moves; empty where no box with a size moves
  double jumps = 0;               ///< the fraction of these moves that are jumps
  double added = 0;               ///< boxes that come, in the mean frame
  double removed = 0;             ///< and that go
};

/// What boxes are like. All but the motion is of the fullest frame: the first with the most boxes.
struct Signals {
  int dimension = 2;
  Precision precision = Precision::float32;
  std::size_t boxes = 0;        ///< present ones
  std::size_t absent = 0;       ///< places without a box
  std::size_t infinite = 0;     ///< boxes that reach to infinity
  std::size_t points = 0;       ///< boxes without any extent
  std::size_t flat = 0;         ///< boxes without extent on some axis but not on all
  bool floats_hold_all = true;  ///< whether a float holds every coordinate of the frame exactly
  std::array<double, size_percentiles.size()> sizes{};  ///< longest sides at size_percentiles; the least that
                                                        ///< so large a part of the boxes does not exceed
  double largest = 0;                                   ///< and the greatest of them; infinite ones left out
  std::vector<double> axis_tests{};  ///< for each axis: pairs of boxes that overlap in their projections on
                                     ///< it, over the number of boxes: what a sweep along it has to test
  double clustering = 1;  ///< how many times as many pairs of boxes are near each other as there would be if
                          ///< the boxes were spread along each axis as they are, but independently
  std::optional<double> overlaps{};  ///< how many others a box overlaps in the mean, where this was measured
  std::optional<MotionSignals> motion{};  ///< empty where there is one frame

  /// The axis with the least tests.
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
