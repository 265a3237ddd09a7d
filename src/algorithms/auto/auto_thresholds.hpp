// The thresholds of auto's rules, in one table.
//
// Each is about where the measured times of two algorithms cross, over the generated scenes and the maps,
// with 16 to 1,000,000 boxes. `broadside compare` ends with how much slower auto was than the best choice;
// build/release/bench/worst searches for boxes on which auto does worst.
#pragma once

#include <cstddef>

namespace broadside::algorithm {

template <int D>
struct AutoThresholds {
  /// Up to this many boxes brute_force is the fastest.
  static constexpr std::size_t few_boxes = D == 2 ? 256 : 400;

  /// Also up to this many if at least `dense_pair_share` of all pairs overlap: reporting is then most of the
  /// work.
  static constexpr std::size_t few_boxes_in_one_place = 1000;
  static constexpr double dense_pair_share = 0.5;

  /// Up to this many boxes a grid takes longer to lay out than it saves over a tree, except for shapes for
  /// which a tree's bounds overlap, and for boxes of one size in 3D.
  static constexpr std::size_t boxes_for_cells = D == 2 ? 12'000 : 30'000;

  // The shapes for which a grid pays with fewer boxes, and the number from which it does.
  static constexpr double long_boxes = 4;  ///< a box's longest side over its shortest
  static constexpr std::size_t long_boxes_for_cells = D == 2 ? 4000 : 1000;
  static constexpr double uneven_boxes = 1.6;  ///< mean of the sides' squares over the square of their mean
  static constexpr std::size_t uneven_boxes_for_cells = D == 2 ? 3500 : 3000;
  static constexpr double very_uneven_boxes = 40;
  static constexpr std::size_t very_uneven_boxes_for_cells = 1000;
  static constexpr double of_one_size = 1.0001;  ///< the same ratio
  static constexpr double flat = 0.9;            ///< share of all pairs that overlap on some axis
  static constexpr std::size_t flat_boxes_for_cells = 1100;
  static constexpr double max_overlaps_for_shapes = 50;  ///< overlaps per box

  /// From this many boxes on, a tree suits boxes that would overlap many_overlaps others if axes were
  /// independent, but do not. On the generated stacks of plates, cells make five times the tests.
  static constexpr std::size_t stacked_boxes_for_a_tree = D == 2 ? 0 : 6000;

  /// Boxes form a line if at least `in_line` of all pairs overlap on every axis but one. Up to this many
  /// tests per box, a sweep along the line then beats a tree.
  static constexpr double tests_of_a_line = 16;
  static constexpr double in_line = 0.5;
  static constexpr std::size_t boxes_of_a_line = 800;

  /// Up to this many tests per box, a sweep along one axis beats all other algorithms.
  static constexpr double tests_of_a_good_axis = 4;

  /// From this many overlaps per box on, most tests in a cell find a pair, and inserting boxes into several
  /// cells only repeats tests.
  static constexpr double many_overlaps = D == 2 ? 6 : 200;

  /// From this OverlapEstimate::clustering() on, the cells that suit the clusters would be too many.
  static constexpr double clustered = D == 2 ? 2.2 : 3;

  /// Boxes of a sample are near if, on every axis, they begin within this share of its range.
  static constexpr float near = 1.0F / 16;

  /// Boxes in a sample.
  static constexpr std::size_t sampled_boxes = 96;
};

}  // namespace broadside::algorithm
