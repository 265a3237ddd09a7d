// find_pairs: all overlapping pairs of an array of boxes, in one call.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside {

/// Every pair of overlapping boxes, once, as places in `boxes`; in an order fixed by the spec and the boxes.
///
/// Boxes are closed: touching counts. Throws InvalidInput naming the first box with a NaN or with min > max,
/// and InvalidSpec. Thread-safe. A finder kept from make_finder() saves the memory's allocation when calls
/// are many.
std::vector<Pair> find_pairs(std::span<const Box2> boxes, std::string_view spec = default_algorithm);
std::vector<Pair> find_pairs(std::span<const Box3> boxes, std::string_view spec = default_algorithm);

/// The same into a sink, for pairs that are not to be stored. Flushes it.
void find_pairs(std::span<const Box2> boxes, PairSink& pairs, std::string_view spec = default_algorithm);
void find_pairs(std::span<const Box3> boxes, PairSink& pairs, std::string_view spec = default_algorithm);

}  // namespace broadside
