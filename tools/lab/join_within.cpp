// Pairs of boxes within a distance: enlarges each box by half the distance, rounded outward, finds the
// overlapping pairs, and then tests each pair exactly.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <variant>
#include <vector>

#include "lab/join.hpp"
#include "lab/pair_filter.hpp"

namespace broadside::lab {
namespace {

/// Whether b - a <= distance as real numbers. After Knuth's TwoSum, a + distance is exactly sum + error. As
/// sum is the nearest double, no other double lies between it and the exact sum.
bool gap_is_within(double a, double b, double distance) {
  if (b <= a) return true;
  const double sum = a + distance;
  if (b != sum) return b < sum;
  const double part = sum - a;
  const double error = (a - (sum - part)) + (distance - part);
  // NaN if the sum is infinite: then b is infinite as well, and a is not.
  return error >= 0;
}

template <int D, typename Real>
bool gaps_are_within(const Box<D, Real>& a, const Box<D, Real>& b, double distance) {
  bool within = true;
  for (std::size_t axis = 0; axis < D; ++axis) {
    within = within &&
             gap_is_within(static_cast<double>(a.max[axis]), static_cast<double>(b.min[axis]), distance) &&
             gap_is_within(static_cast<double>(b.max[axis]), static_cast<double>(a.min[axis]), distance);
  }
  return within;
}

/// The boxes, each enlarged by at least half the distance on every side.
template <int D, typename Real>
std::vector<Box<D, Real>> enlarged(const std::vector<Box<D, Real>>& boxes, double distance) {
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  const double half = distance / 2;
  std::vector<Box<D, Real>> result = boxes;
  for (Box<D, Real>& box : result) {
    if (is_absent(box)) continue;
    for (std::size_t axis = 0; axis < D; ++axis) {
      // The next representable number makes up for rounding, also where half of the smallest number rounds to
      // 0.
      box.min[axis] = std::nextafter(static_cast<Real>(static_cast<double>(box.min[axis]) - half), -infinity);
      box.max[axis] = std::nextafter(static_cast<Real>(static_cast<double>(box.max[axis]) + half), infinity);
    }
  }
  return result;
}

/// Passes on the pairs of boxes within the distance.
template <int D, typename Real>
class PairsWithin final : public PairSink {
 public:
  PairsWithin(const std::vector<Box<D, Real>>& left, const std::vector<Box<D, Real>>& right, double distance,
              PairSink& pairs)
      : left_(left), right_(right), distance_(distance), pairs_(pairs) {}

 private:
  void consume(std::span<const Pair> pairs) override {
    write_if(pairs, pairs_, [this](Pair pair) {
      const Box<D, Real>& a = left_[index(pair.first)];
      const Box<D, Real>& b = right_[index(pair.second)];
      return gaps_are_within(a, b, distance_);
    });
  }

  const std::vector<Box<D, Real>>& left_;
  const std::vector<Box<D, Real>>& right_;
  double distance_;
  PairSink& pairs_;
};

}  // namespace

void join_within(const AnyBoxes& boxes, double distance, const Entry& entry, PairSink& pairs,
                 const PairFilters& filters) {
  std::visit(
      [&]<int D, typename Real>(const std::vector<Box<D, Real>>& list) {
        PairsWithin<D, Real> within(list, list, distance, pairs);
        join(enlarged(list, distance), entry, within, filters);
      },
      boxes);
  pairs.flush();
}

void join_within(const AnyBoxes& left, const AnyBoxes& right, double distance, const Entry& entry,
                 PairSink& pairs, const PairFilters& filters) {
  std::visit(
      [&]<int D, typename Real>(const std::vector<Box<D, Real>>& list) {
        const auto& other = std::get<std::vector<Box<D, Real>>>(right);
        PairsWithin<D, Real> within(list, other, distance, pairs);
        join(enlarged(list, distance), enlarged(other, distance), entry, within, filters);
      },
      left);
  pairs.flush();
}

}  // namespace broadside::lab
