// Pairs of boxes of doubles, by a finder of floats and a last test in double.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "broadside/broad_phase.hpp"
#include "broadside/outline.hpp"

#include "core/parallel.hpp"

namespace broadside::core {

/// Finds pairs of boxes of doubles exactly, through any finder of floats.
///
/// Subtracting an origin and rounding to float never puts two coordinates into the wrong order, at worst it
/// makes them equal. So boxes that overlap in double overlap in float as well; and boxes that overlap in
/// float by more than touching overlap in double. What is left is to test in double those of the float
/// finder's pairs that only touch, unless rounding has lost nothing. That costs much only where rounding
/// makes many boxes touch that lie apart; there the boxes are split into regions, each with an origin of its
/// own. A pair is reported in the region that holds the greater of the two minima on every axis.
template <int D>
class DoubleFinder final : public PairFinder<D, double>, public Outlined<D, double> {
 public:
  explicit DoubleFinder(std::unique_ptr<PairFinder<D>> finder);

  std::string explanation() const override { return finder_->explanation(); }

 private:
  /// The points with begin <= x < end on every axis; +inf lies in what ends at +inf.
  struct Region {
    std::array<double, D> begin;
    std::array<double, D> end;
  };

  /// What a region's boxes look like on one axis, by a sample of them.
  struct Axis {
    double origin;      // the median of the minima
    double extent;      // and of the extents
    double low;         // the least and
    double high;        // the greatest of the minima
    double coarseness;  // how far rounding may move a coordinate in the region, over the extent
  };

  /// Places among the boxes, ascending.
  struct Places {
    const std::uint32_t* list;  // none: all there are
    std::size_t size;

    std::uint32_t operator[](std::size_t i) const {
      return list == nullptr ? static_cast<std::uint32_t>(i) : list[i];
    }
  };

  void find_valid(std::span<const Box<D, double>> boxes, PairSink& pairs) override;

  /// As if all boxes were one region, whose origin is the first box that has one.
  Outline<D, double> lay_out(std::span<const Box<D, double>> boxes) override;
  void workers_changed() override { finder_->set_workers(this->workers()); }

  /// Reports the region's pairs. Its boxes are those whose places are [begin, end) of the stack, ascending.
  void search(std::size_t begin, std::size_t end, const Region& region, PairSink& pairs);

  Places places(std::size_t begin, std::size_t end) const {
    return {stack_.empty() ? nullptr : stack_.data() + begin, end - begin};
  }

  Axis sample(const Places& places, const Region& region, int axis);

  /// Sets the coarseness of the axes and exact_, and puts each box into a bucket.
  void measure(const Places& places, const Region& region, std::array<Axis, D>& axes);

  /// Reports the pairs of the boxes at `places`, which were the last to be measured, as floats.
  void search_floats(const Places& places, const Region& region, const std::array<Axis, D>& axes,
                     PairSink& pairs);

  /// Sets ids_ and floats_, bucket by bucket. Returns how many boxes are of the left set.
  std::size_t gather(const Places& places, const std::array<Axis, D>& axes);

  /// What a pass over some boxes tells of all coordinates.
  struct Bounds {
    std::array<double, D> low;
    std::array<double, D> high;
    bool exact;  // whether floats tell all coordinates apart that differ
  };

  std::unique_ptr<PairFinder<D>> finder_;
  Parallel parallel_;
  std::span<const Box<D, double>> boxes_;
  std::vector<std::uint32_t> stack_;  // empty until the boxes are split
  std::vector<double> minima_;
  std::vector<double> extents_;
  std::vector<std::uint32_t> ids_;  // places of the boxes being searched as floats,
  std::vector<Box<D>> floats_;      // and these
  std::vector<std::uint16_t> bucket_of_;
  std::vector<Bounds> bounds_;              // by range
  std::vector<std::uint32_t> bucket_ends_;  // by range and bucket
  std::size_t bucket_count_ = 1;            // for each of the two sets
  bool exact_ = false;                      // whether floats tell all coordinates apart that differ
  Statistics statistics_;
  bool counted_ = false;
};

}  // namespace broadside::core
