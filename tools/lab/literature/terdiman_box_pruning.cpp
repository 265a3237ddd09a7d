// Terdiman 2017 to 2018, "Box pruning revisited", parts 1 to 17 (codercorner.com; code: BoxPruning17): boxes
// are sorted along one axis, copied in that order, and swept with the sweep axis stored apart from the
// others, as integers and with sentinels (sorted_boxes.hpp). Before the sweep, boxes are distributed to
// buckets by the middles of the other axes (parts 16 and 17): four quadrants, and one bucket of the boxes
// that cross a middle. A quadrant is swept against itself and against the crossing boxes. With two sets, each
// has its own buckets, and two buckets are swept if their bounds overlap.
//
// Differences: the sweep within a bucket is that of part 15, eight boxes at once, where part 17 tests one box
// at a time with four lanes for y and z. In 2D there are two halves and a bucket of crossing boxes. The
// middles are those of the finite coordinates. The original sweeps along x; this sweeps, unless told
// otherwise, along the axis on which centres have the maximum variance.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "broadside/error.hpp"

#include "lab/literature/centres.hpp"
#include "lab/literature/literature.hpp"
#include "lab/literature/radix_sort.hpp"
#include "lab/literature/sorted_boxes.hpp"

namespace broadside::lab::literature {
namespace {

template <int D>
constexpr std::size_t bucket_count = (std::size_t{1} << (D - 1)) + 1;

/// The last bucket: boxes that cross a middle.
template <int D>
constexpr std::size_t crossing = bucket_count<D> - 1;

/// The boxes of one set, distributed to buckets, each sorted along the sweep axis.
template <int D>
class SweptBuckets {
 public:
  void fill(std::span<const Box<D>> boxes, std::size_t begin, std::size_t end, int sweep_axis) {
    const auto middles = middles_of(boxes.subspan(begin, end - begin), sweep_axis);
    const auto entries = sorter_.entries(end - begin);
    bucket_of_.resize(end - begin);
    std::array<std::size_t, bucket_count<D>> counts{};
    for (std::size_t i = begin; i < end; ++i) {
      entries[i - begin] = {sort_key(boxes[i].min[sweep_axis]), static_cast<std::uint32_t>(i)};
      const std::size_t bucket = bucket_of(boxes[i], middles, sweep_axis);
      bucket_of_[i - begin] = static_cast<std::uint8_t>(bucket);
      ++counts[bucket];
    }
    for (std::size_t bucket = 0; bucket < bucket_count<D>; ++bucket) {
      sorted[bucket].resize(counts[bucket]);
      bounds[bucket] = absent_box<D>();
    }
    counts.fill(0);
    for (const auto& entry : sorter_.sort()) {
      const std::size_t bucket = bucket_of_[entry.place - begin];
      const Box<D>& box = boxes[entry.place];
      sorted[bucket].set(counts[bucket]++, box, BoxId{entry.place}, sweep_axis);
      for (int axis = 0; axis < D; ++axis) {
        bounds[bucket].min[axis] = std::min(bounds[bucket].min[axis], box.min[axis]);
        bounds[bucket].max[axis] = std::max(bounds[bucket].max[axis], box.max[axis]);
      }
    }
  }

  std::array<SortedBoxes<D>, bucket_count<D>> sorted;
  std::array<Box<D>, bucket_count<D>> bounds;

 private:
  using Middles = std::array<float, D - 1>;

  static Middles middles_of(std::span<const Box<D>> boxes, int sweep_axis) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Middles middles;
    for (int i = 0; i < D - 1; ++i) {
      const int axis = (sweep_axis + 1 + i) % D;
      float low = infinity;
      float high = -infinity;
      for (const Box<D>& box : boxes) {
        if (box.min[axis] > -infinity) low = std::min(low, box.min[axis]);
        if (box.max[axis] < infinity) high = std::max(high, box.max[axis]);
      }
      middles[i] = low / 2 + high / 2;
    }
    return middles;
  }

  /// A bit for each axis on which the box is above the middle; the last bucket if it crosses one.
  static std::size_t bucket_of(const Box<D>& box, const Middles& middles, int sweep_axis) {
    std::size_t bucket = 0;
    bool crosses = false;
    for (int i = 0; i < D - 1; ++i) {
      const int axis = (sweep_axis + 1 + i) % D;
      const bool above = box.min[axis] > middles[i];
      crosses |= !above & !(box.max[axis] < middles[i]);
      bucket |= static_cast<std::size_t>(above) << i;
    }
    return crosses ? crossing<D> : bucket;
  }

  RadixSort<std::uint32_t> sorter_;
  std::vector<std::uint8_t> bucket_of_;
};

template <int D>
class TerdimanBoxPruning final : public Searcher<D> {
 public:
  explicit TerdimanBoxPruning(const Settings& settings)
      : axis_(settings.is_auto("axis") ? -1 : settings.text("axis")[0] - 'x') {
    if (axis_ >= D) throw InvalidSpec("axis 'z' in 2D; expected x or y");
  }

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    const std::span<const Box<D>> boxes = input.boxes;
    const int axis = axis_ >= 0 ? axis_ : widest_axis(boxes);
    const std::size_t left_count = input.left_count;
    Checkpoint checkpoint(input.workers.checkpoint);
    left_.fill(boxes, 0, left_count == 0 ? boxes.size() : left_count, axis);
    if (left_count > 0) {
      right_.fill(boxes, left_count, boxes.size(), axis);
      for (std::size_t i = 0; i < bucket_count<D>; ++i) {
        for (std::size_t j = 0; j < bucket_count<D>; ++j) {
          if (overlap(left_.bounds[i], right_.bounds[j]))
            sweep(left_.sorted[i], right_.sorted[j], checkpoint, pairs);
        }
      }
      return std::nullopt;
    }
    for (const SortedBoxes<D>& bucket : left_.sorted) sweep(bucket, checkpoint, pairs);
    for (std::size_t i = 0; i < crossing<D>; ++i)
      sweep(left_.sorted[i], left_.sorted[crossing<D>], checkpoint, pairs);
    return std::nullopt;
  }

 private:
  static int widest_axis(std::span<const Box<D>> boxes) {
    Centres<D> centres;
    for (const Box<D>& box : boxes) centres.add(box);
    return centres.widest_axis();
  }

  int axis_;              // the sweep axis; -1: that of maximum variance of centres
  SweptBuckets<D> left_;  // all boxes, if there is one set
  SweptBuckets<D> right_;
};

}  // namespace

Algorithm terdiman_box_pruning() {
  return {
      .name = "terdiman_box_pruning",
      .summary = "boxes dealt into quadrants, sorted, and swept eight at a time with sentinels",
      .source = "Terdiman 2017-2018, Box pruning revisited, parts 1 to 17",
      .kind = AlgorithmKind::literature,
      .tunables = {{.name = "axis",
                    .summary = "the axis along which it sweeps",
                    .default_value = "auto",
                    .type = Tunable::Type::choice,
                    .choices = {"auto", "x", "y", "z"}}},
      .in_2d = {.searcher = make_strategy<TerdimanBoxPruning<2>>},
      .in_3d = {.searcher = make_strategy<TerdimanBoxPruning<3>>},
  };
}

}  // namespace broadside::lab::literature
