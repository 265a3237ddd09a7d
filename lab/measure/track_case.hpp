// Measures trackers: every contender over the same histories, frame by frame in turns, all events checked.
#pragma once

#include <span>
#include <vector>

#include "lab/measure/contest.hpp"
#include "lab/measure/histories.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// Times each update() of each history (one a seed of the case), but for the first, which is all change, and
/// checks the events of every one. Between two frames the contenders take turns. One measurement a contender,
/// in their order.
///
/// Throws Stopped. What a contender throws is its failure and no error.
template <int D, typename Real = float>
std::vector<Measurement> measure_track(const Case& of, Histories<D, Real> inputs, const Contest& contest);

}  // namespace broadside::lab
