// Follows boxes of doubles by their floats: a structure tells which pairs may have changed, and a last test
// in double whether they did.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "broadside/tracker.hpp"

#include "core/rounding.hpp"

namespace broadside::algorithm {

/// Rounding keeps order, as in core::DoubleFinder: boxes that overlap in double do in float. So every pair
/// that began or ended is of a changed box and one that it overlaps, or did, as floats. How coordinates are
/// rounded is chosen by the boxes of the frame in which it starts, and anew when boxes have moved to where
/// that makes too many false candidates. Cost: that of the floats, and a test in double for each candidate.
template <int D>
class DoubleFollower final : public PairTracker<D, double> {
 public:
  /// `floats` has a candidate_tracker().
  explicit DoubleFollower(std::unique_ptr<PairTracker<D>> floats) : floats_(std::move(floats)) {}

 private:
  void update_valid(const Change<D, double>& change, PairSink& begun, PairSink& ended) override;
  std::size_t algorithm_bytes() const noexcept override;

  Box<D> rounded(const Box<D, double>& box) const;
  void start(const Change<D, double>& change);
  void follow(const Change<D, double>& change, bool starts, std::uint64_t most, PairSink& begun,
              PairSink& ended);

  std::array<core::LinearRounding, D> fit_{};
  std::array<core::QuantileRounding, D> quantiles_;
  bool by_quantiles_ = false;
  std::uint64_t false_candidates_ = 0;  // since all boxes were rounded
  std::unique_ptr<PairTracker<D>> floats_;
  std::vector<Box<D>> before_;
  std::vector<Box<D>> now_;
};

}  // namespace broadside::algorithm
