// The grid ("spatial partitioning index") as in section III of paper.md: Algorithms 2 to 4.
// docs/paper/errata.md lists the corrections and their reasons.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "broadside/executor.hpp"
#include "broadside/searcher.hpp"

#include "paper/listings/world.hpp"

namespace broadside::paper {

/// The cells that a box is in: columns and rows, with the last ones included.
struct CellRange {
  std::size_t first_column;
  std::size_t last_column;
  std::size_t first_row;
  std::size_t last_row;

  bool operator==(const CellRange&) const = default;
};

/// Cells with references to the boxes that are in them.
class GridListing {
 public:
  /// `settings` must have the tunables of paper_grid.
  explicit GridListing(const Settings& settings);

  /// Algorithm 2 for these boxes, ignoring absent ones: empty cells.
  void initialize(std::span<const Box2> boxes);

  /// Algorithm 3, "Spanning Add Element", for all present boxes.
  void algorithm_3_spanning_add_element(std::span<const Box2> boxes);

  /// Algorithm 4, "SPI". Adds its tests to `statistics`, and counts them in the checkpoint.
  void algorithm_4_spi(std::span<const Box2> boxes, PairSink& pairs, Checkpoint& checkpoint,
                       Statistics& statistics);

  /// The cells that a present box is in.
  CellRange cells_of(const Box2& box) const {
    return {column(box.min[0]), column(box.max[0]), row(box.min[1]), row(box.max[1])};
  }

  std::size_t column(float x) const { return cell_of(x, world_.left, x_grids_); }
  std::size_t row(float y) const { return cell_of(y, world_.top, y_grids_); }

  std::vector<BoxId>& g(std::size_t column, std::size_t row) { return g_[column * rows() + row]; }
  std::span<std::vector<BoxId>> cells() noexcept { return g_; }
  std::size_t columns() const noexcept { return static_cast<std::size_t>(x_grids_); }
  std::size_t rows() const noexcept { return static_cast<std::size_t>(y_grids_); }
  double size() const noexcept { return size_; }
  const World& world() const noexcept { return world_; }

  std::size_t bytes() const noexcept;

  /// Whether a grid over `boxes` boxes may hold this many references (errata 2c and 3i); always true without
  /// a limit.
  bool may_hold(double references, std::size_t boxes) const;

 private:
  void algorithm_2_init(std::span<const Box2> boxes, double width, double height, double size);
  std::size_t cell_of(double x, double begin, double count) const;
  bool is_too_large(std::span<const Box2> boxes) const;

  WorldSettings world_settings_;
  double cell_;      // 0: chosen by the boxes
  bool is_limited_;  // by errata 2c and 3i
  World world_{};
  double size_ = 1;
  double x_grids_ = 1;
  double y_grids_ = 1;
  std::vector<std::vector<BoxId>> g_;
};

/// The number of references to a box in these cells.
inline std::size_t references(const CellRange& cells) {
  return (cells.last_column - cells.first_column + 1) * (cells.last_row - cells.first_row + 1);
}

}  // namespace broadside::paper
