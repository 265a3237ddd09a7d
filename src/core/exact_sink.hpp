// ExactSink: of the pairs that a finder of floats reports, those of boxes that overlap in double.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "core/filter_sink.hpp"

namespace broadside::core {

/// `value` as a float about `origin`. Rises with the value, and is finite.
inline float rounded(double value, double origin) {
  constexpr double largest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value - origin, -largest, largest));
}

/// Boxes of doubles, and the floats that a finder was given for some of them. Must outlive who looks at them.
template <int D>
struct RoundedBoxes {
  std::span<const Box<D, double>> boxes;
  std::span<const std::uint32_t> ids;  ///< places among the boxes, by place among the floats
  std::span<const Box<D>> floats;
  std::size_t left_count;  ///< as in a PairFinder; pairs are then places among left and among right floats
  bool exact;              ///< whether floats tell all coordinates apart that differ
};

/// Passes on, as ids, the pairs that overlap in double and belong to a region: the one in which the greater
/// of the two minima lies. All boxes of a region begin before its end on every axis, so only where it begins
/// needs a test. The order stays.
template <int D>
class ExactSink final : public FilterSink {
 public:
  /// The region begins at `begin`, perhaps at -inf; `origin` is what the floats are rounded about.
  ExactSink(const RoundedBoxes<D>& rounded_boxes, const std::array<double, D>& begin,
            const std::array<double, D>& origin, PairSink& target);

  /// The same onto another target.
  ExactSink(const ExactSink& other, PairSink& target);
  std::unique_ptr<FilterSink> onto(PairSink& target) const override;

 private:
  void consume(std::span<const Pair> pairs) override;
  std::size_t keep(std::span<const Pair> pairs, Pair* out) const;
  void fetch(std::size_t place) const;
  bool is_pair_for_certain(const Box<D>& a, const Box<D>& b) const;
  bool is_pair(const Box<D, double>& a, const Box<D, double>& b) const;

  RoundedBoxes<D> of_;
  bool bounded_ = false;  // whether the region begins anywhere, on any axis
  bool exact_;            // whether every pair of the float finder is one
  std::array<double, D> begin_;
  std::array<float, D> rounded_begin_;
};

}  // namespace broadside::core
