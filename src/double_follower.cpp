// Boxes of doubles, followed by their floats.
#include "double_follower.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/candidate_sink.hpp"
#include "core/sample.hpp"

namespace broadside::own {
namespace {

constexpr std::size_t most_sampled = 256;

/// The finite coordinates of a sample of the boxes that are there.
template <int D>
struct Coordinates {
  explicit Coordinates(std::span<const Box<D, double>> boxes) {
    const std::size_t tries = std::min(boxes.size(), 4 * most_sampled);
    std::size_t taken = 0;
    for (std::size_t i = 0; i < tries && taken < most_sampled; ++i) {
      const Box<D, double>& box = boxes[tries == boxes.size() ? i : core::sampled_place(i, boxes.size())];
      if (!is_present(box)) continue;
      ++taken;
      for (int axis = 0; axis < D; ++axis) {
        if (std::isfinite(box.min[axis])) minima[axis].push_back(box.min[axis]);
        const double extent = box.max[axis] - box.min[axis];
        if (std::isfinite(extent)) extents[axis].push_back(extent);
      }
    }
    for (int axis = 0; axis < D; ++axis) {
      std::sort(minima[axis].begin(), minima[axis].end());
      std::sort(extents[axis].begin(), extents[axis].end());
    }
  }

  static double median(const std::vector<double>& sorted) {
    return sorted.empty() ? 0 : sorted[sorted.size() / 2];
  }

  std::array<std::vector<double>, D> minima;
  std::array<std::vector<double>, D> extents;
};

}  // namespace

template <int D>
bool floats_suffice(std::span<const Box<D, double>> boxes) {
  const Coordinates<D> sample(boxes);
  for (int axis = 0; axis < D; ++axis) {
    const std::vector<double>& minima = sample.minima[axis];
    if (minima.empty()) continue;
    // Nine tenths of the boxes lie nearer to the origin than this.
    const double origin = sample.median(minima);
    const std::size_t tenth = minima.size() / 20;
    const double reach = std::max(origin - minima[tenth], minima[minima.size() - 1 - tenth] - origin);
    const double step = reach * std::numeric_limits<float>::epsilon();
    // A float's step may be a part of a box, or of what lies between two.
    const double spread = reach / std::max(1.0, static_cast<double>(boxes.size()));
    constexpr double steps_a_box = 16;
    if (step * steps_a_box > std::max(sample.median(sample.extents[axis]), spread)) return false;
  }
  return true;
}

template <int D>
void DoubleFollower<D>::update_valid(const Change<D, double>& change, PairSink& begun, PairSink& ended) {
  if (change.rebuild || !grid_) start(change);
  before_.resize(change.now.size(), absent_box<D>());
  now_.resize(change.now.size(), absent_box<D>());
  for (const BoxId id : change.changed) now_[index(id)] = rounded(change.now[index(id)]);
  core::CandidateSink<D, double> candidates(change, begun, ended);
  Statistics statistics = grid_->candidates({.before = before_,
                                             .now = now_,
                                             .changed = change.changed,
                                             .flags = change.flags,
                                             .rebuild = change.rebuild},
                                            candidates);
  candidates.flush();
  statistics.hits = candidates.count();
  for (const BoxId id : change.changed) before_[index(id)] = now_[index(id)];
  this->count(statistics);
}

/// Rounds all boxes of the frame before, about an origin amid those of this one.
template <int D>
void DoubleFollower<D>::start(const Change<D, double>& change) {
  const Coordinates<D> sample(change.now);
  for (int axis = 0; axis < D; ++axis) origin_[axis] = sample.median(sample.minima[axis]);
  grid_ = std::make_unique<HierarchicalGridTracker<D>>();
  before_.resize(change.before.size());
  for (std::size_t i = 0; i < before_.size(); ++i) before_[i] = rounded(change.before[i]);
  now_ = before_;
}

template <int D>
Box<D> DoubleFollower<D>::rounded(const Box<D, double>& box) const {
  Box<D> floats;
  for (int axis = 0; axis < D; ++axis) {
    floats.min[axis] = static_cast<float>(box.min[axis] - origin_[axis]);
    floats.max[axis] = static_cast<float>(box.max[axis] - origin_[axis]);
  }
  return floats;
}

template <int D>
std::size_t DoubleFollower<D>::algorithm_bytes() const noexcept {
  return (before_.capacity() + now_.capacity()) * sizeof(Box<D>) + (grid_ ? grid_->kept_bytes() : 0);
}

template class DoubleFollower<2>;
template class DoubleFollower<3>;
template bool floats_suffice<2>(std::span<const Box<2, double>>);
template bool floats_suffice<3>(std::span<const Box<3, double>>);

}  // namespace broadside::own
