// The grid ("spatial partitioning index") as section III of paper.md has it: Algorithms 2 to 4. What was
// mended, and why, is in docs/paper/errata.md.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include "broadside/broad_phase.hpp"
#include "broadside/outline.hpp"

#include "paper/listings/algorithm_1.hpp"
#include "paper/listings/descriptions.hpp"
#include "paper/listings/world.hpp"

namespace broadside::paper {
namespace {

/// The most that any grid may hold, also one whose cell the user has set.
double most_cells(double boxes) { return std::clamp<double>(16 * boxes, 1 << 16, 1 << 22); }
double most_references(double boxes) { return std::max<double>(64 * boxes, 1 << 18); }

/// The most in a grid that chooses its cell: beyond that, cells and references cost more than they save.
double most_auto_cells(double boxes) { return std::min<double>(4 * boxes, 1 << 22); }
double most_auto_references(double boxes) { return 16 * boxes; }

/// Of more cells, an outline has only those that a box is in.
constexpr double most_drawn = 1 << 16;

/// The number of the cell, of `count` cells, in which `x` lies. Rises with x, and is defined for every x:
/// what lies outside the world is in the cell at its border.
std::size_t cell_of(double x, double begin, double size, double count) {
  const double cell = std::floor((x - begin) / size);                       // Errata 2b and 3e
  return static_cast<std::size_t>(std::clamp<double>(cell, 0, count - 1));  // Errata 3f and 3g
}

/// Twice the mean finite extent; where the boxes have none, what gives each a cell of its own.
double choose_size(std::span<const Box2> boxes, const World& world) {
  double sum = 0;
  double count = 0;
  for (const Box2& box : boxes) {
    for (int axis = 0; axis < 2; ++axis) {
      const double extent = double{box.max[axis]} - double{box.min[axis]};
      if (!std::isfinite(extent)) continue;
      sum += extent;
      count += 1;
    }
  }
  if (sum > 0) return 2 * sum / count;
  return std::max(world.width, world.height) / std::sqrt(static_cast<double>(boxes.size()));
}

class Grid final : public PairFinder<2>, public Outlined<2> {
 public:
  explicit Grid(const Settings& settings)
      : world_settings_(settings), cell_(settings.is_auto("cell") ? 0 : settings.number("cell")) {}

 private:
  void find_valid(std::span<const Box2> boxes, PairSink& pairs) override {
    statistics_ = {};
    if (!boxes.empty()) {
      initialize(boxes);
      algorithm_3_spanning_add_element();
      algorithm_4_spi(pairs);
    }
    this->count(statistics_);
  }

  void initialize(std::span<const Box2> boxes) {
    boxes_ = boxes;
    world_ = world_settings_.around(boxes);
    algorithm_2_init(world_.width, world_.height, cell_ > 0 ? cell_ : choose_size(boxes, world_));
  }

  /// Every cell or, of very many, those that a box is in.
  Outline<2> lay_out(std::span<const Box2> boxes) override {
    initialize(boxes);
    const bool all = x_grids_ * y_grids_ <= most_drawn;
    if (!all) algorithm_3_spanning_add_element();
    const auto columns = static_cast<std::size_t>(x_grids_);
    const auto rows = static_cast<std::size_t>(y_grids_);
    Outline<2> outline;
    outline.kind = "cells";
    outline.levels.resize(1);
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t c = 0; c < columns; ++c) {
        if (!all && g(c, r).empty()) continue;
        const auto [left, right] = ends(c, columns, world_.left, 0);
        const auto [top, bottom] = ends(r, rows, world_.top, 1);
        outline.levels[0].push_back({{left, top}, {right, bottom}});
      }
    }
    std::ostringstream caption;
    caption << columns << " x " << rows << (rows == 1 ? " cell of " : " cells of ") << std::setprecision(3)
            << size_;
    outline.caption = caption.str();
    return outline;
  }

  /// Where a cell begins and ends on an axis. One at the world's border goes on without end where boxes do.
  std::pair<float, float> ends(std::size_t cell, std::size_t count, double origin, int axis) const {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const auto begin = static_cast<float>(origin + static_cast<double>(cell) * size_);
    const auto end = static_cast<float>(origin + static_cast<double>(cell + 1) * size_);
    const bool before =
        cell == 0 && std::ranges::any_of(boxes_, [&](const Box2& e) { return e.min[axis] < begin; });
    const bool beyond =
        cell + 1 == count && std::ranges::any_of(boxes_, [&](const Box2& e) { return e.max[axis] > end; });
    return {before ? -infinity : begin, beyond ? infinity : end};
  }

  /// Algorithm 2, "Initialize".
  void algorithm_2_init(double width, double height, double size) {
    const auto divide = [&](double by) {
      size_ = by;
      x_grids_ = std::max(1.0, std::ceil(width / by));
      y_grids_ = std::max(1.0, std::ceil(height / by));
    };
    divide(size);
    while (too_large()) divide(2 * size_);                     // Errata 2c and 3i
    g_.resize(static_cast<std::size_t>(x_grids_ * y_grids_));  // Erratum 2a
    for (std::vector<BoxId>& cell : g_) cell.clear();
  }

  /// Algorithm 3, "Spanning Add Element".
  void algorithm_3_spanning_add_element() {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {  // Erratum 3a
      const Box2& e = boxes_[i];
      const std::size_t last_row = row(e.max[1]);
      const std::size_t last_col = column(e.max[0]);
      for (std::size_t r = row(e.min[1]); r <= last_row; ++r) {       // Errata 3b, 3c and 3d
        for (std::size_t c = column(e.min[0]); c <= last_col; ++c) {  // Errata 3b, 3c and 3d
          g(c, r).push_back(BoxId(i));                                // Erratum 3h
          ++statistics_.references;
        }
      }
    }
  }

  /// Algorithm 4, "SPI".
  void algorithm_4_spi(PairSink& pairs) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(x_grids_); ++i) {    // Errata 4a and 4c
      for (std::size_t j = 0; j < static_cast<std::size_t>(y_grids_); ++j) {  // Errata 4a and 4c
        algorithm_1_brute_force(g(i, j), [&](BoxId a, BoxId b) {
          ++statistics_.tests;
          const Box2& first = boxes_[index(a)];
          const Box2& second = boxes_[index(b)];
          if (!overlap(first, second)) return;
          const bool here = column(std::max(first.min[0], second.min[0])) == i &&
                            row(std::max(first.min[1], second.min[1])) == j;
          if (here) pairs.add(a, b);  // Erratum 4b
        });
      }
    }
  }

  /// Whether the grid of this size has more cells, or would hold more references, than it may.
  bool too_large() const {
    const auto boxes = static_cast<double>(boxes_.size());
    const bool chosen = cell_ == 0;
    if (x_grids_ * y_grids_ > (chosen ? most_auto_cells(boxes) : most_cells(boxes))) return true;
    double references = 0;
    for (const Box2& e : boxes_) {
      references += static_cast<double>(column(e.max[0]) - column(e.min[0]) + 1) *
                    static_cast<double>(row(e.max[1]) - row(e.min[1]) + 1);
    }
    return references > (chosen ? most_auto_references(boxes) : most_references(boxes));
  }

  std::size_t column(float x) const { return cell_of(x, world_.left, size_, x_grids_); }
  std::size_t row(float y) const { return cell_of(y, world_.top, size_, y_grids_); }
  std::vector<BoxId>& g(std::size_t c, std::size_t r) {
    return g_[c * static_cast<std::size_t>(y_grids_) + r];
  }

  WorldSettings world_settings_;
  double cell_;  // 0: to be chosen

  std::span<const Box2> boxes_;
  World world_{};
  double size_ = 1;
  double x_grids_ = 1;
  double y_grids_ = 1;
  std::vector<std::vector<BoxId>> g_;
  Statistics statistics_;
};

}  // namespace

Algorithm grid() {
  std::vector<Tunable> tunables = {{
      .name = "cell",
      .summary = "side of a cell, in the coordinates' unit; doubled while the grid would be too large for "
                 "memory (errata 2c and 3i)",
      .standard = "auto",
      .least = std::numeric_limits<float>::min(),
      .most = std::numeric_limits<float>::max(),
  }};
  for (Tunable& tunable : world_tunables()) tunables.push_back(std::move(tunable));
  return {
      .name = "paper_grid",
      .summary = "a uniform grid with brute force in each cell, as the paper lists it, mended; 2D only",
      .source = "paper.md, section III, Algorithms 2 to 4",
      .kind = AlgorithmKind::paper,
      .tunables = std::move(tunables),
      .finder_2d = [](const Settings& settings) { return std::make_unique<Grid>(settings); },
  };
}

}  // namespace broadside::paper
