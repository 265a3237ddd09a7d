// Searchers that are checked: pairs with ids out of range, which a searcher of the user's may write, are
// refused.
#pragma once

#include <memory>

#include "broadside/algorithm.hpp"
#include "broadside/searcher.hpp"

namespace broadside::find {

/// The searcher, whose search() throws std::logic_error for the first pair that is not of two of its boxes.
/// Everything behind a searcher reads arrays by the ids that it writes. The library's own algorithms and the
/// peers of the comparison are tested, and not slowed down by this.
template <int D>
std::unique_ptr<Searcher<D>> checked(std::unique_ptr<Searcher<D>> searcher);

/// The searcher of an algorithm by its settings; checked if a user registered the algorithm.
template <int D>
std::unique_ptr<Searcher<D>> searcher_of(const Algorithm& algorithm, const Settings& settings);

}  // namespace broadside::find
