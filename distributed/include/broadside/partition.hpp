// A partition of space into parts that can be joined independently: one after another on one machine, or at
// the same time on several.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "broadside/box.hpp"
#include "broadside/export.hpp"
#include "broadside/pair.hpp"

namespace broadside {

/// A partition of space. A part is a box that includes its lower bounds and excludes its upper ones, so every
/// point lies in exactly one part.
///
/// Give each part the boxes that touch it. The reference point of a pair of overlapping boxes is the greater
/// of their two minima on every axis. The pair belongs to the part that contains this point; both boxes touch
/// that part. If each part is joined by itself and keeps the pairs that belong to it, every pair is found
/// once, and a part can be joined again without the others. PartPairs decides from begins_before() of two
/// boxes whether their pair belongs to a part.
///
/// Copying copies the cuts. Const functions are thread-safe.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC Partition {
 public:
  /// A cut perpendicular to an axis. Points below `at` are on one side, all others on the other side.
  struct Cut {
    static constexpr std::uint32_t part = UINT32_MAX;

    std::uint32_t axis = part;  ///< `part` marks a leaf, which is a part
    std::uint32_t below = 0;  ///< index in cuts() of the lower side's cut; in a leaf, the number of its part
    std::uint32_t above = 0;  ///< index in cuts() of the upper side's cut
    Real at = 0;

    friend bool operator==(const Cut&, const Cut&) = default;
  };

  /// The bounds of a part; infinite on sides without a cut.
  struct Region {
    Point<D, Real> low;
    Point<D, Real> high;

    friend bool operator==(const Region&, const Region&) = default;

    /// Whether a present box touches the part.
    bool touches(const Box<D, Real>& box) const noexcept {
      bool is_touching = true;
      for (std::size_t axis = 0; axis < D; ++axis) {
        is_touching &= box.max[axis] >= low[axis];
        is_touching &= box.min[axis] < high[axis] || high[axis] == std::numeric_limits<Real>::infinity();
      }
      return is_touching;
    }

    /// Bit i is set if the box begins before the part on axis i.
    unsigned begins_before(const Box<D, Real>& box) const noexcept {
      unsigned axes = 0;
      for (std::size_t axis = 0; axis < D; ++axis) axes |= unsigned{box.min[axis] < low[axis]} << axis;
      return axes;
    }
  };

  static constexpr Region everything() noexcept {
    Region region;
    region.low.fill(-std::numeric_limits<Real>::infinity());
    region.high.fill(std::numeric_limits<Real>::infinity());
    return region;
  }

  /// The estimated cost of joining a part of this many boxes and pairs. The unit is the cost of reading,
  /// sorting and sweeping one box.
  static constexpr double cost(std::uint64_t boxes, std::uint64_t pairs) noexcept {
    // docs/lab-notes.md has the measurements.
    constexpr double cost_of_pair = 0.15;
    return static_cast<double>(boxes) + cost_of_pair * static_cast<double>(pairs);
  }

  /// One part: all of space.
  Partition() : Partition({}, 1) {}

  /// Cuts `space` into parts of about equal cost, from a sample of the boxes. There are at most `parts`
  /// parts, and fewer if no cuts separate the boxes. A part's cost counts its boxes and, if `boxes` says how
  /// many boxes the sample stands for, its pairs. The same arguments give the same cuts. Absent boxes are
  /// ignored.
  ///
  /// Cost: O(s log s) for each doubling of the parts, with a sample of s boxes.
  Partition(std::span<const Box<D, Real>> sample, std::size_t parts, std::uint64_t boxes = 0,
            const Region& space = everything());

  /// Copies a partition from its cuts(). Throws std::invalid_argument if the list is not a tree as cuts()
  /// returns it.
  explicit Partition(std::span<const Cut> cuts, const Region& space = everything());

  std::size_t size() const noexcept { return regions_.size(); }

  const Region& region(std::size_t part) const noexcept { return regions_[part]; }

  /// The cuts as a tree with its root first. They suffice to recreate the partition elsewhere.
  std::span<const Cut> cuts() const noexcept { return cuts_; }

  /// The part that contains a point.
  std::size_t owner(const Point<D, Real>& point) const noexcept {
    std::uint32_t at = 0;
    while (cuts_[at].axis != Cut::part) {
      const Cut& cut = cuts_[at];
      at = point[cut.axis] < cut.at ? cut.below : cut.above;
    }
    return cuts_[at].below;
  }

  /// Calls visit(part) for each part that a present box touches, in ascending order.
  template <typename Visit>
  void for_each_part(const Box<D, Real>& box, const Visit& visit) const {
    // As deep as the tree: each level leaves at most one side for later.
    std::array<std::uint32_t, max_depth> later;
    std::size_t waiting = 0;
    std::uint32_t at = 0;
    while (true) {
      const Cut& cut = cuts_[at];
      if (cut.axis == Cut::part) {
        visit(std::size_t{cut.below});
        if (waiting == 0) return;
        at = later[--waiting];
        continue;
      }
      const bool is_above = box.max[cut.axis] >= cut.at;
      if (!(box.min[cut.axis] < cut.at)) {
        at = cut.above;
      } else {
        if (is_above) later[waiting++] = cut.above;
        at = cut.below;
      }
    }
  }

 private:
  static constexpr std::size_t max_depth = 64;

  detail::Vector<Cut> cuts_;
  detail::Vector<Region> regions_;
};

/// Passes on the pairs of a part's boxes that belong to the part. Not thread-safe. It keeps the order of the
/// search, even of a search by several threads.
class BROADSIDE_PUBLIC PartPairs final : public PairSink {
 public:
  /// `left` holds begins_before() of each box of one set, and `right` that of the other; pass the same for
  /// both if there is only one set. They and `pairs` must outlive the sink.
  PartPairs(std::span<const std::uint8_t> left, std::span<const std::uint8_t> right, PairSink& pairs)
      : left_(left), right_(right), pairs_(&pairs) {}

 private:
  void consume(std::span<const Pair> pairs) override;

  std::span<const std::uint8_t> left_;
  std::span<const std::uint8_t> right_;
  PairSink* pairs_;
};

}  // namespace broadside
