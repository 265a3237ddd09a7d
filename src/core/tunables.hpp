// The tunables that several algorithms have, and what of an algorithm a build registers.
#pragma once

#include "broadside/algorithm.hpp"

#include "core/dimensions.hpp"

namespace broadside::core {

/// The tunable `threads`, of every algorithm that uses several: Finder and Tracker set their Workers by it.
Tunable threads_tunable();

/// The tunable `update`, of every algorithm of which a Tracker may also find all pairs anew.
Tunable update_tunable();
Update update_of(const Settings& settings);

/// What `make` returns; nothing in a build without D dimensions, so that nothing of it is linked.
template <int D>
Strategies<D> in_dimension(Strategies<D> (*make)()) {
  if constexpr (has_dimension<D>)
    return make();
  else
    return {};
}

/// Makes an outline by `lay_out` of a searcher of class S.
template <typename S, int D>
MakeOutline<D> outline_by(Outline<D, float> (S::*lay_out)(std::span<const Box<D>>, const Workers&)) {
  return [lay_out](std::span<const Box<D>> boxes, const Workers& workers, const Settings& settings) {
    return (*make_strategy<S>(settings).*lay_out)(boxes, workers);
  };
}

}  // namespace broadside::core
