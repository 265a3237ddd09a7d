// Statistics of a list of measured times.
#pragma once

#include <span>

namespace broadside::lab {

/// The middle sample, or the mean of the middle two. Throws std::invalid_argument if there are none.
double median(std::span<const double> samples);

/// The smallest sample such that at least `fraction` of all are not above it: 0.99 for p99. Throws
/// std::invalid_argument if there are no samples.
double percentile(std::span<const double> samples, double fraction);

/// The geometric mean of positive numbers. Throws std::invalid_argument if there are none.
double geometric_mean(std::span<const double> numbers);

}  // namespace broadside::lab
