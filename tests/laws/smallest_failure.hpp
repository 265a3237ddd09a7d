// The law as GoogleTest assertions that report a small input on which it fails.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"

#include "lab/scenes/scene.hpp"

namespace broadside::laws {

/// Success if a finder made from `spec` gives exactly the overlapping pairs of `boxes`; otherwise what
/// differs first, for as few of the boxes as the failure can be seen with.
template <int D>
testing::AssertionResult finds_the_pairs(const Algorithm& algorithm, const Spec& spec,
                                         std::vector<Box<D>> boxes);

/// Success if a tracker made from `spec` gives exactly the events of `history`; otherwise what differs first,
/// for as few steps and changes as the failure can be seen with.
template <int D>
testing::AssertionResult tracks_the_pairs(const Algorithm& algorithm, const Spec& spec,
                                          lab::History<D> history);

}  // namespace broadside::laws
