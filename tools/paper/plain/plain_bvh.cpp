// The algorithm of `bvh` written plainly, so that each optimisation can be left out separately.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "broadside/finder.hpp"

#include "paper/plain/plain.hpp"

namespace broadside::plain {
namespace {

constexpr std::size_t fan_out = 16;
constexpr std::size_t max_levels = 9;

/// One level of the tree as an array of boxes.
template <int D>
struct BoxLevel {
  std::vector<Box<D>> boxes;

  void resize(std::size_t size) { boxes.assign(size, absent_box<D>()); }
  void set(std::size_t i, const Box<D>& box) { boxes[i] = box; }
  float min(std::size_t i, int axis) const { return boxes[i].min[axis]; }
  float max(std::size_t i, int axis) const { return boxes[i].max[axis]; }
};

/// One level of the tree as an array for each bound.
template <int D>
struct ArrayLevel {
  std::array<std::vector<float>, D> mins;
  std::array<std::vector<float>, D> maxs;

  void resize(std::size_t size) {
    for (int axis = 0; axis < D; ++axis) {
      mins[axis].assign(size, absent_box<D>().min[axis]);
      maxs[axis].assign(size, absent_box<D>().max[axis]);
    }
  }
  void set(std::size_t i, const Box<D>& box) {
    for (int axis = 0; axis < D; ++axis) {
      mins[axis][i] = box.min[axis];
      maxs[axis][i] = box.max[axis];
    }
  }
  float min(std::size_t i, int axis) const { return mins[axis][i]; }
  float max(std::size_t i, int axis) const { return maxs[axis][i]; }
};

template <int D>
struct PackedBox {
  Box<D> box;
  BoxId id;
};

/// Sorts the boxes into slabs, rows and leaves of sixteen neighbours (sort-tile-recursive).
template <int D>
class Tiler {
 public:
  explicit Tiler(bool uses_buckets) : uses_buckets_(uses_buckets) {}

  void tile(std::span<PackedBox<D>> boxes, const Shape<D>& shape, int axis, std::size_t leaves) {
    order(boxes, shape, axis);
    if (axis == D - 1) return;
    const auto slabs =
        static_cast<std::size_t>(std::ceil(std::pow(static_cast<double>(leaves), 1.0 / (D - axis))));
    const std::size_t leaves_per_slab = (leaves + slabs - 1) / slabs;
    const std::size_t slab = leaves_per_slab * fan_out;
    for (std::size_t begin = 0; begin < boxes.size(); begin += slab)
      tile(boxes.subspan(begin, std::min(slab, boxes.size() - begin)), shape, axis + 1, leaves_per_slab);
  }

 private:
  void order(std::span<PackedBox<D>> boxes, const Shape<D>& shape, int axis) {
    const float low = shape.low[axis];
    const float length = shape.high[axis] - low;
    if (!uses_buckets_ || !(length > 0 && length <= std::numeric_limits<float>::max())) {
      std::ranges::sort(boxes, {}, [axis](const PackedBox<D>& packed) { return packed.box.min[axis]; });
      return;
    }
    // The order within a bucket does not matter: its boxes are near each other.
    const auto last = static_cast<float>(boxes.size() - 1);
    const float per_unit = static_cast<float>(boxes.size()) / length;
    const auto bucket_of = [&](const PackedBox<D>& packed) {
      return static_cast<std::size_t>(std::clamp((packed.box.min[axis] - low) * per_unit, 0.0F, last));
    };
    starts_.assign(boxes.size() + 1, 0);
    for (const PackedBox<D>& packed : boxes) ++starts_[bucket_of(packed) + 1];
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    ordered_.resize(std::max(ordered_.size(), boxes.size()));
    for (const PackedBox<D>& packed : boxes) ordered_[starts_[bucket_of(packed)]++] = packed;
    std::copy_n(ordered_.begin(), boxes.size(), boxes.begin());
  }

  bool uses_buckets_;
  std::vector<PackedBox<D>> ordered_;
  std::vector<std::size_t> starts_;
};

template <int D, typename Level>
class PlainBvh final : public Searcher<D> {
 public:
  explicit PlainBvh(const Settings& settings)
      : joins_(settings.text("join") == "yes"),
        branch_free_(settings.text("branch_free") == "yes"),
        tiler_(settings.text("buckets") == "yes") {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    const std::span<const Box<D>> boxes = input.boxes;
    tests_ = 0;
    if (!boxes.empty()) {
      pack(boxes);
      std::size_t room = 0;
      for (std::size_t level = 0; level < level_count_; ++level) room += sizes_[level] + 2 * fan_out;
      scratch_.resize(room);
      const std::uint32_t root = 0;
      if (joins_) {
        join(0, level_count_ - 1, &root, 1, scratch_.data(), pairs);
      } else {
        for (std::size_t place = 0; place < boxes.size(); ++place) query(place, level_count_ - 1, 0, pairs);
      }
    }
    return Statistics{.tests = tests_, .references = boxes.size()};
  }

 private:
  /// Level 0 holds the boxes; each further level bounds sixteen entries of the previous one. The last level
  /// has at most sixteen.
  void pack(std::span<const Box<D>> boxes) {
    packed_.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) packed_[i] = {boxes[i], static_cast<BoxId>(i)};
    const std::size_t leaves = (boxes.size() + fan_out - 1) / fan_out;
    tiler_.tile(packed_, shape_of(boxes, true), 0, leaves);
    sizes_[0] = leaves * fan_out;
    levels_[0].resize(sizes_[0]);
    ids_.assign(sizes_[0], BoxId{0});
    for (std::size_t i = 0; i < packed_.size(); ++i) {
      levels_[0].set(i, packed_[i].box);
      ids_[i] = packed_[i].id;
    }
    level_count_ = 1;
    do {
      const Level& below = levels_[level_count_ - 1];
      Level& level = levels_[level_count_];
      const std::size_t nodes = sizes_[level_count_ - 1] / fan_out;
      sizes_[level_count_] = (nodes + fan_out - 1) / fan_out * fan_out;
      level.resize(sizes_[level_count_]);
      for (std::size_t node = 0; node < nodes; ++node) {
        Box<D> bounds = absent_box<D>();
        for (std::size_t i = node * fan_out; i < (node + 1) * fan_out; ++i) {
          for (int axis = 0; axis < D; ++axis) {
            bounds.min[axis] = std::min(bounds.min[axis], below.min(i, axis));
            bounds.max[axis] = std::max(bounds.max[axis], below.max(i, axis));
          }
        }
        level.set(node, bounds);
      }
      ++level_count_;
    } while (sizes_[level_count_ - 1] > fan_out);
  }

  bool overlap(std::size_t level_a, std::size_t a, std::size_t level_b, std::size_t b) const {
    return overlap_at<D>(branch_free_, levels_[level_a], a, levels_[level_b], b);
  }

  /// Joins the subtree of `node`, whose children are on `level`, with the subtrees of the nodes of `list`:
  /// the nodes that touch it and do not come before it.
  void join(std::size_t node, std::size_t level, const std::uint32_t* list, std::size_t count,
            std::uint32_t* touched, PairSink& pairs) {
    if (level == 0) return join_leaf(node, list, count, pairs);
    for (std::size_t child = node * fan_out; child < (node + 1) * fan_out; ++child) {
      std::size_t touched_count = 0;
      for (std::size_t i = 0; i < count; ++i) {
        touched_count += write_hits(
            branch_free_, std::max(child, std::size_t{list[i]} * fan_out),
            (std::size_t{list[i]} + 1) * fan_out, touched + touched_count,
            [&](std::size_t other) { return overlap(level, child, level, other); },
            [](std::size_t other) { return static_cast<std::uint32_t>(other); });
      }
      if (touched_count > 0) join(child, level - 1, touched, touched_count, touched + touched_count, pairs);
    }
  }

  void join_leaf(std::size_t node, const std::uint32_t* list, std::size_t count, PairSink& pairs) {
    const std::size_t begin = node * fan_out;
    for (std::size_t place = begin; place < begin + fan_out; ++place)
      compare(place, place + 1, begin + fan_out, pairs);
    for (std::size_t i = 1; i < count; ++i) {  // the first one is this leaf itself
      const std::size_t leaf = list[i];
      std::array<std::uint32_t, fan_out + 1> met;
      const std::size_t met_count = write_hits(
          branch_free_, begin, begin + fan_out, met.data(),
          [&](std::size_t place) { return overlap(0, place, 1, leaf); },
          [](std::size_t place) { return static_cast<std::uint32_t>(place); });
      for (std::size_t j = 0; j < met_count; ++j)
        compare(met[j], leaf * fan_out, (leaf + 1) * fan_out, pairs);
    }
  }

  /// Searches for boxes after `place` that overlap the box at `place`, below a node whose children are on
  /// `level`.
  void query(std::size_t place, std::size_t level, std::size_t node, PairSink& pairs) {
    const std::size_t begin = node * fan_out;
    if (level == 0) return compare(place, std::max(begin, place + 1), begin + fan_out, pairs);
    std::array<std::uint32_t, fan_out + 1> met;
    const std::size_t met_count = write_hits(
        branch_free_, std::max(begin, place >> (4 * level)), begin + fan_out, met.data(),
        [&](std::size_t child) { return overlap(0, place, level, child); },
        [](std::size_t child) { return static_cast<std::uint32_t>(child); });
    for (std::size_t i = 0; i < met_count; ++i) query(place, level - 1, met[i], pairs);
  }

  /// Compares the box at `place` with those of [begin, end).
  void compare(std::size_t place, std::size_t begin, std::size_t end, PairSink& pairs) {
    if (begin >= end) return;
    tests_ += end - begin;
    const BoxId id = ids_[place];
    pairs.commit(write_hits(
        branch_free_, begin, end, pairs.room(fan_out + 1),
        [&](std::size_t other) { return overlap(0, place, 0, other); },
        [&](std::size_t other) { return ordered_pair(id, ids_[other]); }));
  }

  bool joins_;
  bool branch_free_;
  Tiler<D> tiler_;
  std::vector<PackedBox<D>> packed_;
  std::array<Level, max_levels> levels_;
  std::array<std::size_t, max_levels> sizes_{};
  std::size_t level_count_ = 0;
  std::vector<BoxId> ids_;
  std::vector<std::uint32_t> scratch_;
  std::uint64_t tests_ = 0;
};

template <int D>
std::unique_ptr<Searcher<D>> make_plain_bvh(const Settings& settings) {
  if (settings.text("arrays") == "yes") return std::make_unique<PlainBvh<D, ArrayLevel<D>>>(settings);
  return std::make_unique<PlainBvh<D, BoxLevel<D>>>(settings);
}

}  // namespace

Algorithm plain_bvh() {
  return {
      .name = "plain_bvh",
      .summary = "the algorithm of bvh, written plainly",
      .source = "for the paper's ablation",
      .kind = AlgorithmKind::literature,
      .tunables = {switch_tunable("buckets", "whether boxes are packed by counting sorts"),
                   switch_tunable("join", "whether the tree is joined with itself, or asked for each box"),
                   switch_tunable("arrays", "whether a level of the tree is an array for each bound"),
                   switch_tunable("branch_free", "whether hits are written without a branch")},
      .in_2d = {.searcher = make_plain_bvh<2>},
      .in_3d = {.searcher = make_plain_bvh<3>},
      .limits = {.infinite_boxes = false}};
}

}  // namespace broadside::plain
