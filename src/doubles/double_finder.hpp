// Pairs of boxes of doubles, by a finder of floats and a last test in double.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "broadside/debug/outline.hpp"
#include "broadside/finder.hpp"

#include "core/large_array.hpp"
#include "core/parallel.hpp"

namespace broadside::core {

/// Finds pairs of boxes of doubles exactly, through any finder of floats.
///
/// Rounding never puts two coordinates into the wrong order, at worst it makes them equal. So boxes that
/// overlap in double overlap in float as well; and boxes that overlap in float by more than touching overlap
/// in double. So only the float finder's pairs that touch need a test in double, and none if rounding has
/// lost nothing. That costs much only where rounding makes many separate boxes touch; there coordinates are
/// rounded by their quantiles, which distinguish more of them than one scale does.
template <int D>
class DoubleFinder final : public PairFinder<D, double>, public Outlined<D, double> {
 public:
  Outlined<D, double>* outlined() noexcept override { return this; }
  /// It gives up when the finder of floats does; is_left() then takes the boxes of that finder.
  Yielding<D>* yielding() noexcept override { return finder_->yielding(); }

  explicit DoubleFinder(std::unique_ptr<PairFinder<D>> finder);

  std::string explanation() const override { return finder_->explanation(); }

 private:
  void find_valid(std::span<const Box<D, double>> boxes, PairSink& pairs) override;

  /// Sets floats_. Returns whether coordinates that differ do so as floats.
  bool round(std::span<const Box<D, double>> boxes);

  /// As if a linear rounding did.
  Outline<D, double> lay_out(std::span<const Box<D, double>> boxes) override;

  std::unique_ptr<PairFinder<D>> finder_;
  Parallel parallel_;
  LargeArray<Box<D>> floats_;
};

}  // namespace broadside::core
