// Histories with filters and ignored pairs, and the equivalence test of trackers on them as a GoogleTest
// assertion.
#pragma once

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"

#include "lab/scenes/scene.hpp"
#include "whole_frames.hpp"

namespace broadside::laws {

/// The history's frames.
template <int D>
std::vector<WholeFrame<D>> whole_frames(const lab::History<D>& history);

/// The same frames with filters and ignored pairs that are added, changed and removed, with and without
/// changes of boxes, and with sinks, some of which fail.
template <int D>
std::vector<WholeFrame<D>> with_filters(std::vector<WholeFrame<D>> frames, std::uint64_t seed);

/// Success if a tracker made from `spec` gives exactly the events of `frames`; otherwise reports the first
/// difference, for few frames and boxes.
template <int D>
testing::AssertionResult tracks_the_frames(const Algorithm& algorithm, const Spec& spec,
                                           std::vector<WholeFrame<D>> frames);

}  // namespace broadside::laws
