// The algorithm of `grid` written plainly, so that each thing that makes it fast can be left out alone.
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
#include "kernels/run.hpp"
#include "kernels/sweep.hpp"

namespace broadside::bench {

/// What a search of the grid does, one by one. The standard values are those of `grid`.
struct GridDesign {
  bool samples = true;  ///< cells from a sample of the boxes; else twice as wide as boxes are on average
  bool carries = true;  ///< a box is put into one cell and carried on; else it is put into all that it meets
  bool buckets = true;  ///< a cell's boxes are ordered by a counting sort; else by std::sort
  bool arrays = true;   ///< an array for each bound; else one of boxes
  bool branch_free = true;  ///< hits are written without a branch
  bool simd = true;         ///< by the library's kernel, which takes arrays and writes without a branch
};

/// Finds the pairs of boxes, none of them absent or infinite. Keeps its memory.
template <int D>
class PlainGrid {
 public:
  explicit PlainGrid(const GridDesign& design) : design_(design) {}

  void find(std::span<const Box<D>> boxes, PairSink& pairs) {
    choose_cells(boxes);
    insert(boxes);
    for (std::vector<Entry>& list : up_) list.clear();
    up_.resize(length_);
    std::vector<Entry> along;
    for (std::size_t cell = 0; cell + 1 < begin_.size(); ++cell) {
      const std::size_t column = cell % length_;
      if (column == 0) along.clear();
      gather(cell, column, along);
      sweep(pairs);
    }
    pairs.flush();
  }

 private:
  struct Entry {
    Box<D> box;
    BoxId id;
    std::uint32_t dedup_mask;  // a bit for each axis on which the box begins in an earlier cell
  };

  /// Cells of one width along an axis. What lies beyond the first or the last one counts as in it.
  struct Cells {
    int axis = 0;
    float low = 0;
    float per_unit = 1;
    std::size_t count = 1;
    std::vector<float> borders{};  // the least coordinate of each cell but the first, and NaN

    std::size_t of(float coordinate) const {
      const float cell = (coordinate - low) * per_unit;
      return static_cast<std::size_t>(std::clamp(cell, 0.0F, static_cast<float>(count - 1)));
    }

    void set_borders() {
      borders.clear();
      for (std::size_t cell = 1; cell < count; ++cell) {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        float border = low + static_cast<float>(cell) / per_unit;
        while (of(border) >= cell) border = std::nextafter(border, -infinity);
        while (of(border) < cell) border = std::nextafter(border, infinity);
        borders.push_back(border);
      }
      borders.push_back(std::numeric_limits<float>::quiet_NaN());
    }
  };

  /// Sweeps along the axis on which the fewest boxes overlap, or along the first one, and cuts the others.
  void choose_cells(std::span<const Box<D>> boxes) {
    std::array<float, D> extents{};
    std::array<float, D> lows{};
    std::array<float, D> highs{};
    std::array<int, D> axes{};
    for (int axis = 0; axis < D; ++axis) axes[axis] = axis;
    if (design_.samples) {
      sample_.take(boxes);
      axes = sample_.axes_by_overlap();
      for (int axis = 0; axis < D; ++axis) {
        extents[axis] = static_cast<float>(sample_[axis].mean_extent);
        lows[axis] = sample_[axis].low;
        highs[axis] = sample_[axis].high;
      }
    } else {
      measure(boxes, extents, lows, highs);
    }
    swept_ = axes[0];
    low_ = lows[swept_];
    high_ = highs[swept_];
    const std::array<Cells*, 2> gridded = {&rows_, &columns_};
    columns_ = {};
    for (int i = 1; i < D; ++i) {
      const int axis = axes[i];
      Cells& cells = *gridded[i - 1];
      cells.axis = axis;
      cells.low = lows[axis];
      const float length = std::max(highs[axis] - lows[axis], std::numeric_limits<float>::min());
      const auto most = static_cast<float>(std::pow(boxes.size(), 1.0 / (D - 1)));
      const float count = std::clamp(length / std::max(2 * extents[axis], length / most), 1.0F, most);
      cells.count = static_cast<std::size_t>(count);
      cells.per_unit = static_cast<float>(cells.count) / length;
    }
    rows_.set_borders();
    columns_.set_borders();
    length_ = columns_.count;
  }

  void measure(std::span<const Box<D>> boxes, std::array<float, D>& extents, std::array<float, D>& lows,
               std::array<float, D>& highs) const {
    lows.fill(std::numeric_limits<float>::max());
    highs.fill(std::numeric_limits<float>::lowest());
    std::array<double, D> sums{};
    for (const Box<D>& box : boxes) {
      for (int axis = 0; axis < D; ++axis) {
        lows[axis] = std::min(lows[axis], box.min[axis]);
        highs[axis] = std::max(highs[axis], box.max[axis]);
        sums[axis] += static_cast<double>(box.max[axis]) - box.min[axis];
      }
    }
    for (int axis = 0; axis < D; ++axis)
      extents[axis] =
          static_cast<float>(sums[axis] / static_cast<double>(std::max<std::size_t>(1, boxes.size())));
  }

  /// Calls `visit` with each cell that the box is put into, and its dedup_mask there.
  template <typename Visit>
  void for_each_cell(const Box<D>& box, const Visit& visit) const {
    const std::size_t row = rows_.of(box.min[rows_.axis]);
    const std::size_t column = D == 3 ? columns_.of(box.min[columns_.axis]) : 0;
    if (design_.carries) return visit(row * length_ + column, 0U);
    const std::size_t last_row = rows_.of(box.max[rows_.axis]);
    const std::size_t last_column = D == 3 ? columns_.of(box.max[columns_.axis]) : 0;
    for (std::size_t r = row; r <= last_row; ++r) {
      for (std::size_t c = column; c <= last_column; ++c)
        visit(r * length_ + c, (r > row ? row_bit() : 0U) | (c > column ? column_bit() : 0U));
    }
  }

  std::uint32_t row_bit() const { return 1U << rows_.axis; }
  std::uint32_t column_bit() const { return 1U << columns_.axis; }

  /// Puts the boxes into their cells, by counting.
  void insert(std::span<const Box<D>> boxes) {
    begin_.assign(rows_.count * length_ + 1, 0);
    for (const Box<D>& box : boxes)
      for_each_cell(box, [&](std::size_t cell, std::uint32_t) { ++begin_[cell + 1]; });
    for (std::size_t cell = 1; cell < begin_.size(); ++cell) begin_[cell] += begin_[cell - 1];
    next_.assign(begin_.begin(), begin_.end());
    entries_.resize(begin_.back());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for_each_cell(boxes[i], [&](std::size_t cell, std::uint32_t mask) {
        entries_[next_[cell]++] = {boxes[i], static_cast<BoxId>(i), mask};
      });
    }
  }

  /// Sets cell_ to the boxes of a cell: those put there and those carried there; carries on what goes on.
  void gather(std::size_t cell, std::size_t column, std::vector<Entry>& along) {
    cell_.assign(entries_.begin() + static_cast<std::ptrdiff_t>(begin_[cell]),
                 entries_.begin() + static_cast<std::ptrdiff_t>(begin_[cell + 1]));
    if (!design_.carries) return;
    const float row_border = rows_.borders[cell / length_];
    const float column_border = columns_.borders[column];
    cell_.insert(cell_.end(), along.begin(), along.end());
    if constexpr (D == 3) pass_on(cell_, columns_.axis, column_border, column_bit(), along);
    cell_.insert(cell_.end(), up_[column].begin(), up_[column].end());
    pass_on(cell_, rows_.axis, row_border, row_bit(), up_[column]);
  }

  /// Sets `to` to those that reach the border. Written in any case, and kept if it goes on.
  static void pass_on(const std::vector<Entry>& from, int axis, float border, std::uint32_t bit,
                      std::vector<Entry>& to) {
    to.resize(from.size() + 1);
    std::size_t count = 0;
    for (const Entry& entry : from) {
      to[count] = entry;
      to[count].dedup_mask |= bit;
      count += entry.box.max[axis] >= border ? 1 : 0;
    }
    to.resize(count);
  }

  void sweep(PairSink& pairs) {
    if (cell_.size() < 2) return;
    const float slack = order();
    if (!design_.arrays) return sweep_boxes(slack, pairs);
    run_.clear();
    run_.reserve(cell_.size());
    for (const Entry& entry : cell_) {
      Box<D> box;
      for (int axis = 0; axis < D; ++axis) {
        box.min[axis] = entry.box.min[(axis + swept_) % D];
        box.max[axis] = entry.box.max[(axis + swept_) % D];
      }
      run_.append(box, entry.id, entry.dedup_mask);
    }
    const kernels::Run<D> run = run_.view(nullptr, slack);
    if (design_.simd)
      kernels::sweep(run, pairs);
    else
      sweep_arrays(run, pairs);
  }

  /// Orders cell_ along the swept axis; returns by how much a box may begin before an earlier one.
  float order() {
    const auto before = [this](const Entry& a, const Entry& b) {
      return a.box.min[swept_] < b.box.min[swept_];
    };
    if (!design_.buckets) {
      std::sort(cell_.begin(), cell_.end(), before);
      return 0;
    }
    const std::size_t count = cell_.size();
    const float length = std::max(high_ - low_, std::numeric_limits<float>::min());
    const Cells buckets{
        .axis = swept_, .low = low_, .per_unit = static_cast<float>(count) / length, .count = count};
    starts_.assign(count + 1, 0);
    bool is_within = true;
    for (const Entry& entry : cell_) {
      ++starts_[buckets.of(entry.box.min[swept_]) + 1];
      is_within &= entry.box.min[swept_] >= low_ && entry.box.min[swept_] <= high_;
    }
    if (!is_within) {  // the buckets at the ends are wider than the others
      std::sort(cell_.begin(), cell_.end(), before);
      return 0;
    }
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    ordered_.resize(count);
    for (const Entry& entry : cell_) ordered_[starts_[buckets.of(entry.box.min[swept_])]++] = entry;
    std::swap(cell_, ordered_);
    return 1.01F / buckets.per_unit + 1e-6F * std::max(std::abs(low_), std::abs(high_));
  }

  void sweep_boxes(float slack, PairSink& pairs) {
    const std::size_t count = cell_.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Entry& a = cell_[i];
      const float last = a.box.max[swept_] + slack;
      write(
          pairs, i + 1, count, a.id, [&](std::size_t j) { return cell_[j].box.min[swept_] <= last; },
          [&](std::size_t j) {
            const Entry& b = cell_[j];
            if (!design_.branch_free) return (a.dedup_mask & b.dedup_mask) == 0 && overlap(a.box, b.box);
            bool hit = (a.dedup_mask & b.dedup_mask) == 0;
            for (int axis = 0; axis < D; ++axis) {
              hit &= a.box.min[axis] <= b.box.max[axis];
              hit &= b.box.min[axis] <= a.box.max[axis];
            }
            return hit;
          },
          [&](std::size_t j) { return cell_[j].id; });
    }
  }

  void sweep_arrays(const kernels::Run<D>& run, PairSink& pairs) {
    for (std::size_t i = 0; i < run.size; ++i) {
      const float last = run.max[0][i] + run.slack;
      write(
          pairs, i + 1, run.size, run.id[i], [&](std::size_t j) { return run.min[0][j] <= last; },
          [&](std::size_t j) {
            bool hit = (run.dedup_mask[i] & run.dedup_mask[j]) == 0;
            for (int axis = 0; axis < D; ++axis) {
              if (!design_.branch_free && !hit) return false;
              hit &= run.min[axis][i] <= run.max[axis][j];
              hit &= run.min[axis][j] <= run.max[axis][i];
            }
            return hit;
          },
          [&](std::size_t j) { return run.id[j]; });
    }
  }

  /// Writes the hits from `begin` on, as long as `is_candidate`.
  template <typename IsCandidate, typename IsHit, typename IdOf>
  void write(PairSink& pairs, std::size_t begin, std::size_t end, BoxId id, const IsCandidate& is_candidate,
             const IsHit& is_hit, const IdOf& id_of) const {
    for (std::size_t j = begin; j < end && is_candidate(j);) {
      Pair* out = pairs.room(PairSink::max_room);
      const std::size_t stop = std::min(end, j + PairSink::max_room);
      std::size_t count = 0;
      for (; j < stop && is_candidate(j); ++j) {
        if (design_.branch_free) {
          out[count] = ordered(id, id_of(j));
          count += is_hit(j) ? 1 : 0;
        } else if (is_hit(j)) {
          out[count++] = ordered(id, id_of(j));
        }
      }
      pairs.commit(count);
    }
  }

  static Pair ordered(BoxId a, BoxId b) { return {std::min(a, b), std::max(a, b)}; }

  GridDesign design_;
  core::Sample<D> sample_;
  int swept_ = 0;
  float low_ = 0;
  float high_ = 0;
  Cells rows_;
  Cells columns_;
  std::size_t length_ = 1;  // cells in a row
  std::vector<std::size_t> begin_;
  std::vector<std::size_t> next_;
  std::vector<Entry> entries_;
  std::vector<std::vector<Entry>> up_;  // by column: what is carried to the next row
  std::vector<Entry> cell_;
  std::vector<Entry> ordered_;
  std::vector<std::size_t> starts_;
  kernels::RunBuffer<D> run_;
};

}  // namespace broadside::bench
