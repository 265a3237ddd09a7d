// The hierarchical grid: a level of cells for each size of boxes, and a box in one cell only.
//
// After C. Ericson, "Real-Time Collision Detection" (2005), section 7.2, and B. Mirtich's and M. Overmars'
// use of it: since no box is filed twice, a box that moves is taken from one cell and put into another, or
// stays where it is. Made for motion; as a finder it is filed anew at each call.
#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "broadside/broad_phase.hpp"
#include "broadside/outline.hpp"

#include "algorithms/descriptions.hpp"
#include "algorithms/hierarchical_grid/cells.hpp"
#include "algorithms/hierarchical_grid/tracker.hpp"
#include "kernels/cell_blocks.hpp"

namespace broadside::own {
namespace {

template <int D>
class HierarchicalGrid final : public PairFinder<D>, public Outlined<D> {
 private:
  void find_valid(std::span<const Box<D>> boxes, PairSink& pairs) override {
    cells_.build(boxes, boxes);
    constexpr std::size_t batch = 64;
    std::array<core::MovedBox<D>, batch> queries;
    std::uint64_t tests = 0;
    for (std::size_t at = 0; at < boxes.size(); at += batch) {
      const std::size_t count = std::min(batch, boxes.size() - at);
      for (std::size_t i = 0; i < count; ++i)
        queries[i] = {.before = boxes[at + i],
                      .now = boxes[at + i],
                      .bounds = boxes[at + i],
                      .id = BoxId(at + i),
                      .was_present = true,
                      .is_present = true,
                      .filter_changed = false};
      tests += kernels::find_later<D>(cells_.view(), std::span(queries).first(count), pairs).tests;
    }
    this->count({.tests = tests, .references = boxes.size(), .cells = cells_.cells()});
  }

  /// The cells of each level that has boxes, the widest first; "6 / 46 boxes in 1 / 2 x 2 cells".
  Outline<D> lay_out(std::span<const Box<D>> boxes) override {
    cells_.build(boxes, boxes);
    const kernels::CellsView<D> view = cells_.view();
    Outline<D> outline;
    outline.kind = "cells";
    std::string boxes_of;
    std::string cells_of_levels;
    for (std::size_t i = view.levels.size(); i-- > 0;) {
      const kernels::CellLevel<D>& level = view.levels[i];
      if (level.boxes == 0) continue;
      const std::vector<Box<D>>& cells = outline.levels.emplace_back(cells_of(level));
      std::string count;
      for (const float last : level.last)
        count += (count.empty() ? "" : " x ") + std::to_string(static_cast<int>(last) + 1);
      const std::string separator = boxes_of.empty() ? "" : " / ";
      boxes_of += separator + std::to_string(level.boxes);
      cells_of_levels += separator + (cells.size() == 1 ? "1" : count);
    }
    outline.caption = boxes_of + (boxes.size() == 1 ? " box in " : " boxes in ") + cells_of_levels +
                      (outline.levels.back().size() == 1 ? " cell" : " cells");
    return outline;
  }

  static std::vector<Box<D>> cells_of(const kernels::CellLevel<D>& level) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::vector<Box<D>> cells;
    std::array<float, D> at{};
    do {
      Box<D> cell;
      for (int axis = 0; axis < D; ++axis) {
        const float border = level.low[axis] + at[axis] / level.inverse[axis];
        const float next = level.low[axis] + (at[axis] + 1) / level.inverse[axis];
        cell.min[axis] = at[axis] == 0 ? -infinity : border;
        cell.max[axis] = at[axis] == level.last[axis] ? infinity : next;
      }
      cells.push_back(cell);
      int axis = 0;
      while (axis < D && at[axis] == level.last[axis]) at[axis++] = 0;
      if (axis == D) return cells;
      ++at[axis];
    } while (true);
  }

  HierarchicalGridCells<D> cells_;
};

}  // namespace

Algorithm hierarchical_grid() {
  return {
      .name = "hierarchical_grid",
      .summary = "levels of cells, one for each size of boxes; made for boxes that move",
      .source = "C. Ericson, Real-Time Collision Detection (2005), 7.2",
      .finder_2d = [](const Settings&) { return std::make_unique<HierarchicalGrid<2>>(); },
      .finder_3d = [](const Settings&) { return std::make_unique<HierarchicalGrid<3>>(); },
      .tracker_2d = [](const Settings&) { return std::make_unique<HierarchicalGridTracker<2>>(); },
      .tracker_3d = [](const Settings&) { return std::make_unique<HierarchicalGridTracker<3>>(); },
  };
}

}  // namespace broadside::own
