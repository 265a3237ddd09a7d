// Pairs of boxes that lie within a distance of each other.
#pragma once

#include "broadside/pair.hpp"

#include "lab/join.hpp"

namespace broadside::lab {

/// Writes every pair of boxes between which the gap on each axis, 0 where they overlap on it, is at most
/// `distance`, which is finite and 0 or more. So it finds all pairs whose Euclidean distance is at most that,
/// and a few more, past corners. Exact: the gap of two coordinates is compared with the distance as the real
/// numbers that they are, unrounded. Otherwise as join.
void join_within(const AnyBoxes& boxes, double distance, const Contender& contender, PairSink& pairs);

/// Writes every such pair of a box of `left` and one of `right`, which match, likewise.
void join_within(const AnyBoxes& left, const AnyBoxes& right, double distance, const Contender& contender,
                 PairSink& pairs);

}  // namespace broadside::lab
