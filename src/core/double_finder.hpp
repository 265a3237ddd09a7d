// Pairs of boxes of doubles, by a finder of floats and a last test in double.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "broadside/broad_phase.hpp"

namespace broadside::core {

/// Finds pairs of boxes of doubles exactly, through any finder of floats.
///
/// Subtracting an origin and rounding to float never puts two coordinates into the wrong order, at worst it
/// makes them equal. So boxes that overlap in double overlap in float as well, and what is left is to test
/// the float finder's pairs in double. That costs much only where rounding makes many boxes touch that lie
/// apart; there the boxes are split into regions, each with an origin of its own. A pair is reported in the
/// region that holds the greater of the two minima on every axis.
template <int D>
class DoubleFinder final : public PairFinder<D, double> {
 public:
  explicit DoubleFinder(std::unique_ptr<PairFinder<D>> finder);

 private:
  /// The points with begin <= x < end on every axis; +inf lies in what ends at +inf.
  struct Region {
    std::array<double, D> begin;
    std::array<double, D> end;
  };

  /// What a region's boxes look like on one axis.
  struct Axis {
    double low;         // the finite bounds of their coordinates within the region
    double high;        //
    double coarseness;  // how far rounding may move a coordinate, over the median of the boxes' extents
    double middle;      // the median of a sample of minima
  };

  class ExactSink;

  void find_valid(std::span<const Box<D, double>> boxes, PairSink& pairs) override;

  /// Reports the region's pairs. Its boxes are those whose places are [begin, end) of the stack, ascending.
  void search(std::size_t begin, std::size_t end, const Region& region, PairSink& pairs);

  Axis survey(std::size_t begin, std::size_t end, const Region& region, int axis);

  /// Reports the pairs of the boxes at `places` as floats about the axes' lower bounds.
  void search_floats(std::span<const std::uint32_t> places, const std::array<Axis, D>& axes,
                     const Region& region, PairSink& pairs);

  /// Appends boxes to ids_ and exact_, those near each other in space near each other in the arrays.
  void gather(std::span<const std::uint32_t> places, const std::array<Axis, D>& axes);

  std::unique_ptr<PairFinder<D>> finder_;
  std::span<const Box<D, double>> boxes_;
  std::vector<std::uint32_t> stack_;
  std::vector<double> minima_;
  std::vector<double> extents_;
  std::vector<BoxId> ids_;             // of the boxes being searched as floats
  std::vector<Box<D, double>> exact_;  // the boxes themselves
  std::vector<Box<D>> floats_;         // and as floats
  std::vector<std::uint16_t> bucket_of_;
  std::vector<std::uint32_t> bucket_ends_;
  Statistics statistics_;
  bool counted_ = false;
};

}  // namespace broadside::core
