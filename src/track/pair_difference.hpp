// The difference between the pairs of two frames.
#pragma once

#include <cstddef>
#include <span>

#include "broadside/follower.hpp"
#include "broadside/pair.hpp"

#include "core/parallel.hpp"

namespace broadside::track {

/// Pairs that are tested in the time that a search takes for a box.
inline constexpr std::size_t pairs_per_box = 8;

/// Writes what began and what ended, given `found`, all pairs that overlap now, and `kept`, all those that
/// held in the frame before and perhaps others, each once or more often.
///
/// No pair is looked up in the other list: its boxes tell whether it was one in the other frame, and two
/// boxes at rest need no test. Most pairs go on, so that is tested first.
template <int D, typename Real>
void report_differences(const Change<D, Real>& change, std::span<const Pair> found,
                        std::span<const Pair> kept, core::Parallel& parallel, PairSink& begun,
                        PairSink& ended);

}  // namespace broadside::track
