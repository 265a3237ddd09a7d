// Tsitsigkos, Bouros, Mamoulis and Terrovitis 2019, "Parallel In-Memory Evaluation of Spatial Joins"
// (SIGSPATIAL; arXiv 1908.11740): Patel and DeWitt's partition-based spatial merge join (PBSM, 1996) in main
// memory. Follows their findings: partitions are stripes along one axis; each stripe is swept along the other
// axis by the forward scan of Brinkhoff et al. 1993; histograms choose the sweep axis; a stripe is about ten
// times as wide as the mean rectangle. A pair found in several stripes is reported in the stripe that holds
// its reference point (Dittrich and Seeger 2000), compared on the partition axis alone.
//
// Differences: boxes are sorted once, by a radix sort, and then copied to the stripes in order, where the
// paper sorts each stripe. Histograms use a sample. The reference-point test is one bit: whether the box
// begins in an earlier stripe. A single set is joined with itself. In 3D, the third axis is one more test of
// a pair. Single-threaded.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lab/literature/cut_axis.hpp"
#include "lab/literature/literature.hpp"
#include "lab/literature/radix_sort.hpp"

namespace broadside::lab::literature {
namespace {

/// A box in a stripe: its interval on the sweep axis, and on the others.
template <int D>
struct StripeEntry {
  float begin;
  float end;
  std::array<float, D - 1> low;
  std::array<float, D - 1> high;
  std::uint32_t id;
  bool begins_before;  // in an earlier stripe
};

template <int D>
class PbsmStripes final : public Searcher<D> {
 public:
  /// `width` is the width of a stripe in mean extents.
  explicit PbsmStripes(const Settings& settings) : width_(settings.number("width")) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    const std::span<const Box<D>> boxes = input.boxes;
    if (boxes.empty()) return std::nullopt;
    const std::size_t left = input.left_count;
    for (int axis = 0; axis < D; ++axis) extents_[axis] = extent_of<D>(boxes, axis);
    choose_axes(boxes, left);
    const Extent& extent = extents_[partition_axis_];
    // At most as many stripes as boxes, which matters for points.
    const double stripes = std::ceil(extent.length() / (width_ * extent.mean));
    const bool finite = stripes >= 1;  // not NaN
    const auto max_stripes = static_cast<double>(boxes.size());
    stripes_ = extent.cut(finite ? static_cast<std::size_t>(std::min(stripes, max_stripes)) : 1);

    Checkpoint checkpoint(input.workers.checkpoint);
    if (left == 0) {
      partition(boxes, 0, boxes.size(), left_);
      for (std::size_t stripe = 0; stripe < stripes_.cells; ++stripe)
        join(left_.run(stripe), checkpoint, pairs);
    } else {
      partition(boxes, 0, left, left_);
      partition(boxes, left, boxes.size(), right_);
      for (std::size_t stripe = 0; stripe < stripes_.cells; ++stripe)
        join(left_.run(stripe), right_.run(stripe), checkpoint, pairs);
    }
    return std::nullopt;
  }

 private:
  using Run = std::span<const StripeEntry<D>>;

  /// Sweeps along the axis on which the fewest pairs of boxes share a cell of a histogram; cuts stripes on
  /// the next best.
  void choose_axes(std::span<const Box<D>> boxes, std::size_t left) {
    constexpr std::size_t sample_size = 2000;
    constexpr std::size_t histogram_cells = 1000;
    const std::size_t step = std::max<std::size_t>(boxes.size() / sample_size, 1);
    std::array<double, D> shared{};
    for (int axis = 0; axis < D; ++axis) {
      const CutAxis cut = extents_[axis].cut(histogram_cells);
      std::array<std::array<std::int32_t, histogram_cells + 1>, 2> changes{};
      for (std::size_t i = 0; i < boxes.size(); i += step) {
        auto& set = changes[i < left ? 0 : 1];
        ++set[cut.cell(boxes[i].min[axis])];
        --set[cut.cell(boxes[i].max[axis]) + 1];
      }
      std::array<double, 2> counts{};
      for (std::size_t cell = 0; cell < cut.cells; ++cell) {
        for (std::size_t set = 0; set < 2; ++set) counts[set] += changes[set][cell];
        shared[axis] += counts[1] * (left == 0 ? counts[1] : counts[0]);
      }
      // A single cell stands for a whole histogram of equal cells.
      if (cut.cells == 1) shared[axis] *= histogram_cells;
    }
    std::array<int, D> axes;
    for (int axis = 0; axis < D; ++axis) axes[axis] = axis;
    std::ranges::stable_sort(axes, {}, [&](int axis) { return shared[axis]; });
    sweep_axis_ = axes[0];
    partition_axis_ = axes[1];
  }

  /// The references of a set, stripe by stripe, sorted by their minima on the sweep axis.
  struct Stripes {
    std::vector<StripeEntry<D>> references;
    std::vector<std::size_t> ends;

    Run run(std::size_t stripe) const {
      const std::size_t begin = stripe == 0 ? 0 : ends[stripe - 1];
      return Run(references).subspan(begin, ends[stripe] - begin);
    }
  };

  void partition(std::span<const Box<D>> boxes, std::size_t begin, std::size_t end, Stripes& partition) {
    std::vector<std::size_t>& next = partition.ends;  // the next position in each stripe; in the end, its end
    next.assign(stripes_.cells + 1, 0);
    const auto entries = sorter_.entries(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      const Box<D>& box = boxes[i];
      entries[i - begin] = {sort_key(box.min[sweep_axis_]), static_cast<std::uint32_t>(i)};
      const std::size_t last = stripes_.cell(box.max[partition_axis_]);
      for (std::size_t stripe = stripes_.cell(box.min[partition_axis_]); stripe <= last; ++stripe)
        ++next[stripe + 1];
    }
    for (std::size_t stripe = 0; stripe < stripes_.cells; ++stripe) next[stripe + 1] += next[stripe];
    partition.references.resize(next[stripes_.cells]);
    for (const auto& entry : sorter_.sort()) {
      const Box<D>& box = boxes[entry.place];
      StripeEntry<D> reference{.begin = box.min[sweep_axis_],
                               .end = box.max[sweep_axis_],
                               .low = {},
                               .high = {},
                               .id = entry.place,
                               .begins_before = false};
      for (int i = 0; i < D - 1; ++i) {
        const int axis = (sweep_axis_ + 1 + i) % D;
        reference.low[i] = box.min[axis];
        reference.high[i] = box.max[axis];
      }
      const std::size_t last = stripes_.cell(box.max[partition_axis_]);
      for (std::size_t stripe = stripes_.cell(box.min[partition_axis_]); stripe <= last; ++stripe) {
        partition.references[next[stripe]++] = reference;
        reference.begins_before = true;
      }
    }
  }

  static bool meets(const StripeEntry<D>& a, const StripeEntry<D>& b) noexcept {
    bool touching = !(a.begins_before && b.begins_before);
    for (int i = 0; i < D - 1; ++i) {
      touching &= a.low[i] <= b.high[i];
      touching &= b.low[i] <= a.high[i];
    }
    return touching;
  }

  static void join(Run run, Checkpoint& checkpoint, PairSink& pairs) {
    for (auto a = run.begin(); a != run.end(); ++a) {
      auto b = a + 1;
      for (; b != run.end() && b->begin <= a->end; ++b) {
        if (meets(*a, *b)) pairs.add(BoxId{a->id}, BoxId{b->id});
      }
      checkpoint.count(static_cast<std::uint64_t>(b - a));
    }
  }

  /// The forward scan: takes the next box that begins first, from either set, and compares it with the other
  /// set's boxes from there on.
  static void join(Run left, Run right, Checkpoint& checkpoint, PairSink& pairs) {
    auto a = left.begin();
    auto b = right.begin();
    while (a != left.end() && b != right.end()) {
      if (a->begin <= b->begin) {
        auto other = b;
        for (; other != right.end() && other->begin <= a->end; ++other) {
          if (meets(*a, *other)) pairs.add(BoxId{a->id}, BoxId{other->id});
        }
        checkpoint.count(static_cast<std::uint64_t>(other - b) + 1);
        ++a;
      } else {
        auto other = a;
        for (; other != left.end() && other->begin <= b->end; ++other) {
          if (meets(*other, *b)) pairs.add(BoxId{other->id}, BoxId{b->id});
        }
        checkpoint.count(static_cast<std::uint64_t>(other - a) + 1);
        ++b;
      }
    }
  }

  double width_;
  std::array<Extent, D> extents_;
  int sweep_axis_ = 0;
  int partition_axis_ = 1;
  CutAxis stripes_;
  RadixSort<std::uint32_t> sorter_;
  Stripes left_;  // all boxes, if there is one set
  Stripes right_;
};

}  // namespace

Algorithm pbsm_stripes() {
  return {
      .name = "pbsm_stripes",
      .summary = "partition-based spatial merge join: stripes along one axis, swept along another",
      .source = "Tsitsigkos et al. 2019, Parallel In-Memory Evaluation of Spatial Joins",
      .kind = AlgorithmKind::literature,
      .tunables = {{.name = "width",
                    .summary = "a stripe's width, in mean extents of the boxes",
                    .default_value = "10",
                    .type = Tunable::Type::number,
                    .min = 0.5,
                    .max = 1e9}},
      .in_2d = {.searcher = make_strategy<PbsmStripes<2>>},
      .in_3d = {.searcher = make_strategy<PbsmStripes<3>>},
  };
}

}  // namespace broadside::lab::literature
