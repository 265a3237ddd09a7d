// The algorithm of `grid` written plainly, so that each optimisation can be left out separately.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "broadside/finder.hpp"

#include "paper/plain/plain.hpp"

namespace broadside::plain {
namespace {

/// Cells of one width along an axis. Coordinates beyond the first or last cell count as in it.
struct Cells {
  int axis = 0;
  float low = 0;
  float per_unit = 0;
  std::size_t count = 1;
  std::vector<float> borders{};  // the minimum coordinate of each cell but the first, and NaN

  Cells() : borders{std::numeric_limits<float>::quiet_NaN()} {}

  Cells(int cut_axis, float begin, float end, float min_width, double max_cells)
      : axis(cut_axis), low(begin) {
    const float length = end - begin;
    if (length > 0 && length <= std::numeric_limits<float>::max()) {
      const double fitting = min_width > 0 ? static_cast<double>(length) / min_width : max_cells;
      count = static_cast<std::size_t>(std::clamp(fitting, 1.0, std::max(1.0, max_cells)));
      per_unit = static_cast<float>(count) / length;
    }
    for (std::size_t cell = 1; cell < count; ++cell) {
      constexpr float infinity = std::numeric_limits<float>::infinity();
      float border = low + static_cast<float>(cell) / per_unit;
      while (of(border) >= cell) border = std::nextafter(border, -infinity);
      while (of(border) < cell) border = std::nextafter(border, infinity);
      borders.push_back(border);
    }
    borders.push_back(std::numeric_limits<float>::quiet_NaN());
  }

  std::size_t of(float coordinate) const {
    const float cell = (coordinate - low) * per_unit;
    return cell > 0 ? static_cast<std::size_t>(std::min(cell, static_cast<float>(count - 1))) : 0;
  }
};

template <int D>
struct PlainCellEntry {
  Box<D> box;
  BoxId id;
  std::uint32_t dedup_mask;  // a bit for each axis on which the box begins in an earlier cell
};

/// A cell's boxes as one array.
template <int D>
struct EntryArray {
  std::span<const PlainCellEntry<D>> entries;

  std::size_t size() const { return entries.size(); }
  float min(std::size_t i, int axis) const { return entries[i].box.min[axis]; }
  float max(std::size_t i, int axis) const { return entries[i].box.max[axis]; }
  BoxId id(std::size_t i) const { return entries[i].id; }
  std::uint32_t dedup_mask(std::size_t i) const { return entries[i].dedup_mask; }
};

/// A cell's boxes as an array for each bound.
template <int D>
struct BoundArrays {
  std::array<std::vector<float>, D> mins;
  std::array<std::vector<float>, D> maxs;
  std::vector<BoxId> ids;
  std::vector<std::uint32_t> dedup_masks;

  void fill(std::span<const PlainCellEntry<D>> entries) {
    for (int axis = 0; axis < D; ++axis) {
      mins[axis].resize(entries.size());
      maxs[axis].resize(entries.size());
    }
    ids.resize(entries.size());
    dedup_masks.resize(entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) {
      for (int axis = 0; axis < D; ++axis) {
        mins[axis][i] = entries[i].box.min[axis];
        maxs[axis][i] = entries[i].box.max[axis];
      }
      ids[i] = entries[i].id;
      dedup_masks[i] = entries[i].dedup_mask;
    }
  }

  std::size_t size() const { return ids.size(); }
  float min(std::size_t i, int axis) const { return mins[axis][i]; }
  float max(std::size_t i, int axis) const { return maxs[axis][i]; }
  BoxId id(std::size_t i) const { return ids[i]; }
  std::uint32_t dedup_mask(std::size_t i) const { return dedup_masks[i]; }
};

template <int D>
class PlainGrid final : public Searcher<D> {
 public:
  explicit PlainGrid(const Settings& settings)
      : samples_(settings.text("sample") == "yes"),
        carries_(settings.text("carry") == "yes"),
        uses_buckets_(settings.text("buckets") == "yes"),
        uses_arrays_(settings.text("arrays") == "yes"),
        branch_free_(settings.text("branch_free") == "yes") {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    statistics_ = {};
    if (!input.boxes.empty()) {
      choose_cells(input.boxes);
      insert(input.boxes);
      up_.resize(columns_.count);
      for (std::vector<Entry>& list : up_) list.clear();
      for (std::size_t cell = 0; cell + 1 < begin_.size(); ++cell) {
        gather(cell);
        sweep(pairs);
      }
    }
    return statistics_;
  }

 private:
  using Entry = PlainCellEntry<D>;

  void choose_cells(std::span<const Box<D>> boxes) {
    shape_ = shape_of(boxes, samples_);
    // Without a sample, the draft's choice: the first axis.
    swept_ = samples_ ? shape_.best_axis() : 0;
    const double max_cells = std::pow(static_cast<double>(boxes.size()), 1.0 / (D - 1));
    const auto cut = [&](int axis) {
      return Cells(axis, shape_.low[axis], shape_.high[axis], 2 * shape_.extent[axis], max_cells);
    };
    rows_ = cut((swept_ + 1) % D);
    columns_ = D == 3 ? cut((swept_ + 2) % D) : Cells();
  }

  /// Calls `visit` with each cell that the box belongs to, and its dedup_mask there.
  template <typename Visit>
  void for_each_cell(const Box<D>& box, const Visit& visit) const {
    const std::size_t row = rows_.of(box.min[rows_.axis]);
    const std::size_t column = columns_.of(box.min[columns_.axis]);
    if (carries_) return visit(row * columns_.count + column, 0U);
    const std::size_t last_row = rows_.of(box.max[rows_.axis]);
    const std::size_t last_column = columns_.of(box.max[columns_.axis]);
    for (std::size_t r = row; r <= last_row; ++r) {
      for (std::size_t c = column; c <= last_column; ++c)
        visit(r * columns_.count + c, (r > row ? row_bit : 0U) | (c > column ? column_bit : 0U));
    }
  }

  /// Puts the boxes into their cells, by counting sort.
  void insert(std::span<const Box<D>> boxes) {
    begin_.assign(rows_.count * columns_.count + 1, 0);
    for (const Box<D>& box : boxes)
      for_each_cell(box, [this](std::size_t cell, std::uint32_t) { ++begin_[cell + 1]; });
    for (std::size_t cell = 1; cell < begin_.size(); ++cell) begin_[cell] += begin_[cell - 1];
    next_.assign(begin_.begin(), begin_.end());
    entries_.resize(begin_.back());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for_each_cell(boxes[i], [&](std::size_t cell, std::uint32_t mask) {
        entries_[next_[cell]++] = {boxes[i], static_cast<BoxId>(i), mask};
      });
    }
  }

  /// Sets cell_ to the boxes of a cell: those that begin there and those carried there. Carries on the boxes
  /// that extend further.
  void gather(std::size_t cell) {
    const std::span<const Entry> inserted =
        std::span(entries_).subspan(begin_[cell], begin_[cell + 1] - begin_[cell]);
    cell_.assign(inserted.begin(), inserted.end());
    if (carries_) {
      const std::size_t column = cell % columns_.count;
      if (column > 0) cell_.insert(cell_.end(), along_.begin(), along_.end());
      if (D == 3) carry(columns_.axis, columns_.borders[column], column_bit, along_);
      cell_.insert(cell_.end(), up_[column].begin(), up_[column].end());
      carry(rows_.axis, rows_.borders[cell / columns_.count], row_bit, up_[column]);
    }
    statistics_.references += cell_.size();
  }

  /// Sets `to` to the boxes of cell_ that reach the border. Writes every box, and keeps it if it does.
  void carry(int axis, float border, std::uint32_t bit, std::vector<Entry>& to) {
    to.resize(cell_.size() + 1);
    std::size_t count = 0;
    for (const Entry& entry : cell_) {
      to[count] = entry;
      to[count].dedup_mask |= bit;
      count += entry.box.max[axis] >= border ? 1 : 0;
    }
    to.resize(count);
  }

  void sweep(PairSink& pairs) {
    if (cell_.size() < 2) return;
    const float slack = order();
    if (uses_arrays_) {
      arrays_.fill(cell_);
      sweep(arrays_, slack, pairs);
    } else {
      sweep(EntryArray<D>{cell_}, slack, pairs);
    }
  }

  /// Sorts cell_ along the swept axis; returns the maximum distance by which a box may begin before an
  /// earlier one.
  float order() {
    const auto before = [this](const Entry& a, const Entry& b) {
      return a.box.min[swept_] < b.box.min[swept_];
    };
    const float low = shape_.low[swept_];
    const float high = shape_.high[swept_];
    const float length = high - low;
    // The buckets at the ends hold boxes outside the sample's range, and are wider than the others.
    const auto is_between = [&](const Entry& entry) {
      return entry.box.min[swept_] >= low && entry.box.min[swept_] <= high;
    };
    if (!uses_buckets_ || !(length > 0 && length <= std::numeric_limits<float>::max()) ||
        !std::ranges::all_of(cell_, is_between)) {
      std::ranges::sort(cell_, before);
      return 0;
    }
    const std::size_t count = cell_.size();
    const float per_unit = static_cast<float>(count) / length;
    const auto bucket_of = [&](const Entry& entry) {
      return static_cast<std::size_t>(
          std::min((entry.box.min[swept_] - low) * per_unit, static_cast<float>(count - 1)));
    };
    starts_.assign(count + 1, 0);
    for (const Entry& entry : cell_) ++starts_[bucket_of(entry) + 1];
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    ordered_.resize(count);
    for (const Entry& entry : cell_) ordered_[starts_[bucket_of(entry)]++] = entry;
    std::swap(cell_, ordered_);
    // A bucket's width, plus rounding errors.
    return 1.01F / per_unit + 1e-6F * std::max(std::abs(low), std::abs(high));
  }

  template <typename Boxes>
  void sweep(const Boxes& boxes, float slack, PairSink& pairs) {
    const std::size_t size = boxes.size();
    for (std::size_t i = 0; i + 1 < size; ++i) {
      const float last = boxes.max(i, swept_) + slack;
      const BoxId id = boxes.id(i);
      const std::uint32_t mask = boxes.dedup_mask(i);
      std::size_t end = i + 1;
      while (end < size && boxes.min(end, swept_) <= last) ++end;
      statistics_.tests += end - i - 1;
      for (std::size_t begin = i + 1; begin < end; begin += max_at_once) {
        const std::size_t count = write_hits(
            branch_free_, begin, std::min(end, begin + max_at_once), pairs.room(PairSink::max_room),
            [&](std::size_t j) {
              return overlap_at<D>(branch_free_, boxes, i, boxes, j) && (mask & boxes.dedup_mask(j)) == 0;
            },
            [&](std::size_t j) { return ordered_pair(id, boxes.id(j)); });
        pairs.commit(count);
      }
    }
  }

  static constexpr std::uint32_t row_bit = 1;
  static constexpr std::uint32_t column_bit = 2;
  static constexpr std::size_t max_at_once = PairSink::max_room - 1;

  bool samples_;
  bool carries_;
  bool uses_buckets_;
  bool uses_arrays_;
  bool branch_free_;
  Statistics statistics_;
  Shape<D> shape_;
  int swept_ = 0;
  Cells rows_;
  Cells columns_;
  std::vector<std::size_t> begin_;
  std::vector<std::size_t> next_;
  std::vector<Entry> entries_;
  std::vector<Entry> along_;            // boxes carried to the next cell of the row
  std::vector<std::vector<Entry>> up_;  // by column: boxes carried to the next row
  std::vector<Entry> cell_;
  std::vector<Entry> ordered_;
  std::vector<std::size_t> starts_;
  BoundArrays<D> arrays_;
};

}  // namespace

Algorithm plain_grid() {
  return {
      .name = "plain_grid",
      .summary = "the algorithm of grid, written plainly",
      .source = "for the paper's ablation",
      .kind = AlgorithmKind::literature,
      .tunables = {switch_tunable("sample", "whether the swept axis and the cells are chosen by a sample"),
                   switch_tunable("carry", "whether a box is put into one cell and carried on to others"),
                   switch_tunable("buckets", "whether a cell's boxes are ordered by a counting sort"),
                   switch_tunable("arrays", "whether a cell's boxes are an array for each bound"),
                   switch_tunable("branch_free", "whether pairs are written without a branch")},
      .in_2d = {.searcher = make_strategy<PlainGrid<2>>},
      .in_3d = {.searcher = make_strategy<PlainGrid<3>>},
      .limits = {.infinite_boxes = false}};
}

}  // namespace broadside::plain
