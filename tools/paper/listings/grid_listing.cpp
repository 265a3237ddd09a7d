// Algorithms 2 to 4 of paper.md, corrected.
#include "paper/listings/grid_listing.hpp"

#include <algorithm>
#include <cmath>
#include <new>

#include "kernels/observed_tests.hpp"
#include "paper/listings/algorithm_1.hpp"

namespace broadside::paper {
namespace {

/// The maximum for any grid, including one with a cell size set by the user.
double max_cells(double boxes) { return std::clamp<double>(16 * boxes, 1 << 16, 1 << 22); }
double max_references(double boxes) { return std::max<double>(64 * boxes, 1 << 18); }

/// The maximum for a grid that chooses its cell size: beyond that, cells and references cost more than they
/// save.
double max_auto_cells(double boxes) { return std::min<double>(4 * boxes, 1 << 22); }
double max_auto_references(double boxes) { return 16 * boxes; }

double count_present(std::span<const Box2> boxes) {
  return static_cast<double>(
      std::count_if(boxes.begin(), boxes.end(), [](const Box2& box) { return is_present(box); }));
}

/// Twice the mean finite extent; if boxes have none, the size that gives each its own cell.
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
  return std::max(world.width, world.height) / std::sqrt(std::max(1.0, count_present(boxes)));
}

}  // namespace

GridListing::GridListing(const Settings& settings)
    : world_settings_(settings),
      cell_(settings.optional_number("cell").value_or(0)),
      is_limited_(settings.text("limit") == "memory") {}

void GridListing::initialize(std::span<const Box2> boxes) {
  world_ = world_settings_.around(boxes);
  algorithm_2_init(boxes, world_.width, world_.height, cell_ > 0 ? cell_ : choose_size(boxes, world_));
}

/// Algorithm 2, "Initialize".
void GridListing::algorithm_2_init(std::span<const Box2> boxes, double width, double height, double size) {
  const auto divide = [&](double by) {
    size_ = by;
    x_grids_ = std::max(1.0, std::ceil(width / by));
    y_grids_ = std::max(1.0, std::ceil(height / by));
  };
  divide(size);
  while (is_too_large(boxes)) divide(2 * size_);  // Errata 2c and 3i
  if (!(x_grids_ * y_grids_ <= static_cast<double>(g_.max_size()))) throw std::bad_alloc();
  g_.resize(static_cast<std::size_t>(x_grids_ * y_grids_));  // Erratum 2a
  for (std::vector<BoxId>& cell : g_) cell.clear();
}

void GridListing::algorithm_3_spanning_add_element(std::span<const Box2> boxes) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {  // Erratum 3a
    const Box2& e = boxes[i];
    if (!is_present(e)) continue;
    const CellRange cells = cells_of(e);
    for (std::size_t r = cells.first_row; r <= cells.last_row; ++r) {          // Errata 3b, 3c and 3d
      for (std::size_t c = cells.first_column; c <= cells.last_column; ++c) {  // Errata 3b, 3c and 3d
        g(c, r).push_back(BoxId(i));                                           // Erratum 3h
      }
    }
  }
}

void GridListing::algorithm_4_spi(std::span<const Box2> boxes, PairSink& pairs, Checkpoint& checkpoint,
                                  Statistics& statistics) {
  for (std::size_t i = 0; i < columns(); ++i) {  // Errata 4a and 4c
    for (std::size_t j = 0; j < rows(); ++j) {   // Errata 4a and 4c
      statistics.references += g(i, j).size();
      algorithm_1_brute_force(g(i, j), checkpoint, [&](BoxId a, BoxId b) {
        ++statistics.tests;
        if constexpr (kernels::is_observing) kernels::observe_test(a, b);
        const Box2& first = boxes[index(a)];
        const Box2& second = boxes[index(b)];
        if (!overlap(first, second)) return;
        const bool here = column(std::max(first.min[0], second.min[0])) == i &&
                          row(std::max(first.min[1], second.min[1])) == j;
        if (here) pairs.add(a, b);  // Erratum 4b
      });
    }
  }
}

/// The index of the cell, among `count` cells, that contains `x`. Monotonic in x and defined for every x:
/// coordinates outside the world are in the cell at its border.
std::size_t GridListing::cell_of(double x, double begin, double count) const {
  const double cell = std::floor((x - begin) / size_);                      // Errata 2b and 3e
  return static_cast<std::size_t>(std::clamp<double>(cell, 0, count - 1));  // Errata 3f and 3g
}

std::size_t GridListing::bytes() const noexcept {
  std::size_t bytes = g_.capacity() * sizeof(std::vector<BoxId>);
  for (const std::vector<BoxId>& cell : g_) bytes += cell.capacity() * sizeof(BoxId);
  return bytes;
}

bool GridListing::may_hold(double references, std::size_t boxes) const {
  if (!is_limited_) return true;
  const auto count = static_cast<double>(boxes);
  return references <= (cell_ == 0 ? max_auto_references(count) : max_references(count));
}

/// Whether a grid of this size would exceed the limit on cells or references.
bool GridListing::is_too_large(std::span<const Box2> boxes) const {
  if (!is_limited_) return false;
  const double count = count_present(boxes);
  if (x_grids_ * y_grids_ > std::max(1.0, cell_ == 0 ? max_auto_cells(count) : max_cells(count))) return true;
  double sum = 0;
  for (const Box2& e : boxes) {
    if (is_present(e)) sum += static_cast<double>(references(cells_of(e)));
  }
  return !may_hold(sum, static_cast<std::size_t>(count));
}

}  // namespace broadside::paper
