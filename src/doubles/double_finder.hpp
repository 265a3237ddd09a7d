// Pairs of boxes of doubles, by a finder of floats and a last test in double.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "broadside/debug/outline.hpp"
#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"

#include "core/parallel.hpp"
#include "core/rounding.hpp"

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

  explicit DoubleFinder(std::unique_ptr<PairFinder<D>> finder);

  std::string explanation() const override { return finder_->explanation(); }

 private:
  using Fit = std::array<LinearFit, D>;

  void find_valid(std::span<const Box<D, double>> boxes, PairSink& pairs) override;

  /// As if a linear rounding did.
  Outline<D, double> lay_out(std::span<const Box<D, double>> boxes) override;
  void workers_changed() override { finder_->set_workers(this->workers()); }

  /// Puts each box into a bucket of near ones. Returns whether coordinates that differ do so as floats.
  bool measure(std::span<const Box<D, double>> boxes, const Fit& fit);

  /// Sets ids_ and floats_, bucket by bucket. Returns how many boxes are of the left set.
  template <typename RoundingOf>
  std::size_t gather(std::span<const Box<D, double>> boxes, RoundingOf rounding_of);

  std::unique_ptr<PairFinder<D>> finder_;
  Parallel parallel_;
  std::vector<std::uint32_t> ids_;  // places of the boxes, bucket by bucket,
  std::vector<Box<D>> floats_;      // and these as floats
  std::vector<std::uint16_t> bucket_of_;
  std::vector<std::uint32_t> bucket_ends_;  // by range and bucket
  std::size_t bucket_count_ = 1;            // for each of the two sets
};

}  // namespace broadside::core
