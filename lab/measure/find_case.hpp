// Measures finders: every algorithm on the same boxes, in rounds, each result checked.
#pragma once

#include <span>
#include <vector>

#include "lab/measure/benchmark.hpp"
#include "lab/measure/histories.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// Times one whole find() an entry and round, into a vector whose memory is there already. A round is on the
/// boxes that one input (one a seed of the case) begins with, and the inputs take turns; each entry takes
/// part in the first rounds, as many as the effort says, and every result is checked. One measurement a
/// contender, in their order. Where boxes are of floats, the floor takes part in every round.
///
/// Throws Stopped. What an algorithm throws is its failure and no error.
template <int D, typename Real = float>
CaseResult measure_find(const Case& measured, Histories<D, Real> inputs, const Benchmark& benchmark);

}  // namespace broadside::lab
