// Order-preserving rounding of doubles to floats.
#include "core/rounding.hpp"

#include <cmath>
#include <utility>

#include "core/bit_cast.hpp"
#include "core/sample.hpp"

namespace broadside::core {
namespace {

constexpr double largest_double = std::numeric_limits<double>::max();

/// How many boxes are sampled to fit an origin and a scale: one in 64. With 256 of a few boxes, the medians
/// took three times as long as a search of 100 boxes.
constexpr std::size_t boxes_per_fitted = 64;
constexpr std::size_t min_fitted = 5;
constexpr std::size_t max_fitted = 256;

/// One box in sixteen provides knots, so that about sixteen coordinates lie between two knots.
constexpr std::size_t boxes_per_knot = 16;
constexpr std::size_t max_knots = std::size_t{1} << 18;  // leaves a float six bits between two knots

/// How many false pairs per box cost about as much as another rounding.
constexpr double max_false_pairs = 8;

/// Each false pair among the compared boxes stands for 4/3 false pairs per box.
constexpr double compared_share = 0.75;
constexpr std::size_t min_compared = 64;

/// The offset of a sample.
std::uint32_t shift_by(std::uint64_t hash) { return static_cast<std::uint32_t>(hash_key(hash) >> 32); }

/// The median; of five numbers without a branch on their order, which no predictor could know.
double fitted_median(std::span<double> values) {
  if (values.size() != min_fitted) {
    std::vector<double> copy(values.begin(), values.end());
    return median(copy);
  }
  const auto [a, b, c, d, e] = std::array{values[0], values[1], values[2], values[3], values[4]};
  const double low = std::max(std::min(a, b), std::min(c, d));
  const double high = std::min(std::max(a, b), std::max(c, d));
  return std::max(std::min(low, high), std::min(std::max(low, high), e));
}

/// Fits one axis to the finite minima of some boxes.
LinearRounding fit_axis(std::span<double> minima) {
  const double origin = fitted_median(minima);
  for (double& min : minima) min = std::min(std::abs(min - origin), largest_double);
  double distance = fitted_median(minima);
  if (distance == 0 && !minima.empty()) distance = *std::max_element(minima.begin(), minima.end());
  return {origin, distance};
}

/// Boxes as a structure of arrays, so that a loop compares one with many.
template <int D>
class RoundedColumns {
 public:
  explicit RoundedColumns(std::size_t max_size) {
    exact_.reserve(max_size);
    for (int axis = 0; axis < D; ++axis) {
      min_[axis].reserve(max_size);
      max_[axis].reserve(max_size);
    }
  }

  void add(const Box<D, double>& exact, const Box<D>& box) {
    exact_.push_back(exact);
    for (int axis = 0; axis < D; ++axis) {
      min_[axis].push_back(box.min[axis]);
      max_[axis].push_back(box.max[axis]);
    }
  }

  std::size_t size() const { return exact_.size(); }

  /// How many of the first `count` boxes overlap box i as floats but not as doubles.
  std::size_t false_pairs(std::size_t i, std::size_t count) const {
    std::uint32_t overlaps = 0;
    for (std::size_t j = 0; j < count; ++j) overlaps += overlap_as_floats(i, j);
    std::size_t wrong = 0;
    for (std::size_t j = 0; j < count && overlaps > 0; ++j)
      wrong += static_cast<std::size_t>(overlap_as_floats(i, j) != 0 && !overlap(exact_[i], exact_[j]));
    return wrong;
  }

 private:
  std::uint32_t overlap_as_floats(std::size_t i, std::size_t j) const {
    std::uint32_t all = 1;
    for (int axis = 0; axis < D; ++axis) {
      all &= static_cast<std::uint32_t>(min_[axis][i] <= max_[axis][j]) &
             static_cast<std::uint32_t>(min_[axis][j] <= max_[axis][i]);
    }
    return all;
  }

  std::vector<Box<D, double>> exact_;
  std::array<std::vector<float>, D> min_;
  std::array<std::vector<float>, D> max_;
};

}  // namespace

LinearRounding::LinearRounding(double origin, double distance) : origin_(origin) {
  if (!(distance > 0)) return;
  // Tunables such as a grid's cell are lengths in the boxes' unit, so the unit is kept if floats can hold
  // such distances.
  constexpr int kept_exponent = 30;
  if (std::abs(std::ilogb(distance)) <= kept_exponent) return;
  // Beyond that, the scale or its inverse would not be a normal number.
  const int exponent = std::clamp(std::ilogb(distance), -1022, 1022);
  scale_ = std::ldexp(1.0, -exponent);
  inverse_scale_ = std::ldexp(1.0, exponent);
}

QuantileRounding::QuantileRounding(std::vector<double> knots) : knots_(std::move(knots)) {
  std::sort(knots_.begin(), knots_.end());
  knots_.erase(std::unique(knots_.begin(), knots_.end()), knots_.end());
  if (knots_.empty()) knots_.push_back(0);
  const auto count = static_cast<double>(knots_.size());
  middle_ = (count - 1) / 2;
  const double range = std::min(knots_.back() - knots_.front(), largest_double);
  slope_ = range > 0 ? std::min(count / range, largest_double) : 1;
}

float QuantileRounding::operator()(double value) const {
  constexpr double largest = std::numeric_limits<float>::max();
  if (!(value > knots_.front())) {
    const double below = (value - knots_.front()) * slope_;
    return static_cast<float>(std::max(-largest, below - middle_));
  }
  if (value >= knots_.back()) {
    const double above = (value - knots_.back()) * slope_;
    return static_cast<float>(std::min(largest, above + middle_));
  }
  // Branchless binary search for the last knot that is not above the value.
  const double* knot = knots_.data();
  for (std::size_t size = knots_.size() - 1; size > 1;) {
    const std::size_t half = size / 2;
    knot += knot[half] <= value ? half : 0;
    size -= half;
  }
  // If the interval's length overflows, its values may become equal: the quotient is then 0 or NaN, which
  // std::max turns into 0.
  const double part = std::min(1.0, std::max(0.0, (value - knot[0]) / (knot[1] - knot[0])));
  return static_cast<float>(static_cast<double>(knot - knots_.data()) - middle_ + part);
}

template <int D>
std::array<LinearRounding, D> fit_linear(std::span<const Box<D, double>> boxes) {
  const std::size_t fitted = std::clamp(boxes.size() / boxes_per_fitted, min_fitted, max_fitted);
  std::array<std::array<double, max_fitted>, D> minima;
  std::array<std::size_t, D> counts{};
  for_present_sample(boxes, fitted, [&](const Box<D, double>& box) {
    for (int axis = 0; axis < D; ++axis) {
      if (std::isfinite(box.min[axis])) minima[axis][counts[axis]++] = box.min[axis];
    }
  });
  std::array<LinearRounding, D> fit;
  for (int axis = 0; axis < D; ++axis) fit[axis] = fit_axis(std::span(minima[axis]).first(counts[axis]));
  return fit;
}

template <int D>
std::uint64_t hash_of(std::span<const Box<D, double>> boxes, std::size_t first_place) {
  // Several threads or lanes can compute parts of a sum: Black et al., "UMAC" (1999), the hash NH.
  std::uint64_t hash = 0;
  std::uint64_t key = hash_key(first_place * 2 * D);
  for (const Box<D, double>& box : boxes) {
    for (const std::array<double, D>& corner : {box.min, box.max}) {
      for (const double coordinate : corner) {
        const std::uint64_t bits =
            core::bit_cast<std::uint64_t>(coordinate + 0.0);  // -0.0 and 0.0 are the same
        const auto low = static_cast<std::uint32_t>(bits + key);
        const auto high = static_cast<std::uint32_t>((bits >> 32) + (key >> 32));
        hash += std::uint64_t{low} * high;
        key += hash_key(1);
      }
    }
  }
  return hash;
}

template <int D>
std::array<QuantileRounding, D> fit_quantiles(std::span<const Box<D, double>> boxes, std::uint64_t hash) {
  const std::uint32_t shift = shift_by(hash);
  const std::size_t count = std::min(boxes.size() / boxes_per_knot + 1, max_knots / 2);
  std::array<QuantileRounding, D> fit;
  for (int axis = 0; axis < D; ++axis) {
    std::vector<double> knots;
    knots.reserve(2 * count);
    for (std::size_t i = 0; i < count && !boxes.empty(); ++i) {
      const Box<D, double>& box = boxes[sampled_place(i + shift, boxes.size())];
      if (!is_present(box)) continue;
      for (const double at : {box.min[axis], box.max[axis]}) {
        if (std::isfinite(at)) knots.push_back(at);
      }
    }
    fit[axis] = QuantileRounding(std::move(knots));
  }
  return fit;
}

template <int D>
bool makes_false_pairs(const std::array<LinearRounding, D>& fit, std::span<const Box<D, double>> boxes,
                       std::size_t left_count, std::uint64_t hash) {
  const auto size = static_cast<double>(boxes.size());
  const auto max_compared =
      std::max(min_compared, static_cast<std::size_t>(std::sqrt(compared_share * size)));
  const std::uint32_t shift = shift_by(hash);
  RoundedColumns<D> columns((left_count == 0 ? 1 : 2) * std::min(boxes.size(), max_compared));
  const auto take = [&](std::span<const Box<D, double>> from) {
    const std::size_t count = std::min(from.size(), max_compared);
    for (std::size_t i = 0; i < count; ++i) {
      const Box<D, double>& box = from[count == from.size() ? i : sampled_place(i + shift, from.size())];
      if (is_present(box)) columns.add(box, rounded(box, fit));
    }
    return count;
  };
  double compared = 0;
  double all = 0;
  std::size_t wrong = 0;
  if (left_count == 0) {
    const auto count = static_cast<double>(take(boxes));
    compared = count * (count - 1) / 2;
    all = size * (size - 1) / 2;
    for (std::size_t i = 1; i < columns.size(); ++i) wrong += columns.false_pairs(i, i);
  } else {
    const std::size_t left = take(boxes.first(left_count));
    const std::size_t left_columns = columns.size();
    const std::size_t right = take(boxes.subspan(left_count));
    compared = static_cast<double>(left) * static_cast<double>(right);
    all = static_cast<double>(left_count) * static_cast<double>(boxes.size() - left_count);
    for (std::size_t i = left_columns; i < columns.size(); ++i) wrong += columns.false_pairs(i, left_columns);
  }
  return compared > 0 && static_cast<double>(wrong) / compared * all > max_false_pairs * size;
}

template std::array<LinearRounding, 2> fit_linear<2>(std::span<const DoubleBox2>);
template std::array<LinearRounding, 3> fit_linear<3>(std::span<const DoubleBox3>);
template std::uint64_t hash_of<2>(std::span<const DoubleBox2>, std::size_t);
template std::array<QuantileRounding, 2> fit_quantiles<2>(std::span<const DoubleBox2>, std::uint64_t);
template bool makes_false_pairs<2>(const std::array<LinearRounding, 2>&, std::span<const DoubleBox2>,
                                   std::size_t, std::uint64_t);
template std::uint64_t hash_of<3>(std::span<const DoubleBox3>, std::size_t);
template std::array<QuantileRounding, 3> fit_quantiles<3>(std::span<const DoubleBox3>, std::uint64_t);
template bool makes_false_pairs<3>(const std::array<LinearRounding, 3>&, std::span<const DoubleBox3>,
                                   std::size_t, std::uint64_t);

}  // namespace broadside::core
