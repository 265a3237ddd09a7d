// Boxes kept in the order of a sweep from frame to frame.
#include "algorithms/sweep_and_prune/sweep_order.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace broadside::algorithm {
namespace {

/// The greatest of some numbers, ignoring NaN. Several independent chains hide the latency of each step.
float greatest(const float* numbers, std::size_t count) {
  constexpr std::size_t chains = 8;
  std::array<float, chains> maxima;
  maxima.fill(-std::numeric_limits<float>::infinity());
  std::size_t i = 0;
  for (; i + chains <= count; i += chains) {
    for (std::size_t chain = 0; chain < chains; ++chain)
      maxima[chain] = maxima[chain] < numbers[i + chain] ? numbers[i + chain] : maxima[chain];
  }
  for (; i < count; ++i) maxima[0] = maxima[0] < numbers[i] ? numbers[i] : maxima[0];
  return *std::max_element(maxima.begin(), maxima.end());
}

/// Moves the element at `from` to `to`, and shifts the elements between by one.
template <typename T>
void move_element(std::vector<T>& elements, std::size_t from, std::size_t to) {
  T* const all = elements.data();
  const T moved = all[from];
  if (from < to)
    std::memmove(all + from, all + from + 1, (to - from) * sizeof(T));
  else
    std::memmove(all + to + 1, all + to, (from - to) * sizeof(T));
  all[to] = moved;
}

/// The first place in [0, size) for which `is_behind` is false, or `size`; it must be true for all places
/// before. Gallops from `near` in growing steps, up or down, then bisects.
template <typename IsBehind>
std::size_t gallop(std::size_t size, std::size_t near, IsBehind is_behind) {
  std::size_t low = 0;
  std::size_t high = size;
  near = std::min(near, size);
  if (near < size && is_behind(near)) {
    low = near + 1;
    for (std::size_t step = 8; low + step < size; step *= 4) {
      if (!is_behind(low + step)) {
        high = low + step;
        break;
      }
      low += step + 1;
    }
  } else {
    high = near;
    for (std::size_t step = 8; step < high; step *= 4) {
      if (is_behind(high - step)) {
        low = high - step + 1;
        break;
      }
      high -= step;
    }
  }
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (is_behind(middle))
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

}  // namespace

template <int D>
std::size_t SweepOrder<D>::find(const SweepKey& wanted, std::size_t near) const {
  return gallop(size_, near, [&](std::size_t place) { return key(place) < wanted; });
}

template <int D>
std::size_t SweepOrder<D>::find(const SweepKey& wanted) const {
  std::size_t low = 0;
  for (std::size_t count = size_; count > 0;) {
    const std::size_t half = count / 2;
    const bool is_behind = key(low + half) < wanted;
    low = is_behind ? low + half + 1 : low;
    count = is_behind ? count - half - 1 : half;
  }
  return low;
}

template <int D>
std::size_t SweepOrder<D>::find_end(float max, std::size_t near) const {
  return gallop(size_, near, [&](std::size_t place) { return kept_.min[0][place] <= max; });
}

template <int D>
void SweepOrder<D>::take_other() {
  std::swap(kept_, other_);
  run_ = kept_.view();
  size_ = run_.size;
  reach_.resize((size_ + fan - 1) / fan);
  high_reach_.resize(size_ / fan / fan + 1);
  if (size_ > 0)
    set_reach(0, (size_ - 1) / fan);
  else
    high_reach_[0] = -std::numeric_limits<float>::infinity();
}

template <int D>
void SweepOrder<D>::set_reach(std::size_t first_block, std::size_t last_block) {
  for (std::size_t block = first_block; block <= last_block; ++block)
    reach_[block] = greatest(kept_.max[0].data() + block * fan, std::min(fan, size_ - block * fan));
  for (std::size_t high = first_block / fan; high <= last_block / fan; ++high)
    high_reach_[high] = greatest(reach_.data() + high * fan, std::min(fan, reach_.size() - high * fan));
}

template <int D>
std::size_t SweepOrder<D>::move(std::size_t from, const Box<D>& box) {
  const SweepKey to_key{box.min[0], kept_.id[from]};
  std::size_t to = find(to_key, from);
  // If the box moves up, find() counted the box itself.
  if (to > from) --to;
  if (to != from) {
    for (int axis = 0; axis < D; ++axis) {
      move_element(kept_.min[axis], from, to);
      move_element(kept_.max[axis], from, to);
    }
    move_element(kept_.id, from, to);
  }
  kept_.set(to, box);
  set_reach(std::min(from, to) / fan, std::max(from, to) / fan);
  return std::max(from, to) - std::min(from, to);
}

template <int D>
std::uint64_t SweepOrder<D>::find_changes(const core::MovedBox<D>& moved, std::size_t near,
                                          const core::ChangeSinks& sinks) const {
  const Box<D>& before = moved.before;
  const Box<D>& now = moved.now;
  if (!moved.was_present) return find_changes(moved, now.min[0], now.max[0], near, sinks);
  if (!moved.is_present) return find_changes(moved, before.min[0], before.max[0], near, sinks);
  const float min = std::min(before.min[0], now.min[0]);
  const float max = std::max(before.max[0], now.max[0]);
  if (max - min <= 2 * ((before.max[0] - before.min[0]) + (now.max[0] - now.min[0])))
    return find_changes(moved, min, max, near, sinks);
  return find_changes(moved, before.min[0], before.max[0], near, sinks) +
         find_changes(moved, now.min[0], now.max[0], near, sinks);
}

template <int D>
std::uint64_t SweepOrder<D>::find_changes(const core::MovedBox<D>& moved, float min, float max,
                                          std::size_t near, const core::ChangeSinks& sinks) const {
  const std::size_t begin = find({min, BoxId(0)}, near);
  const std::size_t end = std::max(begin, find_end(max, begin));
  std::uint64_t tests = end - begin;
  const std::size_t begin_block = begin / fan;
  for (std::size_t high = 0; high * fan <= begin_block; ++high) {
    if (!(high_reach_[high] >= min)) continue;
    for (std::size_t block = high * fan; block <= std::min(begin_block, high * fan + fan - 1); ++block) {
      if (block >= reach_.size() || !(reach_[block] >= min)) continue;
      const std::size_t block_end = std::min(block * fan + fan, begin);
      tests += block_end - block * fan;
      kernels::find_changes(run_, block * fan, block_end, moved, sinks);
    }
  }
  kernels::find_changes(run_, begin, end, moved, sinks);
  return tests;
}

template class SweepOrder<2>;
template class SweepOrder<3>;

}  // namespace broadside::algorithm
