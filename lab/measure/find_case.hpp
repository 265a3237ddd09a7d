// Measures finders: every contender on the same boxes, in turns, each result checked.
#pragma once

#include <span>
#include <vector>

#include "lab/measure/contest.hpp"
#include "lab/measure/histories.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// Times one whole find() at a time, into a vector whose memory is there already, on the first boxes of each
/// input (one a seed of the case) in rotation, and checks every result. One measurement a contender, in their
/// order. The floor takes its turns among the contenders, where boxes are of floats.
///
/// Throws Stopped. What a contender throws is its failure and no error.
template <int D, typename Real = float>
CaseResult measure_find(const Case& of, Histories<D, Real> inputs, const Contest& contest);

}  // namespace broadside::lab
