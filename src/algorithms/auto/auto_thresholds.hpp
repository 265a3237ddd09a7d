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
  /// Up to this many boxes brute_force is the fastest. WebAssembly compares only sixteen bytes at a time.
#ifdef __wasm__
  static constexpr std::size_t few_boxes = 64;
#else
  static constexpr std::size_t few_boxes = D == 2 ? 256 : 320;
#endif

  /// Up to this many, the grid needs no sample: they are one tile of it, however unevenly they are spread.
  static constexpr std::size_t boxes_of_a_tile = 4096;

  /// Up to this many they are one tile as well, unless they are too uneven for its cells: a tile holds no
  /// more.
  static constexpr std::size_t boxes_of_an_even_tile = D == 2 ? 32768 : 16384;

  /// Up to this many tests per box, a sweep along one axis beats all other algorithms.
  static constexpr double tests_of_a_good_axis = 4;

  /// The same where cells have been refused.
  static constexpr double tests_of_an_uneven_tiles_axis = 24;

  /// From this share of all pairs on that overlap, separating boxes gains nothing.
  static constexpr double dense_pair_share = 0.5;

  /// From this many overlaps per box on, most tests in a cell find a pair, and inserting boxes into several
  /// cells only repeats tests.
  static constexpr double many_overlaps = D == 2 ? 6 : 200;

  /// The same where the boxes are one tile of the grid.
  static constexpr double many_overlaps_in_a_tile = D == 2 ? 16 : 200;

  /// Up to this share of the boxes in one of two sets, most of the others end their search high up in a tree.
  static constexpr double share_of_a_small_set = 0.25;

  /// From this clustering() on, the cells that suit the clusters would be too many.
  static constexpr double clustered = D == 2 ? 2.2 : 3;

  /// Boxes of a sample are near if, on every axis, they begin within this share of its range.
  static constexpr float near = 1.0F / 16;

  /// Boxes in a sample.
  static constexpr std::size_t sampled_boxes = 96;

  /// Boxes whose hash decides where the sample begins.
  static constexpr std::size_t hashed_boxes = 32;
};

}  // namespace broadside::algorithm
