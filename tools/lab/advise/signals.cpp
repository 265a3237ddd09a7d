// Computes the statistics of boxes that decide which algorithm suits them.
#include "lab/advise/signals.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <unordered_map>

namespace broadside::lab {
namespace {

/// Parts of the world along each axis; boxes are near if their centres are in the same part.
constexpr std::size_t parts = 16;

template <int D, typename Real>
bool is_infinite(const Box<D, Real>& box) {
  return std::ranges::any_of(box.min, [](Real number) { return std::isinf(number); }) ||
         std::ranges::any_of(box.max, [](Real number) { return std::isinf(number); });
}

template <int D, typename Real>
double longest_side(const Box<D, Real>& box) {
  double longest = 0;
  for (std::size_t axis = 0; axis < D; ++axis)
    longest = std::max(longest, static_cast<double>(box.max[axis]) - static_cast<double>(box.min[axis]));
  return longest;
}

template <int D, typename Real>
double centre(const Box<D, Real>& box, std::size_t axis) {
  return static_cast<double>(box.min[axis]) / 2 + static_cast<double>(box.max[axis]) / 2;
}

template <int D, typename Real>
std::size_t present_count(std::span<const Box<D, Real>> boxes) {
  return static_cast<std::size_t>(
      std::ranges::count_if(boxes, [](const Box<D, Real>& box) { return !is_absent(box); }));
}

/// The smallest value that at least `fraction` of the sorted values do not exceed.
double at(const std::vector<double>& sorted, double fraction) {
  const double rank = std::ceil(fraction * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

double pairs_of(double count) { return count * (count - 1) / 2; }

/// The number of pairs of intervals that overlap.
double overlapping(std::vector<double>& minima, std::vector<double>& maxima) {
  std::ranges::sort(minima);
  std::ranges::sort(maxima);
  double apart = 0;
  std::size_t ended = 0;
  for (const double min : minima) {
    while (ended < maxima.size() && maxima[ended] < min) ++ended;
    apart += static_cast<double>(ended);
  }
  return pairs_of(static_cast<double>(minima.size())) - apart;
}

/// For each centre, its part of the world along one axis. A few centres at either end, which may be far away,
/// do not enlarge the parts.
std::vector<std::size_t> parts_along(const std::vector<double>& centres) {
  std::vector<double> sorted = centres;
  std::ranges::sort(sorted);
  const double low = at(sorted, 0.01);
  const double range = at(sorted, 0.99) - low;
  std::vector<std::size_t> result;
  for (const double value : centres) {
    const double place = range > 0 ? (value - low) / range * static_cast<double>(parts) : 0;
    result.push_back(static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(parts - 1))));
  }
  return result;
}

/// The number of pairs of centres with equal keys.
double pairs_of_equal(const std::vector<std::size_t>& keys) {
  std::unordered_map<std::size_t, double> counts;
  for (const std::size_t key : keys) ++counts[key];
  double pairs = 0;
  for (const auto& [key, count] : counts) pairs += pairs_of(count);
  return pairs;
}

double clustering(const std::vector<std::vector<double>>& centres) {
  const auto count = static_cast<double>(centres[0].size());
  const double pairs = pairs_of(count);
  if (pairs == 0) return 1;
  double expected = pairs;
  std::vector<std::size_t> cells(centres[0].size(), 0);
  for (const std::vector<double>& along : centres) {
    const std::vector<std::size_t> here = parts_along(along);
    expected *= pairs_of_equal(here) / pairs;
    for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = cells[i] * parts + here[i];
  }
  // Less than one expected pair means nothing.
  return expected < 1 ? 1 : pairs_of_equal(cells) / expected;
}

template <int D, typename Real>
void look_at(std::span<const Box<D, Real>> boxes, Signals& signals) {
  std::vector<double> sizes;
  std::vector<std::vector<double>> centres(D);
  std::vector<std::vector<double>> minima(D);
  std::vector<std::vector<double>> maxima(D);
  for (const Box<D, Real>& box : boxes) {
    if (is_absent(box)) continue;
    int without = 0;
    for (std::size_t axis = 0; axis < D; ++axis) {
      without += static_cast<int>(box.min[axis] == box.max[axis]);
      minima[axis].push_back(static_cast<double>(box.min[axis]));
      maxima[axis].push_back(static_cast<double>(box.max[axis]));
      for (const Real number : {box.min[axis], box.max[axis]})
        signals.floats_hold_all &= static_cast<Real>(static_cast<float>(number)) == number;
    }
    signals.points += static_cast<std::size_t>(without == D);
    signals.flat += static_cast<std::size_t>(without > 0 && without < D);
    if (is_infinite(box)) {
      ++signals.infinite;
      continue;
    }
    sizes.push_back(longest_side(box));
    for (std::size_t axis = 0; axis < D; ++axis) centres[axis].push_back(centre(box, axis));
  }
  signals.boxes = minima[0].size();
  signals.absent = boxes.size() - signals.boxes;
  for (std::size_t axis = 0; axis < D; ++axis)
    signals.axis_tests.push_back(overlapping(minima[axis], maxima[axis]) /
                                 static_cast<double>(std::max<std::size_t>(signals.boxes, 1)));
  if (sizes.empty()) return;
  std::ranges::sort(sizes);
  for (std::size_t i = 0; i < size_percentiles.size(); ++i) signals.sizes[i] = at(sizes, size_percentiles[i]);
  signals.largest = sizes.back();
  signals.clustering = clustering(centres);
}

/// Collects statistics from frame to frame.
template <int D, typename Real>
class MotionCollector {
 public:
  void take(const Step<D, Real>& step, const std::vector<Box<D, Real>>& before) {
    std::size_t there = present_count<D, Real>(before);
    std::size_t moved = 0;
    // When an array shrinks, the boxes at its end are removed.
    for (std::size_t i = step.size; i < before.size(); ++i)
      removed_ += static_cast<std::size_t>(!is_absent(before[i]));
    for (std::size_t i = 0; i < step.changed.size(); ++i) {
      const std::size_t place = index(step.changed[i]);
      const Box<D, Real>& now = step.boxes[i];
      const bool was_there = place < before.size() && !is_absent(before[place]);
      if (was_there && is_absent(now)) ++removed_;
      if (!was_there && !is_absent(now)) ++added_;
      if (!was_there || is_absent(now) || now == before[place]) continue;
      ++moved;
      note_distance(before[place], now);
    }
    there = std::max<std::size_t>(there, 1);
    fractions_.push_back(static_cast<double>(moved) / static_cast<double>(there));
  }

  MotionSignals finish() {
    MotionSignals motion{.frames = fractions_.size()};
    const auto frames = static_cast<double>(fractions_.size());
    motion.min_moving = std::ranges::min(fractions_);
    motion.max_moving = std::ranges::max(fractions_);
    for (const double fraction : fractions_) motion.moving += fraction / frames;
    motion.added = static_cast<double>(added_) / frames;
    motion.removed = static_cast<double>(removed_) / frames;
    if (distances_.empty()) return motion;
    std::ranges::sort(distances_);
    motion.drift = at(distances_, 0.5);
    const auto jumps = std::ranges::count_if(distances_, [](double far) { return far > sides_of_a_jump; });
    motion.jumps = static_cast<double>(jumps) / static_cast<double>(distances_.size());
    return motion;
  }

 private:
  void note_distance(const Box<D, Real>& before, const Box<D, Real>& now) {
    const double side = longest_side(before);
    if (is_infinite(before) || is_infinite(now) || !(side > 0)) return;
    double sum = 0;
    for (std::size_t axis = 0; axis < D; ++axis) {
      const double along = (centre(now, axis) - centre(before, axis)) / side;
      sum += along * along;
    }
    distances_.push_back(std::sqrt(sum));
  }

  std::vector<double> fractions_;
  std::vector<double> distances_;
  std::size_t added_ = 0;
  std::size_t removed_ = 0;
};

}  // namespace

std::size_t Signals::best_axis() const {
  return static_cast<std::size_t>(std::ranges::min_element(axis_tests) - axis_tests.begin());
}

char axis_name(std::size_t axis) noexcept { return static_cast<char>('x' + static_cast<int>(axis)); }

template <int D, typename Real>
Signals signals_of(const History<D, Real>& history) {
  Signals signals{.dimension = D, .precision = precision_of<Real>};
  std::vector<Box<D, Real>> boxes = history.boxes;
  std::vector<Box<D, Real>> fullest = boxes;
  std::size_t max_present = present_count<D, Real>(boxes);
  MotionCollector<D, Real> motion;
  for (const Step<D, Real>& step : history.steps) {
    motion.take(step, boxes);
    apply(step, boxes);
    const std::size_t there = present_count<D, Real>(boxes);
    if (there <= max_present) continue;
    max_present = there;
    fullest = boxes;
  }
  look_at<D, Real>(fullest, signals);
  if (!history.steps.empty()) signals.motion = motion.finish();
  return signals;
}

template Signals signals_of(const History<2, float>&);
template Signals signals_of(const History<3, float>&);
template Signals signals_of(const History<2, double>&);
template Signals signals_of(const History<3, double>&);

}  // namespace broadside::lab
