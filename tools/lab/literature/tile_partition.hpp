// The boxes in each tile of a uniform grid, by class: the input of the joins of two_layer_grid.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"

#include "lab/literature/cut_axis.hpp"
#include "lab/literature/radix_sort.hpp"

namespace broadside::lab::literature {

/// A class of a tile's boxes: bit k is set if they begin before the tile on axis k. 0 is the authors' A; in
/// 2D, 1 is their C, 2 their B and 3 their D. Two classes are joined if they have no bit in common.
using BoxClass = unsigned;

template <int D>
inline constexpr BoxClass class_count = 1U << D;

constexpr BoxClass before_on(int axis) noexcept { return 1U << axis; }

template <int D>
struct TileReference {
  Box<D> box;
  std::uint32_t id;
};

/// The tiles over the boxes, row by row.
template <int D>
struct TileGrid {
  std::array<CutAxis, D> axes;

  std::size_t tiles() const noexcept {
    std::size_t count = 1;
    for (const CutAxis& axis : axes) count *= axis.cells;
    return count;
  }
};

/// The tiles that a box touches.
template <int D>
struct TileRange {
  std::array<std::size_t, D> first;
  std::array<std::size_t, D> last;

  TileRange(const TileGrid<D>& grid, const Box<D>& box) noexcept {
    for (int axis = 0; axis < D; ++axis) {
      first[axis] = grid.axes[axis].cell(box.min[axis]);
      last[axis] = std::max(first[axis], grid.axes[axis].cell(box.max[axis]));
    }
  }

  std::size_t count() const noexcept {
    std::size_t count = 1;
    for (int axis = 0; axis < D; ++axis) count *= last[axis] - first[axis] + 1;
    return count;
  }

  /// Calls `visit` with each tile's index and the box's class in it.
  template <typename Visit>
  void for_each(const TileGrid<D>& grid, const Visit& visit) const {
    visit_axis<D - 1>(grid, 0, 0, visit);
  }

 private:
  template <int Axis, typename Visit>
  void visit_axis(const TileGrid<D>& grid, std::size_t row, BoxClass of, const Visit& visit) const {
    for (std::size_t i = first[Axis]; i <= last[Axis]; ++i) {
      const std::size_t place = row * grid.axes[Axis].cells + i;
      const BoxClass here = of | (i > first[Axis] ? before_on(Axis) : 0);
      if constexpr (Axis == 0)
        visit(place, here);
      else
        visit_axis<Axis - 1>(grid, place, here, visit);
    }
  }
};

/// The references of a set, tile by tile, and within a tile class by class.
template <int D>
class TilePartition {
 public:
  using Run = std::span<const TileReference<D>>;

  void fill(const TileGrid<D>& grid, std::span<const Box<D>> boxes, std::uint32_t first_id) {
    ends_.assign(grid.tiles() * class_count<D> + 1, 0);
    for (const Box<D>& box : boxes)
      TileRange<D>(grid, box).for_each(
          grid, [this](std::size_t tile, BoxClass of) { ++ends_[tile * class_count<D> + of + 1]; });
    for (std::size_t run = 1; run < ends_.size(); ++run) ends_[run] += ends_[run - 1];
    references_.resize(ends_.back());
    // From here, ends_[run] is the position of the run's next reference; after the loop, it is the end of the
    // run.
    std::uint32_t id = first_id;
    for (const Box<D>& box : boxes) {
      const TileReference<D> reference{box, id++};
      TileRange<D>(grid, box).for_each(grid, [&](std::size_t tile, BoxClass of) {
        references_[ends_[tile * class_count<D> + of]++] = reference;
      });
    }
  }

  Run run(std::size_t tile, BoxClass of) const {
    return Run(references_).subspan(begin(tile, of), size(tile, of));
  }

  std::size_t size(std::size_t tile, BoxClass of) const {
    return ends_[tile * class_count<D> + of] - begin(tile, of);
  }

  /// Sorts the classes of a tile that will be joined with a class of `other`, on the sweep axis: by their
  /// minima, or by their maxima if they begin before the tile.
  void sort(std::size_t tile, const TilePartition& other) {
    for (BoxClass of = 0; of < class_count<D>; ++of) {
      if (size(tile, of) < 2 || !other.has_partner(tile, of)) continue;
      const auto references = std::span(references_).subspan(begin(tile, of), size(tile, of));
      if ((of & before_on(0)) == 0)
        std::ranges::sort(references, {},
                          [](const TileReference<D>& one) { return ordered(one.box.min[0]); });
      else
        std::ranges::sort(references, {},
                          [](const TileReference<D>& one) { return ordered(one.box.max[0]); });
    }
  }

 private:
  std::size_t begin(std::size_t tile, BoxClass of) const {
    const std::size_t run = tile * class_count<D> + of;
    return run == 0 ? 0 : ends_[run - 1];
  }

  bool has_partner(std::size_t tile, BoxClass of) const {
    for (BoxClass partner = 0; partner < class_count<D>; ++partner) {
      if ((partner & of) == 0 && size(tile, partner) > 0) return true;
    }
    return false;
  }

  std::vector<TileReference<D>> references_;
  std::vector<std::size_t> ends_;
};

}  // namespace broadside::lab::literature
