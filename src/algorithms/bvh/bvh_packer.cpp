// Packs boxes into a tree of bounds: sixteen boxes to a leaf, sixteen children to a node.
//
// The builder follows S. Leutenegger et al., "STR: a simple and efficient algorithm for R-tree packing" (ICDE
// 1997): boxes are cut into slabs of equal numbers along the first axis, slabs into strips along the next
// one, strips into leaves along the last. The numbers of slabs and strips are chosen so that leaves have the
// shape of a typical box. Boxes are ordered by a counting sort, in buckets of equal width. Bounds are
// computed afterwards, so disorder within a bucket costs time, never a pair.
#include "algorithms/bvh/bvh_packer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/cell_axis.hpp"
#include "core/prefix_sum.hpp"

namespace broadside::algorithm {
namespace {

using kernels::fan_out;

/// Sizes above which a box belongs to the next class, in units of a typical box.
constexpr std::array<float, 4> class_borders = {4, 32, 256, 2048};
constexpr std::size_t classes = class_borders.size() + 1;

constexpr std::size_t max_bvh_buckets = 2048;

/// The root of `value` >= 0 of degree 1, 2 or 3, by operations that round alike everywhere: a box's leaf must
/// not depend on the machine.
double root(double value, int degree) {
  if (degree == 1 || !(value > 0)) return value;
  if (degree == 2) return std::sqrt(value);
  double guess = std::sqrt(std::sqrt(value));
  for (int step = 0; step < 64; ++step) guess -= (guess - value / guess / guess) / 3;
  return guess;
}

/// At most `max_count` buckets of equal width for the coordinates [low, high]; one bucket if low == high.
core::CellAxis buckets_of(float low, float high, std::size_t max_count) {
  const float width = high - low;
  if (!(width > 0) || max_count < 2) return {.low = low};
  return {.low = low,
          .per_unit = std::min(static_cast<float>(max_count) / width, std::numeric_limits<float>::max()),
          .last = static_cast<float>(max_count - 1)};
}

}  // namespace

template <int D>
void BvhPacker<D>::pack(std::span<const Box<D>> boxes, core::Parallel& parallel, std::size_t left_count) {
  sample_.take(boxes);
  partition(boxes, parallel, left_count);
  place_all(parallel);
  levels_.build(parallel);
}

/// Sorts the boxes into entries_: by set, by class, and within a class roughly along the first axis.
template <int D>
void BvhPacker<D>::partition(std::span<const Box<D>> boxes, core::Parallel& parallel, std::size_t left) {
  std::array<float, D> inverse;
  for (int axis = 0; axis < D; ++axis) {
    typical_[axis] = std::max(sample_[axis].extent, spacing(boxes.size(), axis) / 2);
    inverse[axis] = typical_[axis] > 0 ? 1 / typical_[axis] : std::numeric_limits<float>::max();
  }
  const auto first_buckets = std::clamp<std::size_t>(boxes.size() / 16, 16, max_bvh_buckets);
  choose_axes(boxes.size());
  const int first = axes_[0];
  const core::CellAxis buckets = buckets_of(sample_[first].low, sample_[first].high, first_buckets);
  const std::uint32_t bucket_count = buckets.count();
  const std::size_t groups = left == 0 ? classes : 2 * classes;
  const std::size_t keys = groups * bucket_count;
  counts_.assign(parallel.range_count() * keys, 0);
  core::renew(keys_, boxes.size());
  parallel.for_numbered_ranges(boxes.size(), [&](std::size_t number, core::Range range, std::size_t) {
    std::uint32_t* const counts = counts_.data() + number * keys;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Box<D>& box = boxes[i];
      float size = 0;
      for (int axis = 0; axis < D; ++axis)
        size = std::max(size, (box.max[axis] - box.min[axis]) * inverse[axis]);
      std::uint32_t group = 0;
      if (size > class_borders[0]) {
        for (const float border : class_borders) group += static_cast<std::uint32_t>(size > border);
      }
      if (left != 0 && i >= left) group += classes;
      const std::uint32_t key = group * bucket_count + buckets(box.min[first]);
      keys_[i] = static_cast<std::uint16_t>(key);
      ++counts[key];
    }
  });
  core::prefix_sum(std::span(counts_), keys);
  core::renew(entries_, boxes.size());
  parallel.for_numbered_ranges(boxes.size(), [&](std::size_t number, core::Range range, std::size_t) {
    std::uint32_t* const places = counts_.data() + number * keys;
    for (std::size_t i = range.begin; i < range.end; ++i) entries_[places[keys_[i]]++] = {boxes[i], BoxId(i)};
  });
  const std::span<const std::uint32_t> ends = std::span(counts_).last(keys);
  group_ends_.clear();
  for (std::size_t group = 1; group <= groups; ++group) group_ends_.push_back(ends[group * bucket_count - 1]);
  sort_heavy_buckets(ends, parallel);
}

/// The axis with the most cuts comes last, where the order is finest.
template <int D>
void BvhPacker<D>::choose_axes(std::size_t boxes) {
  std::iota(axes_.begin(), axes_.end(), 0);
  const std::array<double, D> parts = parts_of(whole_leaves(boxes) / fan_out, 1);
  // Not a stable sort, which would allocate.
  std::sort(axes_.begin(), axes_.end(),
            [&parts](int a, int b) { return std::pair(parts[a], a) < std::pair(parts[b], b); });
}

/// Sorts the boxes within heavy buckets: where a few buckets hold most boxes, the buckets alone leave them
/// almost unsorted.
template <int D>
void BvhPacker<D>::sort_heavy_buckets(std::span<const std::uint32_t> ends, core::Parallel& parallel) {
  const std::size_t max_unsorted = std::max<std::size_t>(1024, entries_.size() / 64);
  // Compares keys, which also order NaNs: another thread may have written a NaN since the check.
  const auto is_before = [first = axes_[0]](const Entry& a, const Entry& b) {
    const std::uint32_t first_key = core::sort_key(a.box.min[first]);
    const std::uint32_t second_key = core::sort_key(b.box.min[first]);
    return first_key != second_key ? first_key < second_key : a.id < b.id;
  };
  parallel.for_ranges(ends.size(), [&](core::Range range, std::size_t) {
    for (std::size_t bucket = range.begin; bucket < range.end; ++bucket) {
      const std::uint32_t begin = bucket == 0 ? 0 : ends[bucket - 1];
      if (ends[bucket] - begin > max_unsorted)
        std::sort(entries_.data() + begin, entries_.data() + ends[bucket], is_before);
    }
  });
}

/// The distance between neighbours on an axis if `count` boxes were spread evenly.
template <int D>
float BvhPacker<D>::spacing(std::size_t count, int axis) const {
  const float range = sample_[axis].high - sample_[axis].low;
  return std::min(range, std::numeric_limits<float>::max()) /
         static_cast<float>(root(static_cast<double>(count), D));
}

/// Puts all boxes from entries_ into the tree's leaves.
template <int D>
void BvhPacker<D>::place_all(core::Parallel& parallel) {
  std::size_t size = 0;
  std::size_t begin = 0;
  for (const std::size_t end : group_ends_) {
    size += whole_leaves(end - begin);
    begin = end;
  }
  levels_.start(size);
  scratch_.resize(std::max(scratch_.size(), parallel.workers()));
  size = 0;
  begin = 0;
  for (std::size_t group = 0; group < group_ends_.size(); ++group) {
    const std::size_t end = group_ends_[group];
    place_group(std::span<const Entry>(entries_).subspan(begin, end - begin), size, group % classes,
                parallel);
    levels_.leave(size + (end - begin), size + whole_leaves(end - begin));
    size += whole_leaves(end - begin);
    begin = end;
    if (group_ends_.size() > classes && group == classes - 1) levels_.set_left_size(size);
  }
}

/// Puts the boxes of one class into leaves, from `place` on.
template <int D>
void BvhPacker<D>::place_group(std::span<const Entry> entries, std::size_t place, std::size_t size_class,
                               core::Parallel& parallel) {
  if (entries.empty()) return;
  const std::size_t leaves = whole_leaves(entries.size()) / fan_out;
  const float size = size_class == 0 ? 1 : class_borders[size_class - 1];
  std::array<double, D> parts = parts_of(leaves, size);
  const auto share = [](std::size_t count, double part) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(static_cast<double>(count) / part)));
  };
  const std::size_t slab = share(leaves, parts[axes_[0]]) * fan_out;
  const std::size_t strip = D == 2 ? slab : share(slab / fan_out, parts[axes_[1]]) * fan_out;
  parallel.for_ranges((entries.size() + slab - 1) / slab, [&](core::Range slabs, std::size_t worker) {
    for (std::size_t at = slabs.begin * slab; at < std::min(slabs.end * slab, entries.size()); at += slab)
      place_slab(entries.subspan(at, std::min(slab, entries.size() - at)), place + at, strip,
                 scratch_[worker]);
  });
}

/// Puts the boxes of one slab into leaves, from `place` on.
template <int D>
void BvhPacker<D>::place_slab(std::span<const Entry> slab, std::size_t place, std::size_t strip,
                              Scratch& scratch) {
  const auto entry = [slab](std::size_t i) -> const Entry& { return slab[i]; };
  if constexpr (D == 2) {
    order(slab.size(), axes_[1], scratch, entry,
          [&](std::size_t i, std::size_t to) { levels_.put(place + to, slab[i].box, slab[i].id); });
  } else {
    scratch.order.resize(std::max(scratch.order.size(), slab.size()));
    order(slab.size(), axes_[1], scratch, entry,
          [&](std::size_t i, std::size_t to) { scratch.order[to] = static_cast<std::uint32_t>(i); });
    for (std::size_t from = 0; from < slab.size(); from += strip) {
      const auto in_strip = [&](std::size_t i) -> const Entry& { return slab[scratch.order[from + i]]; };
      order(std::min(strip, slab.size() - from), axes_[2], scratch, in_strip,
            [&](std::size_t i, std::size_t to) {
              levels_.put(place + from + to, in_strip(i).box, in_strip(i).id);
            });
    }
  }
}

/// The number of parts into which each axis is cut, so that leaves have the shape of a box `size` times the
/// typical one.
template <int D>
std::array<double, D> BvhPacker<D>::parts_of(std::size_t leaves, float size) const {
  std::array<double, D> ratios;
  for (int axis = 0; axis < D; ++axis) {
    const double range = static_cast<double>(sample_[axis].high) - sample_[axis].low;
    ratios[axis] =
        typical_[axis] > 0 ? std::max(1.0, range / (static_cast<double>(typical_[axis]) * size)) : 1;
  }
  std::array<double, D> parts;
  parts.fill(1);
  // An axis on which most boxes overlap is not cut: that would separate nothing. An axis too short for a
  // single cut leaves its share to the others.
  std::array<bool, D> cut;
  for (int axis = 0; axis < D; ++axis) cut[axis] = ratios[axis] > 2;
  for (int round = 0; round < D; ++round) {
    double product = static_cast<double>(leaves);
    int cuts = 0;
    for (int axis = 0; axis < D; ++axis) {
      if (!cut[axis]) continue;
      product /= ratios[axis];
      ++cuts;
    }
    if (cuts == 0) break;
    const double factor = root(product, cuts);
    bool all = true;
    for (int axis = 0; axis < D; ++axis) {
      if (!cut[axis]) continue;
      parts[axis] = std::max(1.0, ratios[axis] * factor);
      if (ratios[axis] * factor < 1) all = cut[axis] = false;
    }
    if (all) break;
  }
  return parts;
}

/// Calls `put(i, place)` for each i below `count`, with the place of `entry(i)` in the order along an axis.
template <int D>
template <typename EntryOf, typename Put>
void BvhPacker<D>::order(std::size_t count, int axis, Scratch& scratch, EntryOf entry, Put put) const {
  float low = std::numeric_limits<float>::infinity();
  float high = -low;
  for (std::size_t i = 0; i < count; ++i) {
    low = std::min(low, entry(i).box.min[axis]);
    high = std::max(high, entry(i).box.min[axis]);
  }
  const core::CellAxis buckets =
      buckets_of(std::max(low, sample_[axis].low), std::min(high, sample_[axis].high),
                 std::min(count / 2, max_bvh_buckets));
  const std::uint32_t bucket_count = buckets.count();
  std::array<std::uint32_t, max_bvh_buckets> places;
  std::fill_n(places.begin(), bucket_count, 0);
  scratch.buckets.resize(std::max(scratch.buckets.size(), count));
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t bucket = buckets(entry(i).box.min[axis]);
    scratch.buckets[i] = static_cast<std::uint16_t>(bucket);
    ++places[bucket];
  }
  std::uint32_t begin = 0;
  std::uint32_t heaviest = 0;
  for (std::uint32_t bucket = 0; bucket < bucket_count; ++bucket) {
    heaviest = std::max(heaviest, places[bucket]);
    begin += std::exchange(places[bucket], begin);
  }
  if (heaviest > 2 * fan_out && low < high) {
    const std::span<core::KeyedPlace> keyed = scratch.radix.places(count);
    for (std::uint32_t i = 0; i < count; ++i) keyed[i] = {core::sort_key(entry(i).box.min[axis]), i};
    std::size_t to = 0;
    for (const core::KeyedPlace& place : scratch.radix.sort()) put(place.place, to++);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) put(i, places[scratch.buckets[i]]++);
}

template class BvhPacker<2>;
template class BvhPacker<3>;

}  // namespace broadside::algorithm
