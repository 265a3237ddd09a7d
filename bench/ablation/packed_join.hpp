// The algorithm of `bvh` written plainly, so that each thing that makes it fast can be left out alone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "broadside/broadside.hpp"

#include "core/sample.hpp"
#include "kernels/bvh_join.hpp"

namespace broadside::bench {

/// What a search by the packed tree does, one by one. The standard values are those of `bvh`.
struct JoinDesign {
  bool buckets = true;      ///< boxes are packed by counting sorts over a sample's range; else by std::sort
  bool joins = true;        ///< the tree is joined with itself; else each box is looked for from the root
  bool arrays = true;       ///< an array for each bound; else one of boxes
  bool branch_free = true;  ///< hits are written without a branch
  bool simd = true;  ///< by the library's kernel, which joins, takes arrays and writes without a branch
};

/// Finds the pairs of boxes, none of them absent or infinite. Keeps its memory.
template <int D>
class PlainPackedJoin {
 public:
  explicit PlainPackedJoin(const JoinDesign& design) : design_(design) {}

  void find(std::span<const Box<D>> boxes, PairSink& pairs) {
    if (boxes.empty()) return;
    pack(boxes);
    if (design_.simd) {
      scratch_.resize(kernels::join_scratch(tree_));
      kernels::join(tree_, {0, tree_.levels[1].size}, {}, scratch_.data(), pairs);
    } else if (design_.arrays) {
      search(ArrayBounds{tree_}, pairs);
    } else {
      search(BoxBounds{boxes_.data()}, pairs);
    }
    pairs.flush();
  }

 private:
  static constexpr std::size_t fan_out = kernels::fan_out;

  struct Entry {
    Box<D> box;
    BoxId id;
  };

  /// The bounds on a level as arrays.
  struct ArrayBounds {
    const kernels::PackedBvh<D>& tree;

    float min(std::size_t level, std::size_t place, int axis) const {
      return tree.levels[level].min[axis][place];
    }
    float max(std::size_t level, std::size_t place, int axis) const {
      return tree.levels[level].max[axis][place];
    }
  };

  /// The bounds on a level as boxes.
  struct BoxBounds {
    const std::vector<Box<D>>* levels;

    float min(std::size_t level, std::size_t place, int axis) const { return levels[level][place].min[axis]; }
    float max(std::size_t level, std::size_t place, int axis) const { return levels[level][place].max[axis]; }
  };

  /// Sorts the boxes into slabs, rows and leaves of sixteen that lie together (sort-tile-recursive), and
  /// computes bounds level by level.
  void pack(std::span<const Box<D>> boxes) {
    entries_.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) entries_[i] = {boxes[i], static_cast<BoxId>(i)};
    sample_.take(boxes);
    const std::size_t leaves = (boxes.size() + fan_out - 1) / fan_out;
    tile(entries_, 0, leaves);
    set_levels(leaves);
  }

  /// Orders the entries along an axis, then each slab of them along the next.
  void tile(std::span<Entry> entries, int axis, std::size_t leaves) {
    order(entries, axis);
    if (axis == D - 1) return;
    const auto slabs = static_cast<std::size_t>(std::ceil(std::pow(leaves, 1.0 / (D - axis))));
    const std::size_t leaves_a_slab = (leaves + slabs - 1) / slabs;
    for (std::size_t begin = 0; begin < entries.size(); begin += leaves_a_slab * fan_out)
      tile(entries.subspan(begin, std::min(leaves_a_slab * fan_out, entries.size() - begin)), axis + 1,
           leaves_a_slab);
  }

  void order(std::span<Entry> entries, int axis) {
    if (!design_.buckets) {
      std::sort(entries.begin(), entries.end(),
                [axis](const Entry& a, const Entry& b) { return a.box.min[axis] < b.box.min[axis]; });
      return;
    }
    // Of boxes in one bucket the order does not matter: they are near each other.
    const auto count = static_cast<float>(entries.size());
    const float low = sample_[axis].low;
    const float per_unit = count / std::max(sample_[axis].high - low, std::numeric_limits<float>::min());
    const auto bucket_of = [&](const Entry& entry) {
      return static_cast<std::size_t>(std::clamp((entry.box.min[axis] - low) * per_unit, 0.0F, count - 1));
    };
    starts_.assign(entries.size() + 1, 0);
    for (const Entry& entry : entries) ++starts_[bucket_of(entry) + 1];
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    ordered_.resize(std::max(ordered_.size(), entries.size()));
    for (const Entry& entry : entries) ordered_[starts_[bucket_of(entry)]++] = entry;
    std::copy_n(ordered_.begin(), entries.size(), entries.begin());
  }

  void set_levels(std::size_t leaves) {
    std::size_t size = leaves * fan_out;
    tree_.level_count = 0;
    ids_.assign(size, BoxId{0});
    for (;;) {
      const std::size_t level = tree_.level_count++;
      const std::size_t room = (size + fan_out - 1) / fan_out * fan_out;
      for (int axis = 0; axis < D; ++axis) {
        mins_[level][axis].assign(room, std::numeric_limits<float>::infinity());  // absent
        maxs_[level][axis].assign(room, -std::numeric_limits<float>::infinity());
        tree_.levels[level].min[axis] = mins_[level][axis].data();
        tree_.levels[level].max[axis] = maxs_[level][axis].data();
      }
      tree_.levels[level].size = size;
      if (level > 0)
        kernels::set_bounds(tree_, level, {0, size});
      else
        put_boxes();
      if (size <= fan_out && level > 0) break;
      size = room / fan_out;
    }
    tree_.id = ids_.data();
    tree_.left_size = 0;
    // Absent boxes become NaN, which overlaps nothing.
    for (std::size_t level = 0; level < tree_.level_count; ++level) {
      for (int axis = 0; axis < D; ++axis) {
        for (std::size_t i = level == 0 ? entries_.size() : tree_.levels[level].size;
             i < mins_[level][axis].size(); ++i)
          mins_[level][axis][i] = maxs_[level][axis][i] = std::numeric_limits<float>::quiet_NaN();
      }
    }
    if (design_.arrays) return;
    for (std::size_t level = 0; level < tree_.level_count; ++level) {
      boxes_[level].resize(mins_[level][0].size());
      for (std::size_t i = 0; i < boxes_[level].size(); ++i) {
        for (int axis = 0; axis < D; ++axis) {
          boxes_[level][i].min[axis] = mins_[level][axis][i];
          boxes_[level][i].max[axis] = maxs_[level][axis][i];
        }
      }
    }
  }

  void put_boxes() {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      for (int axis = 0; axis < D; ++axis) {
        mins_[0][axis][i] = entries_[i].box.min[axis];
        maxs_[0][axis][i] = entries_[i].box.max[axis];
      }
      ids_[i] = entries_[i].id;
    }
  }

  template <typename Bounds>
  bool overlap(const Bounds& bounds, std::size_t level_a, std::size_t a, std::size_t level_b,
               std::size_t b) const {
    bool hit = true;
    for (int axis = 0; axis < D; ++axis) {
      if (!design_.branch_free && !hit) return false;
      hit &= bounds.min(level_a, a, axis) <= bounds.max(level_b, b, axis);
      hit &= bounds.min(level_b, b, axis) <= bounds.max(level_a, a, axis);
    }
    return hit;
  }

  /// Writes the numbers from `begin` to `end` that are hits; returns how many.
  template <typename Number, typename IsHit, typename Make>
  std::size_t write(std::size_t begin, std::size_t end, Number* to, const IsHit& is_hit,
                    const Make& make) const {
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (design_.branch_free) {
        to[count] = make(i);
        count += is_hit(i) ? 1 : 0;
      } else if (is_hit(i)) {
        to[count++] = make(i);
      }
    }
    return count;
  }

  template <typename Bounds>
  void search(const Bounds& bounds, PairSink& pairs) {
    const std::size_t root_level = tree_.level_count - 1;
    scratch_.resize(kernels::join_scratch(tree_) + 2 * fan_out);
    if (design_.joins) {
      const std::uint32_t root = 0;
      children_of(bounds, 0, root_level, &root, 1, scratch_.data(), pairs);
      return;
    }
    for (std::size_t place = 0; place < entries_.size(); ++place)
      look_for(bounds, place, root_level, 0, pairs);
  }

  /// As kernels::join() does.
  template <typename Bounds>
  void children_of(const Bounds& bounds, std::size_t node, std::size_t level, const std::uint32_t* list,
                   std::size_t count, std::uint32_t* touched, PairSink& pairs) {
    if (level == 0) return leaf(bounds, node, list, count, pairs);
    const std::size_t end_child = std::min((node + 1) * fan_out, tree_.levels[level].size);
    for (std::size_t child = node * fan_out; child < end_child; ++child) {
      std::size_t touched_count = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t begin = std::max<std::size_t>(child, list[i] * fan_out);
        touched_count += write(
            begin, (list[i] + 1) * fan_out, touched + touched_count,
            [&](std::size_t other) { return overlap(bounds, level, child, level, other); },
            [](std::size_t other) { return static_cast<std::uint32_t>(other); });
      }
      children_of(bounds, child, level - 1, touched, touched_count, touched + touched_count, pairs);
    }
  }

  template <typename Bounds>
  void leaf(const Bounds& bounds, std::size_t node, const std::uint32_t* list, std::size_t count,
            PairSink& pairs) {
    const std::size_t begin = node * fan_out;
    for (std::size_t place = begin; place < begin + fan_out; ++place)
      report(bounds, place, place + 1, begin + fan_out, pairs);
    for (std::size_t i = 1; i < count; ++i) {
      std::array<std::uint32_t, fan_out + 1> met;
      const std::size_t size = write(
          begin, begin + fan_out, met.data(),
          [&](std::size_t place) { return overlap(bounds, 0, place, 1, list[i]); },
          [](std::size_t place) { return static_cast<std::uint32_t>(place); });
      for (std::size_t j = 0; j < size; ++j)
        report(bounds, met[j], list[i] * fan_out, (list[i] + 1) * fan_out, pairs);
    }
  }

  /// Looks for the boxes behind `place` that the box there overlaps, below a node whose children stand on
  /// `level`.
  template <typename Bounds>
  void look_for(const Bounds& bounds, std::size_t place, std::size_t level, std::size_t node,
                PairSink& pairs) {
    const std::size_t begin = node * fan_out;
    if (level == 0) return report(bounds, place, std::max(begin, place + 1), begin + fan_out, pairs);
    std::array<std::uint32_t, fan_out + 1> met;
    const std::size_t first = std::max(begin, place >> (4 * level));
    const std::size_t size = write(
        first, std::min(begin + fan_out, tree_.levels[level].size), met.data(),
        [&](std::size_t child) { return overlap(bounds, 0, place, level, child); },
        [](std::size_t child) { return static_cast<std::uint32_t>(child); });
    for (std::size_t i = 0; i < size; ++i) look_for(bounds, place, level - 1, met[i], pairs);
  }

  template <typename Bounds>
  void report(const Bounds& bounds, std::size_t place, std::size_t begin, std::size_t end, PairSink& pairs) {
    const BoxId id = ids_[place];
    pairs.commit(write(
        begin, end, pairs.room(fan_out + 1),
        [&](std::size_t other) { return overlap(bounds, 0, place, 0, other); },
        [&](std::size_t other) {
          return Pair{std::min(id, ids_[other]), std::max(id, ids_[other])};
        }));
  }

  JoinDesign design_;
  core::Sample<D> sample_;
  std::vector<Entry> entries_;
  std::vector<Entry> ordered_;
  std::vector<std::size_t> starts_;
  std::array<std::array<std::vector<float>, D>, kernels::most_levels> mins_;
  std::array<std::array<std::vector<float>, D>, kernels::most_levels> maxs_;
  std::array<std::vector<Box<D>>, kernels::most_levels> boxes_;
  std::vector<BoxId> ids_;
  std::vector<std::uint32_t> scratch_;
  kernels::PackedBvh<D> tree_{};
};

}  // namespace broadside::bench
