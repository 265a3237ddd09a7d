// What differs between the pairs of two frames.
#pragma once

#include <span>

#include "broadside/pair.hpp"
#include "broadside/tracker.hpp"

namespace broadside::core {

/// Writes what began and what ended, given `found`, all pairs that overlap now, and `kept`, all those that
/// held in the frame before and perhaps others, each once or more often.
///
/// Nothing is looked up in the other list: what a pair was in the other frame can be seen from its boxes; and
/// of two boxes that rested nothing has to be asked. Most pairs go on, so that is asked first.
template <int D, typename Real>
void report_differences(const Change<D, Real>& change, std::span<const Pair> found,
                        std::span<const Pair> kept, PairSink& begun, PairSink& ended);

}  // namespace broadside::core
