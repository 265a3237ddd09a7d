// How long an algorithm would take on boxes that are too many to try: measured on a few of them and scaled.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace broadside::lab {

/// A time that was not measured.
struct Estimate {
  double seconds;    ///< for all boxes
  std::size_t from;  ///< the number of boxes that was measured
  double exponent;   ///< of the scaling: time grows as n^exponent
};

/// From this many boxes on, an algorithm is tried on a few of them before it is let loose on all.
inline constexpr std::size_t boxes_worth_estimating = 5'000;

/// Whether an algorithm would take longer than `budget` seconds on `boxes` boxes: its estimate if so, empty
/// if it may run. `seconds_for` measures it on so many of the boxes.
///
/// A twentieth of the boxes is measured first. If even quadratic growth from there stays in the budget,
/// nothing else is; otherwise a fifth, where that is affordable, and the growth between the two says how to
/// scale: as n^1 at least and n^2 at most, and n^1.8 counts as n^2.
std::optional<Estimate> estimate_above(double budget, std::size_t boxes,
                                       const std::function<double(std::size_t boxes)>& seconds_for);

/// "estimated 41.2 s from 20,000 boxes, scaled by n^2.00".
std::string text(const Estimate& estimate);

}  // namespace broadside::lab
