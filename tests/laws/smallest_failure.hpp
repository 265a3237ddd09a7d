// The equivalence test as GoogleTest assertions that report a small failing input.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"

#include "lab/scenes/scene.hpp"
#include "whole_frames.hpp"

namespace broadside::laws {

/// Success if a finder made from `spec` gives exactly the overlapping pairs of `boxes`; otherwise reports the
/// first difference, for a minimal subset of boxes that still fails.
template <int D>
testing::AssertionResult finds_the_pairs(const Algorithm& algorithm, const Spec& spec,
                                         std::vector<Box<D>> boxes);

/// Success if a tracker made from `spec` gives exactly the events of `history`; otherwise reports the first
/// difference, for a minimal sequence of steps and changes that still fails.
template <int D>
testing::AssertionResult tracks_the_pairs(const Algorithm& algorithm, const Spec& spec,
                                          lab::History<D> history);

/// Likewise of frames, with all that a tracker can be given: for few frames and boxes.
template <int D>
testing::AssertionResult tracks_the_frames(const Algorithm& algorithm, const Spec& spec,
                                           std::vector<WholeFrame<D>> frames);

}  // namespace broadside::laws
