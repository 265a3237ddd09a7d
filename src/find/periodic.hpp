// Boxes in a cell that repeats on some axes: which of a box's images is nearest to another box, and what is
// searched in the place of boxes and their images.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"

#include "core/filter_sink.hpp"
#include "core/input_check.hpp"
#include "core/pair_set.hpp"

namespace broadside::find {

/// The length after which space repeats on each axis; infinity for an axis on which it does not.
template <int D>
using Periods = std::array<double, D>;

/// Moves a box by whole periods until its min is in [0, period] on each periodic axis. Bounds that already
/// are stay as they are, to the bit. Otherwise the min becomes its exact remainder and the box keeps its
/// length, both rounded to double once. A box at least as long as the period becomes the whole axis.
template <int D, typename Real>
Box<D, double> in_cell(const Box<D, Real>& box, const std::type_identity_t<Periods<D>>& periods) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box<D, double> moved;
  for (std::size_t axis = 0; axis < D; ++axis) {
    double& min = moved.min[axis] = box.min[axis];
    double& max = moved.max[axis] = box.max[axis];
    const double period = periods[axis];
    if (period == infinity) continue;
    const double length = max - min;
    if (length >= period) {
      min = -infinity;
      max = infinity;
    } else if ((min < 0 || min >= period) && std::isfinite(min)) {
      min = std::fmod(min, period);
      if (min < 0) min += period;
      max = min + length;
    }
  }
  return moved;
}

/// Which of two boxes is moved back by one period on an axis, so that their gap is least.
enum class Moved : std::uint8_t { neither, first, second };

/// The first choice with the least gap. No other image is nearer, since both mins are in [0, period] and both
/// lengths less than the period.
inline Moved nearest_image(double a_min, double a_max, double b_min, double b_max, double period) {
  const auto gap = [](double a_low, double a_high, double b_low, double b_high) {
    return std::max({0.0, a_low - b_high, b_low - a_high});
  };
  const double neither = gap(a_min, a_max, b_min, b_max);
  // Whole axes have no gap, and infinite periods no images.
  if (neither == 0 || period == std::numeric_limits<double>::infinity()) return Moved::neither;
  const double first = gap(a_min - period, a_max - period, b_min, b_max);
  const double second = gap(a_min, a_max, b_min - period, b_max - period);
  if (std::min(first, second) >= neither) return Moved::neither;
  return first <= second ? Moved::first : Moved::second;
}

template <int D>
void move_back(Box<D, double>& box, std::size_t axis, double period) {
  box.min[axis] -= period;
  box.max[axis] -= period;
}

/// Moves one of two boxes in the cell back by one period on each axis on which that brings them nearer.
template <int D>
void move_to_nearest(Box<D, double>& a, Box<D, double>& b, const std::type_identity_t<Periods<D>>& periods) {
  for (std::size_t axis = 0; axis < D; ++axis) {
    const Moved moved = nearest_image(a.min[axis], a.max[axis], b.min[axis], b.max[axis], periods[axis]);
    if (moved == Moved::first) move_back(a, axis, periods[axis]);
    if (moved == Moved::second) move_back(b, axis, periods[axis]);
  }
}

/// What is searched in the place of a set of boxes: each box, moved into the cell, and then images of those
/// near the cell's end, moved back by one period on some axes. All are enlarged.
template <int D, typename Real>
class PeriodicSet {
 public:
  PeriodicSet(std::span<const Box<D, Real>> boxes, const Periods<D>& periods) : periods_(periods) {
    cells_.reserve(boxes.size());
    for (const Box<D, Real>& box : boxes)
      cells_.push_back(is_present(box) ? in_cell(box, periods) : absent_box<D, double>());
  }

  /// Makes the places: enlarge(box in the cell, by) is a box of type Real around it, and by(box) how far a
  /// box is enlarged, at most `most`.
  template <typename By, typename Enlarge>
  void make_places(const By& by, double most, const Enlarge& enlarge) {
    for (const Box<D, double>& cell : cells_) places_.push_back(enlarge(cell, by(places_.size())));
    for (std::size_t box = 0; box < cells_.size(); ++box) add_images(box, by(box), most, enlarge);
  }

  std::span<const Box<D, Real>> places() const { return places_; }
  const Box<D, double>& cell(BoxId box) const { return cells_[index(box)]; }

  BoxId owner(BoxId place) const {
    return is_image(place) ? images_[index(place) - cells_.size()].owner : place;
  }

  /// The axes, as bits, on which a place is moved back.
  unsigned moved_axes(BoxId place) const {
    return is_image(place) ? images_[index(place) - cells_.size()].axes : 0;
  }

  /// The filters of the places.
  std::vector<Filter> filters_of_places(std::span<const Filter> filters) const {
    std::vector<Filter> all(filters.begin(), filters.end());
    for (const Image& image : images_) {
      if (!filters.empty()) all.push_back(filters[index(image.owner)]);
    }
    return all;
  }

 private:
  struct Image {
    BoxId owner;
    unsigned axes;
  };

  bool is_image(BoxId place) const { return index(place) >= cells_.size(); }

  template <typename Enlarge>
  void add_images(std::size_t box, double by, double most, const Enlarge& enlarge) {
    // A neighbour's enlarged min may be as low as -most. The bound allows for what sums round off.
    unsigned crossed = 0;
    for (std::size_t axis = 0; axis < D; ++axis) {
      constexpr double infinity = std::numeric_limits<double>::infinity();
      const double max = cells_[box].max[axis];
      if (periods_[axis] < infinity && max < infinity && max + by + most >= periods_[axis] * (1 - 0x1p-50))
        crossed |= 1U << axis;
    }
    for (unsigned axes = crossed; axes != 0; axes = (axes - 1) & crossed) {
      Box<D, double> image = cells_[box];
      for (std::size_t axis = 0; axis < D; ++axis) {
        if ((axes >> axis & 1U) != 0) move_back(image, axis, periods_[axis]);
      }
      core::check_count(places_.size() + 1);
      places_.push_back(enlarge(image, by));
      images_.push_back({static_cast<BoxId>(box), axes});
    }
  }

  Periods<D> periods_;
  std::vector<Box<D, double>> cells_;
  std::vector<Box<D, Real>> places_;
  std::vector<Image> images_;  // the places after those of the boxes
};

/// Passes on the pairs of places that are the nearest images of their boxes and are within reach, as pairs of
/// boxes: is_within(a, b, pair). Each pair of boxes comes once, since only one of its pairs of places is the
/// nearest by move_to_nearest().
template <int D, typename Real, typename Within>
class PeriodicSink final : public core::FilterSink {
 public:
  PeriodicSink(const PeriodicSet<D, Real>& left, const PeriodicSet<D, Real>& right, const Periods<D>& periods,
               const core::PairSet* ignored, Within is_within, PairSink& target)
      : FilterSink(target),
        left_(&left),
        right_(&right),
        periods_(periods),
        ignored_(ignored),
        is_within_(is_within) {}

  std::unique_ptr<FilterSink> onto(PairSink& target) const override {
    return std::make_unique<PeriodicSink>(*left_, *right_, periods_, ignored_, is_within_, target);
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    this->pass_on(pairs, [&](Pair places, Pair& to) {
      to = {left_->owner(places.first), right_->owner(places.second)};
      if (left_ == right_) {
        if (to.first == to.second) return false;
        // Of two images that are equally near, the choice must not depend on the order of the places.
        if (to.second < to.first) {
          std::swap(to.first, to.second);
          std::swap(places.first, places.second);
        }
        if (ignored_ != nullptr && ignored_->contains(to)) return false;
      }
      return are_nearest(places, to);
    });
  }

  bool are_nearest(Pair places, Pair pair) const {
    const unsigned first_axes = left_->moved_axes(places.first);
    const unsigned second_axes = right_->moved_axes(places.second);
    Box<D, double> a = left_->cell(pair.first);
    Box<D, double> b = right_->cell(pair.second);
    for (std::size_t axis = 0; axis < D; ++axis) {
      const Moved moved = nearest_image(a.min[axis], a.max[axis], b.min[axis], b.max[axis], periods_[axis]);
      if ((moved == Moved::first) != ((first_axes >> axis & 1U) != 0)) return false;
      if ((moved == Moved::second) != ((second_axes >> axis & 1U) != 0)) return false;
      if (moved == Moved::first) move_back(a, axis, periods_[axis]);
      if (moved == Moved::second) move_back(b, axis, periods_[axis]);
    }
    return is_within_(a, b, pair);
  }

  const PeriodicSet<D, Real>* left_;
  const PeriodicSet<D, Real>* right_;
  Periods<D> periods_;
  const core::PairSet* ignored_;
  Within is_within_;
};

}  // namespace broadside::find
