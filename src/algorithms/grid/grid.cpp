// Grid: uniform cells over all axes but one, and a sweep along the remaining axis in each cell. The cells are
// an array fitted to the boxes, not a spatial hash.
//
// Section III of the paper, without its limits: the outermost cells take in what lies beyond, so no world is
// declared. Boxes that fit in a core's cache are searched as a tile (tile_search.hpp). Of more, a box is
// stored in the cell that holds its minimum, and again in each further slab that it reaches; the sweep
// carries it on to the other cells. Each pair is reported once: in the cell that holds the greater of the two
// minima on every gridded axis.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/debug/outline.hpp"

#include "algorithms/follow_costs.hpp"
#include "algorithms/followers.hpp"
#include "algorithms/grid/grid_layout.hpp"
#include "algorithms/grid/grid_outline.hpp"
#include "algorithms/grid/grid_sweep.hpp"
#include "algorithms/grid/tile_cells.hpp"
#include "algorithms/grid/tile_search.hpp"
#include "algorithms/registry.hpp"
#include "algorithms/sweep_bounds.hpp"
#include "core/large_array.hpp"
#include "core/parallel.hpp"
#include "core/prefix_sum.hpp"
#include "core/sample.hpp"
#include "core/tunables.hpp"
#include "kernels/run.hpp"

namespace broadside::algorithm {
namespace {

/// Up to this many boxes, a tile's cells are the best however uneven the boxes are.
constexpr std::size_t max_uneven_tile = 4096;

/// The unevenness up to which they are, with more boxes.
constexpr double max_unevenness_of_a_tile = 8;

/// Places of a tile that a thread sweeps at a time.
constexpr std::size_t places_at_once = 64;

/// The tests of a box in a tile up to which no other search is better.
constexpr std::uint64_t max_tests_in_tile = 160;

template <int D>
class GridSearcher final : public Searcher<D> {
 public:
  explicit GridSearcher(const Settings& settings) : cell_(settings.optional_number("cell")) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    const std::size_t boxes = input.boxes.size();
    if (is_tile(input.boxes)) {
      if (sort_tile(input.boxes, input.left_count)) return sweep_tile(input, pairs);
      if (input.may_refuse) {
        // Cells of one size suit boxes badly that are so uneven. Nothing has been written yet.
        input.successor->finish([](const Box<D>&, BoxId, const Box<D>&, BoxId) { return true; });
        return Statistics{};
      }
    }
    parallel_.start(input.workers, boxes);
    sweeps_.resize(std::max(sweeps_.size(), parallel_.workers()));
    choose_cells(input.boxes);
    count_boxes(input.boxes);
    scatter(input);
    swept_to_.resize(layout_.slabs());
    const bool may_give_up = input.successor != nullptr;
    const auto sweep = [&](core::Range slabs, std::size_t worker, PairSink& sink) {
      Statistics statistics;
      for (std::size_t slab = slabs.begin; slab < slabs.end; ++slab) {
        const BoxesByCell<D> cells{entries_, begin_, input.doubles, parallel_.checkpoint(worker)};
        const std::uint64_t max_tests =
            may_give_up ? max_tests_of(slab, boxes) : std::numeric_limits<std::uint64_t>::max();
        const Statistics of_slab =
            sweeps_[worker].sweep(layout_, swept_range(), cells, slab, max_tests, sink);
        swept_to_[slab] = sweeps_[worker].swept_to();
        statistics.tests += of_slab.tests;
        statistics.references += of_slab.references;
      }
      return statistics;
    };
    const Statistics statistics = parallel_.search(layout_.slabs(), pairs, sweep);
    bool gave_up = false;
    for (std::size_t slab = 0; slab < layout_.slabs(); ++slab)
      gave_up |= swept_to_[slab] < layout_.slab_begin(slab + 1) * layout_.row_length();
    if (gave_up) {
      input.successor->finish(
          [this](const Box<D>& a, BoxId, const Box<D>& b, BoxId) { return is_missing(a, b); });
    }
    return statistics;
  }

  Outline<D> lay_out(std::span<const Box<D>> boxes, const Workers&) {
    if (is_tile(boxes) && sort_tile(boxes, 0)) return outline_of<D>(tile_cells_.axes, tile_cells_.row_axes);
    choose_cells(boxes);
    return outline_of<D>(layout_.axes(), layout_.cell_axes());
  }

 private:
  /// Whether the pair's cell was not swept: each slab sweeps its cells in order, up to where it gives up.
  bool is_missing(const Box<D>& a, const Box<D>& b) const {
    Box<D> corner = a;
    for (int axis = 0; axis < D; ++axis) corner.min[axis] = std::max(a.min[axis], b.min[axis]);
    const std::size_t row = layout_.row_of(corner);
    const std::size_t cell = row * layout_.row_length() + layout_.column_of(corner);
    return cell >= swept_to_[layout_.slab_of(row)];
  }

  /// The slab's share of all permitted tests, in proportion to the boxes inserted into it.
  std::uint64_t max_tests_of(std::size_t slab, std::size_t boxes) const {
    const std::size_t length = layout_.row_length();
    const auto inserted = static_cast<double>(begin_[layout_.slab_begin(slab + 1) * length] -
                                              begin_[layout_.slab_begin(slab) * length]);
    const double share = inserted / static_cast<double>(std::max<std::size_t>(1, begin_.back()));
    return static_cast<std::uint64_t>(share * static_cast<double>(max_tests_per_box * boxes)) + 1;
  }

  /// Whether the boxes fit in a core's cache, and may be in cells of any size.
  bool is_tile(std::span<const Box<D>> boxes) const {
    return !cell_ && boxes.size() <= TileCells<D>::max_boxes && !boxes.empty();
  }

  /// Sorts the boxes by cells that suit them. False if the boxes are too uneven for a tile's cells.
  bool sort_tile(std::span<const Box<D>> boxes, std::size_t left_count) {
    const auto sort = [&](const TileCells<D>& cells) {
      tile_cells_ = cells;
      const double limit =
          boxes.size() > max_uneven_tile ? max_unevenness_of_a_tile : std::numeric_limits<double>::infinity();
      return tile_.sort(boxes, cells, left_count, limit);
    };
    const auto stats = TileStats<D>::of(boxes);
    const std::optional<std::uint64_t> tests = sort(TileCells<D>::choose(stats, boxes.size()));
    if (!tests) return false;
    const auto are_many = [&](std::uint64_t some) {
      return some > max_tests_in_tile * boxes.size() && tile_.finds_few_pairs();
    };
    if (!are_many(*tests)) return true;
    // A few boxes far away may have left most cells empty.
    sample_.take(boxes);
    const auto stats_by_sample = TileStats<D>::of(sample_);
    if (!stats_by_sample.is_narrower_than(stats)) return false;
    const auto by_sample = sort(TileCells<D>::choose(stats_by_sample, boxes.size()));
    return by_sample && !are_many(*by_sample);
  }

  Statistics sweep_tile(const SearchInput<D>& input, PairSink& pairs) {
    parallel_.start(input.workers, input.boxes.size());
    const auto sweep = [&](core::Range some, std::size_t worker, PairSink& sink) {
      return Statistics{.tests = tile_.sweep(some.begin * places_at_once, some.end * places_at_once,
                                             input.doubles, parallel_.checkpoint(worker), sink)};
    };
    Statistics statistics =
        parallel_.search((tile_.places() + places_at_once - 1) / places_at_once, pairs, sweep);
    statistics.references = tile_.references();
    return statistics;
  }

  void choose_cells(std::span<const Box<D>> boxes) {
    sample_.take(boxes);
    layout_.choose(sample_, boxes.size(), cell_);
  }

  /// The sample's range on the swept axis and a little more, since a sample misses the ends.
  SweptRange swept_range() const {
    const core::AxisSample& swept = sample_[layout_.axes()[0]];
    const float more = (swept.high / 16 - swept.low / 16);
    return {std::max(swept.low - more, -std::numeric_limits<float>::max()),
            std::min(swept.high + more, std::numeric_limits<float>::max())};
  }

  /// Counts the cells that get a copy of the box, and returns them encoded in a number. The low bits are the
  /// cell of the box's minimum. The bits above are the number of further slabs that the box reaches; in each
  /// of them it is in the first row.
  std::uint32_t count_places(const Box<D>& box, std::uint64_t* counts) const {
    const std::size_t row = layout_.row_of(box);
    const std::size_t column = layout_.column_of(box);
    const std::size_t length = layout_.row_length();
    const std::size_t cell = row * length + column;
    ++counts[cell];
    const float max = box.max[layout_.axes()[D - 1]];
    if (!(max >= layout_.slab_border(row))) [[likely]]
      return static_cast<std::uint32_t>(cell);
    std::uint32_t further = 0;
    for (std::size_t slab = layout_.slab_of(row) + 1; slab < layout_.slabs(); ++slab) {
      const std::size_t first = layout_.slab_begin(slab);
      ++counts[first * length + column];
      ++further;
      if (!(max >= layout_.slab_border(first))) break;
    }
    return static_cast<std::uint32_t>(cell) | further << GridLayout<D>::cell_bits;
  }

  /// Calls `visit` with each cell that count_places() counted, and with the box's dedup_mask in that cell.
  template <typename Visit>
  void for_each_place(std::uint32_t places, Visit visit) const {
    const std::size_t cell = places & ((1U << GridLayout<D>::cell_bits) - 1);
    visit(cell, 0U);
    std::uint32_t further = places >> GridLayout<D>::cell_bits;
    if (further == 0) [[likely]]
      return;
    const std::size_t length = layout_.row_length();
    for (std::size_t slab = layout_.slab_of(cell / length) + 1; further > 0; ++slab, --further)
      visit(layout_.slab_begin(slab) * length + cell % length, 1U << layout_.axes()[D - 1]);
  }

  /// Sets begin_ to where each cell's boxes will begin, and next_ to the same for each range.
  void count_boxes(std::span<const Box<D>> boxes) {
    const std::size_t cells = layout_.cells();
    next_.assign(parallel_.range_count() * cells, 0);
    core::renew(places_, boxes.size());
    parallel_.for_numbered_ranges(boxes.size(), [&](std::size_t number, core::Range range, std::size_t) {
      std::uint64_t* const counts = next_.data() + number * cells;
      for (std::size_t i = range.begin; i < range.end; ++i) places_[i] = count_places(boxes[i], counts);
    });
    const std::uint64_t sum = core::prefix_sum(std::span<std::uint64_t>(next_), cells);
    begin_.assign(next_.begin(), next_.begin() + static_cast<std::ptrdiff_t>(cells));
    begin_.push_back(sum);
  }

  /// Copies the boxes to the cells that were counted. It does not compute the cells again, because another
  /// thread may have changed the caller's array since.
  void scatter(const SearchInput<D>& input) {
    const std::span<const Box<D>> boxes = input.boxes;
    core::renew(entries_, begin_.back());
    parallel_.for_numbered_ranges(boxes.size(), [&](std::size_t number, core::Range range, std::size_t) {
      std::uint64_t* const next = next_.data() + number * layout_.cells();
      CellEntry<D>* const entries = entries_.data();
      for (std::size_t i = range.begin; i < range.end; ++i) {
        const Box<D>& box = boxes[i];
        const auto id = static_cast<BoxId>(i);
        const std::uint32_t side = kernels::side_bit(id, input.left_count);
        for_each_place(places_[i], [&](std::size_t cell, std::uint32_t dedup_mask) {
          entries[next[cell]++] = {box, id, side | dedup_mask};
        });
      }
    });
  }

  std::optional<double> cell_;

  TileCells<D> tile_cells_{};
  TileSearch<D> tile_;
  core::Sample<D> sample_;
  GridLayout<D> layout_;
  core::LargeArray<std::uint64_t> begin_;
  core::LargeArray<std::uint64_t> next_;
  core::LargeArray<std::uint32_t> places_;  // by box: its cells, as count_places() encodes them
  core::LargeArray<CellEntry<D>> entries_;
  core::Parallel parallel_;
  std::vector<GridSweep<D>> sweeps_;   // by worker
  std::vector<std::size_t> swept_to_;  // by slab: the first cell that was not swept
};

template <int D>
Strategies<D> grid_strategies() {
  return {.searcher = make_strategy<GridSearcher<D>>,
          .followers = {{"grid", make_grid_follower<D>, grid_following<D>}},
          .find_costs = grid_finding<D>,
          .outline = core::outline_by(&GridSearcher<D>::lay_out)};
}

}  // namespace

Algorithm grid() {
  return {
      .name = "grid",
      .summary =
          "cells over all axes but one, a sweep along that one in each; boxes that move are followed in "
          "levels "
          "of cells, one for each size of boxes",
      .source =
          "paper.md, sections III and VI-B; report-once rule: Tsitsigkos et al., arXiv 2307.09256; levels: "
          "C. Ericson, Real-Time Collision Detection (2005), 7.2",
      .tunables = {{.name = "cell",
                    .summary = "size of a cell, in the boxes' unit; made larger where there would be over 4 "
                               "cells per box; in tracking, the size of the smallest cells",
                    .default_value = "auto",
                    .min = std::numeric_limits<float>::min()},
                   core::update_tunable(),
                   core::threads_tunable()},
      .in_2d = core::in_dimension<2, grid_strategies<2>>(),
      .in_3d = core::in_dimension<3, grid_strategies<3>>(),
      .tests_doubles = true,
      .gives_candidates = true,
  };
}

}  // namespace broadside::algorithm
