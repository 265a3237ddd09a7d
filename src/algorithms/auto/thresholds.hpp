// The thresholds of auto's rules, in one table.
//
// Each is about where the measured times of two algorithms cross, over the generated scenes and the maps,
// with 16 to 1,000,000 boxes. `broadside compare` ends with how near auto comes to the best of the others,
// and build/release/bench/worst looks for boxes where it comes least near.
#pragma once

#include <cstddef>

namespace broadside::algorithm {

template <int D>
struct AutoThresholds {
  /// Up to this many boxes brute_force is the fastest.
  static constexpr std::size_t few_boxes = D == 2 ? 256 : 400;

  /// And up to this many, where more than this part of all pairs overlaps: finding these is most of the work.
  static constexpr std::size_t few_boxes_in_one_place = 1000;
  static constexpr double most_pairs = 0.5;

  /// Up to this many boxes a grid takes longer to lay out than it saves over a tree, except for shapes for
  /// which a tree's bounds overlap, and for boxes of one size in 3D.
  static constexpr std::size_t boxes_for_cells = D == 2 ? 12'000 : 30'000;

  // The shapes for which a grid pays from fewer boxes on, and from how many.
  static constexpr double long_boxes = 4;  ///< a box's longest side over its shortest
  static constexpr std::size_t long_boxes_for_cells = D == 2 ? 4000 : 1000;
  static constexpr double uneven_boxes = 1.6;  ///< mean of the sides' squares over the square of their mean
  static constexpr std::size_t uneven_boxes_for_cells = D == 2 ? 3500 : 3000;
  static constexpr double very_uneven_boxes = 40;
  static constexpr std::size_t very_uneven_boxes_for_cells = 1000;
  static constexpr double of_one_size = 1.0001;  ///< the same ratio
  static constexpr double flat = 0.9;            ///< part of all pairs that overlaps on some axis
  static constexpr std::size_t flat_boxes_for_cells = 1100;
  static constexpr double max_overlaps_for_shapes = 50;  ///< overlaps a box

  /// From this many boxes on a tree suits those that would overlap many_overlaps others if axes were
  /// independent, and do not: of the generated stacks of plates cells make five times the tests.
  static constexpr std::size_t stacked_boxes_for_a_tree = D == 2 ? 0 : 6000;

  /// Boxes stand in a line where at least `in_line` of all pairs overlap on each other axis. Up to this many
  /// tests a box a sweep along the line then beats a tree.
  static constexpr double tests_of_a_line = 16;
  static constexpr double in_line = 0.5;
  static constexpr std::size_t boxes_of_a_line = 800;

  /// Up to this many tests a box, a sweep along one axis beats all others.
  static constexpr double tests_of_a_good_axis = 4;

  /// From this many overlaps a box on, most of what a cell tests is a pair, and inserting boxes into several
  /// cells only repeats tests.
  static constexpr double many_overlaps = D == 2 ? 6 : 200;

  /// Pairs of boxes near each other on all axes, over what the single axes let expect: from here on, the
  /// cells that suit the clusters would be too many.
  static constexpr double clustered = D == 2 ? 2.2 : 3;

  /// Boxes of a sample are near if they begin within this part of its range, on every axis.
  static constexpr float near = 1.0F / 16;

  /// Boxes in a sample.
  static constexpr std::size_t sampled_boxes = 96;
};

}  // namespace broadside::algorithm
