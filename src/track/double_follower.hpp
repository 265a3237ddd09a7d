// DoubleFollower: follows boxes of doubles by their floats. A structure tells which pairs may have changed,
// and a last test in double whether they did.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "broadside/follower.hpp"

#include "core/rounding.hpp"

namespace broadside::track {

/// Rounding keeps order, as in find::DoubleSearch: boxes that overlap in double do in float. So every pair
/// that began or ended is of a changed box and one that it overlaps, or did, as floats. How coordinates are
/// rounded is chosen by the boxes of the frame in which it starts, and anew when boxes have moved to where
/// that makes too many false candidates. Cost: that of the floats, and a test in double for each candidate.
template <int D>
class DoubleFollower {
 public:
  /// `floats` heeds Change::wants_candidates.
  explicit DoubleFollower(std::unique_ptr<Follower<D>> floats) : floats_(std::move(floats)) {}

  /// As Follower::follow(). Statistics::hits are the candidates.
  std::optional<Statistics> follow(const Change<D, double>& change, PairSink& begun, PairSink& ended);

  std::size_t bytes() const noexcept;

 private:
  Box<D> rounded(const Box<D, double>& box) const;
  void start(const Change<D, double>& change);
  std::optional<Statistics> follow(const Change<D, double>& change, bool starts, std::uint64_t max_false,
                                   PairSink& begun, PairSink& ended);

  std::array<core::LinearRounding, D> fit_{};
  std::array<core::QuantileRounding, D> quantiles_;
  bool by_quantiles_ = false;
  std::uint64_t false_candidates_ = 0;  // since all boxes were rounded
  std::unique_ptr<Follower<D>> floats_;
  std::vector<Box<D>> before_;
  std::vector<Box<D>> now_;
};

}  // namespace broadside::track
