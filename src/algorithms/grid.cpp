// Grid: cells over all axes but one, a sweep along that one in each cell, and levels of cells for sizes that
// vary.
//
// Section III of the paper, without its limits: the cells clamp what lies outside them, so no world is
// declared. A box that spans many cells goes to a level of cells four times as wide, or further up, so that
// no box is in more than a few cells; boxes of lower levels visit the cells of the levels above that hold
// boxes of their own. No pair is found twice: it is reported in the one cell that holds the greater of the
// two boxes' minima on every gridded axis.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "broadside/broad_phase.hpp"

#include "algorithms/descriptions.hpp"
#include "core/cell_lists.hpp"
#include "core/sample.hpp"
#include "core/sorted_boxes.hpp"
#include "kernels/sweep.hpp"

namespace broadside::own {
namespace {

constexpr int level_bits = 2;  // a cell of one level is 2^level_bits cells of the level below wide
constexpr int most_levels = 17;

/// A cell's size, in median extents: small enough to keep boxes apart, large enough that few lie in more than
/// one cell.
constexpr double cell_in_extents = 4;

/// Up to here every cell's number is a float exactly.
constexpr double exact_cells = 1 << 24;

/// Fewer boxes than this are one cell: looking at them costs more than cells save.
constexpr std::size_t few_boxes = 32;

template <int D>
class Grid final : public PairFinder<D> {
 public:
  explicit Grid(std::optional<double> cell) : cell_(cell) {}

 private:
  static constexpr int gridded = D - 1;  // axes 1 to D - 1 of the sorted boxes

  using Cell = std::array<std::uint32_t, gridded>;

  /// The cells, of level 0, from the one that holds a box's minimum to the one that holds its maximum.
  struct Place {
    Cell first;
    Cell last;
    std::uint32_t level;
  };

  /// The cells of one level.
  struct Level {
    std::size_t offset;  // of its first cell among the cells of all levels
    Cell cells;          // how many there are along each axis
    bool occupied;       // whether boxes are filed here in their own right
  };

  void find_valid(std::span<const Box<D>> boxes, PairSink& pairs) override {
    const std::array<int, D> axes = lay_out(boxes);
    const std::span<const core::SortedBox<D>> sorted = sorted_.sort(boxes, axes);
    file(sorted);
    Statistics statistics{.tests = 0, .references = residents_.size() + visitors_.size()};
    for (std::uint32_t level = 0; level < level_count_; ++level) {
      if (levels_[level].occupied) statistics.tests += sweep_level(sorted, level, pairs);
    }
    this->count(statistics);
  }

  /// Chooses the swept axis and the cells over the others. Returns the axes, the swept one first.
  std::array<int, D> lay_out(std::span<const Box<D>> boxes) {
    sample_.take(boxes);
    const std::array<int, D> axes = sample_.axes_by_overlap();
    const double cells_per_box = cell_ ? 4 : 0.125;
    const double most_cells = boxes.size() < few_boxes
                                  ? 1
                                  : std::min(cells_per_box * static_cast<double>(boxes.size()), exact_cells);
    std::array<double, gridded> cells;
    for (int axis = 0; axis < gridded; ++axis) {
      const core::AxisSample& sample = sample_[axes[axis + 1]];
      const double range = static_cast<double>(sample.high) - sample.low;
      const double size = cell_.value_or(cell_in_extents * sample.extent);
      cells[axis] = range > 0 ? std::clamp(range / size, 1.0, most_cells) : 1;
    }
    // Too many cells in all: the longer side gives way first.
    for (;;) {
      double product = 1;
      for (const double count : cells) product *= count;
      double& longest = *std::ranges::max_element(cells);
      if (product <= most_cells || longest <= 1) break;
      longest = std::max(1.0, longest / 2);
    }

    Cell counts;
    for (int axis = 0; axis < gridded; ++axis) {
      const core::AxisSample& sample = sample_[axes[axis + 1]];
      counts[axis] = static_cast<std::uint32_t>(cells[axis]);
      const double range = static_cast<double>(sample.high) - sample.low;
      low_[axis] = sample.low;
      // Neither zero nor infinite, which an infinite or a zero distance would turn into a NaN.
      const double per_unit = range > 0 ? counts[axis] / range : 1;
      per_unit_[axis] = static_cast<float>(
          std::clamp<double>(per_unit, std::numeric_limits<float>::min(), std::numeric_limits<float>::max()));
    }
    std::size_t offset = 0;
    level_count_ = 0;
    for (bool one_cell = false; !one_cell; ++level_count_) {
      Level& level = levels_[level_count_];
      level = {offset, {}, false};
      std::size_t product = 1;
      for (int axis = 0; axis < gridded; ++axis) {
        level.cells[axis] = ((counts[axis] - 1) >> (level_bits * level_count_)) + 1;
        product *= level.cells[axis];
      }
      offset += product;
      one_cell = product == 1;
    }
    cell_count_ = offset;
    return axes;
  }

  /// The one formula by which a coordinate has a cell. It rises with the coordinate and clamps it, infinite
  /// or not.
  std::uint32_t cell_of(float coordinate, int axis) const {
    const float cell = (coordinate - low_[axis]) * per_unit_[axis];
    const auto last = static_cast<float>(levels_[0].cells[axis] - 1);
    return static_cast<std::uint32_t>(std::min(std::max(cell, 0.0F), last));
  }

  /// Calls `visit` with the number of each cell of `level` in which a box at `place` lies.
  template <typename Visit>
  void for_each_cell(const Place& place, std::uint32_t level, Visit visit) const {
    const int shift = level_bits * static_cast<int>(level);
    const Level& at = levels_[level];
    if constexpr (gridded == 1) {
      for (std::uint32_t x = place.first[0] >> shift; x <= place.last[0] >> shift; ++x) visit(at.offset + x);
    } else {
      for (std::uint32_t y = place.first[1] >> shift; y <= place.last[1] >> shift; ++y) {
        const std::size_t row = at.offset + std::size_t{y} * at.cells[0];
        for (std::uint32_t x = place.first[0] >> shift; x <= place.last[0] >> shift; ++x) visit(row + x);
      }
    }
  }

  /// Files every box in the cells of its own level, as a resident, and in those of the levels above that have
  /// residents, as a visitor. In each list the boxes are in the order in which they are swept.
  void file(std::span<const core::SortedBox<D>> sorted) {
    places_.resize(sorted.size());
    residents_.reset(cell_count_);
    visitors_.reset(cell_count_);
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      Place& place = places_[i];
      std::uint32_t span = 1;
      for (int axis = 0; axis < gridded; ++axis) {
        place.first[axis] = cell_of(sorted[i].box.min[axis + 1], axis);
        place.last[axis] = cell_of(sorted[i].box.max[axis + 1], axis);
        span = std::max(span, place.last[axis] - place.first[axis]);
      }
      const auto level = static_cast<std::uint32_t>((std::bit_width(span) - 1) / level_bits);
      place.level = std::min(level, level_count_ - 1);
      levels_[place.level].occupied = true;
      for_each_cell(place, place.level, [this](std::size_t cell) { residents_.count(cell); });
    }
    for_each_visit([this](std::size_t cell, std::uint32_t) { visitors_.count(cell); });

    // Whether a cell has residents is asked of the counts while visitors are filed, so visitors go first.
    visitors_.prepare();
    for_each_visit([this](std::size_t cell, std::uint32_t i) { visitors_.file(cell, i); });
    residents_.prepare();
    for (std::uint32_t i = 0; i < places_.size(); ++i) {
      for_each_cell(places_[i], places_[i].level, [this, i](std::size_t cell) { residents_.file(cell, i); });
    }
  }

  /// Calls `visit` with a cell and a box for each cell with residents of a level above the box's that it lies
  /// in.
  template <typename Visit>
  void for_each_visit(Visit visit) const {
    std::uint32_t lowest = 0;
    while (!levels_[lowest].occupied && lowest + 1 < level_count_) ++lowest;
    for (std::uint32_t level = lowest + 1; level < level_count_; ++level) {
      if (!levels_[level].occupied) continue;
      for (std::uint32_t i = 0; i < places_.size(); ++i) {
        if (places_[i].level >= level) continue;
        for_each_cell(places_[i], level, [&](std::size_t cell) {
          if (residents_.counted(cell) > 0) visit(cell, i);
        });
      }
    }
  }

  /// Sweeps every cell of a level: residents among themselves, and against visitors. Returns the tests made.
  std::uint64_t sweep_level(std::span<const core::SortedBox<D>> sorted, std::uint32_t level,
                            PairSink& pairs) {
    std::uint64_t tests = 0;
    const Level& at = levels_[level];
    Cell cell{};
    std::size_t number = at.offset;
    const std::size_t rows = gridded == 1 ? 1 : at.cells[gridded - 1];
    for (std::size_t row = 0; row < rows; ++row) {
      if constexpr (gridded == 2) cell[1] = static_cast<std::uint32_t>(row);
      for (cell[0] = 0; cell[0] < at.cells[0]; ++cell[0], ++number) {
        const std::span<const std::uint32_t> residents = residents_.list(number);
        const std::span<const std::uint32_t> visitors = visitors_.list(number);
        if (residents.size() + visitors.size() < 2 || residents.empty()) continue;
        gather(sorted, residents, cell, level, residents_run_);
        tests += kernels::sweep(residents_run_.view(), pairs);
        if (visitors.empty()) continue;
        gather(sorted, visitors, cell, level, visitors_run_);
        tests += kernels::sweep(residents_run_.view(), visitors_run_.view(), pairs);
      }
    }
    return tests;
  }

  void gather(std::span<const core::SortedBox<D>> sorted, std::span<const std::uint32_t> list,
              const Cell& cell, std::uint32_t level, kernels::RunBuffer<D>& run) const {
    const int shift = level_bits * static_cast<int>(level);
    run.clear();
    run.reserve(list.size());
    for (const std::uint32_t i : list) {
      std::uint32_t before = 0;
      for (int axis = 0; axis < gridded; ++axis)
        before |= static_cast<std::uint32_t>(places_[i].first[axis] >> shift < cell[axis]) << axis;
      run.append(sorted[i].box, sorted[i].id, before | kernels::side_bit(sorted[i].id, this->left_count()));
    }
  }

  std::optional<double> cell_;

  core::Sample<D> sample_;
  core::SortedBoxes<D> sorted_;
  std::array<float, gridded> low_{};
  std::array<float, gridded> per_unit_{};
  std::array<Level, most_levels> levels_{};
  std::uint32_t level_count_ = 0;
  std::size_t cell_count_ = 0;
  std::vector<Place> places_;
  core::CellLists residents_;
  core::CellLists visitors_;
  kernels::RunBuffer<D> residents_run_;
  kernels::RunBuffer<D> visitors_run_;
};

template <int D>
std::unique_ptr<PairFinder<D>> make(const Settings& settings) {
  if (settings.is_auto("cell")) return std::make_unique<Grid<D>>(std::nullopt);
  return std::make_unique<Grid<D>>(settings.number("cell"));
}

}  // namespace

Algorithm grid() {
  return {
      .name = "grid",
      .summary =
          "cells over all axes but one, a sweep along that one in each; levels of cells for large boxes",
      .source = "paper.md, section III; report-once rule: Tsitsigkos et al., arXiv 2307.09256",
      .tunables =
          {{.name = "cell",
            .summary =
                "size of a cell, in the boxes' unit; made larger where there would be over 4 cells a box",
            .standard = "auto",
            .least = std::numeric_limits<float>::min()}},
      .finder_2d = make<2>,
      .finder_3d = make<3>,
  };
}

}  // namespace broadside::own
