// ExactSink: passes on those pairs of a finder of floats that overlap in double.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "core/filter_sink.hpp"

namespace broadside::core {

/// Boxes of doubles, and the floats that a finder was given for some of them. Must outlive the sinks that
/// read them.
template <int D>
struct RoundedBoxes {
  std::span<const Box<D, double>> boxes;
  std::span<const std::uint32_t> ids;  ///< places among the boxes, by place among the floats
  std::span<const Box<D>> floats;
  std::size_t left_count;  ///< as in a PairFinder; pairs are then places among left and among right floats
  bool exact;              ///< whether coordinates that differ do so as floats
};

/// Passes on, as ids, the pairs that overlap in double. The order stays.
template <int D>
class ExactSink final : public FilterSink {
 public:
  ExactSink(const RoundedBoxes<D>& rounded_boxes, PairSink& target)
      : FilterSink(target), of_(rounded_boxes) {}

  std::unique_ptr<FilterSink> onto(PairSink& target) const override {
    return std::make_unique<ExactSink>(of_, target);
  }

 private:
  void consume(std::span<const Pair> pairs) override;
  std::size_t keep(std::span<const Pair> pairs, Pair* out) const;
  void fetch(std::size_t place) const;

  RoundedBoxes<D> of_;
};

}  // namespace broadside::core
