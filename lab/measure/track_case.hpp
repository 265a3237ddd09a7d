// Measures trackers: every algorithm over the same histories, frame by frame in turns, all events checked.
#pragma once

#include <span>
#include <vector>

#include "lab/measure/benchmark.hpp"
#include "lab/measure/histories.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// Times each update() of a history but for the first, in which all is new and which is timed apart. A round
/// is a pass over one input (one a seed of the case), and the inputs take turns; each entry takes part in the
/// first rounds, as many as the effort says. In a round the entries take turns frame by frame, and all events
/// are checked. One measurement a contender, in their order.
///
/// Throws Stopped. What an algorithm throws is its failure and no error.
template <int D, typename Real = float>
std::vector<Measurement> measure_track(const Case& measured, Histories<D, Real> inputs,
                                       const Benchmark& benchmark);

}  // namespace broadside::lab
