// The costs of finding and following by algorithm: the tuned numbers of track::FollowPolicy, in one table.
//
// In nanoseconds of one machine; only ratios within an algorithm matter. `build/release/bench/motion ways`
// shows the result: auto over the better of following and finding anew, with 0.1 to 100 % of the boxes moving
// (and a line per algorithm with --algorithms). Measured with 10,000 to 100,000 boxes, uniform, mixed and
// clustered. Finding anew is no slower once this share of the boxes moves: 0.45 for brute force, 0.3 (2D) and
// 0.2 (3D) for trees, 0.25 for cells, about 500 / (4000 + tests) for a sweep.
#pragma once

#include "broadside/algorithm.hpp"

namespace broadside::algorithm {

inline constexpr FindCosts brute_force_finding = {.box = 40};
inline constexpr FollowCosts brute_force_following = {
    .start = 1, .mover = 65, .mover_alone = 30, .test = 0.55, .further_test = 0.55};

/// Up to this many boxes, comparing each mover with all others costs less than keeping cells.
inline constexpr std::size_t boxes_for_brute_force = 320;

/// Also the cost of auto's searches.
template <int D>
inline constexpr FindCosts grid_finding = {.box = D == 2 ? 32.0 : 62.0};
template <int D>
inline constexpr FollowCosts grid_following = {.start = D == 2 ? 15 : 18,
                                               .mover = D == 2 ? 110 : 140,
                                               .mover_alone = D == 2 ? 110 : 140,
                                               .test = 1.8,
                                               .further_test = 0.8};

template <int D>
inline constexpr FindCosts sweep_finding = {.box = D == 2 ? 40.0 : 65.0, .further_test = 0.1};
template <int D>
inline constexpr FollowCosts sweep_following = {.start = 50,
                                                .mover = D == 2 ? 340 : 560,
                                                .mover_alone = D == 2 ? 320 : 520,
                                                .test = 0.08,
                                                .further_test = 0.08};

template <int D>
inline constexpr FindCosts tree_finding = {.box = D == 2 ? 40.0 : 65.0};
template <int D>
inline constexpr FollowCosts quadtree_following = {.start = 100,
                                                   .mover = D == 2 ? 133 : 325,
                                                   .mover_alone = D == 2 ? 80 : 200,
                                                   .test = 1.2,
                                                   .further_test = 1.2};
template <int D>
inline constexpr FollowCosts bvh_following = {.start = 100,
                                              .mover = D == 2 ? 160 : 250,
                                              .mover_alone = D == 2 ? 138 : 215,
                                              .test = 0.9,
                                              .further_test = 0.9};

/// The costs of trees to auto, which finds anew by the cheapest algorithm: trees pay where the grid's cells
/// make about 500 tests per mover. Measured with 50,000 boxes, 1 % moving, in stacks of plates, lines and
/// clusters.
inline constexpr FollowCosts quadtree_following_for_auto = {
    .start = 300, .mover = 600, .mover_alone = 300, .test = 2, .further_test = 2};
inline constexpr FollowCosts bvh_following_for_auto = {
    .start = 100, .mover = 600, .mover_alone = 300, .test = 0.9, .further_test = 0.9};

}  // namespace broadside::algorithm
