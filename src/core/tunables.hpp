// The tunables that several algorithms share, and the parts of an algorithm that a build registers.
#pragma once

#include "broadside/algorithm.hpp"

#include "core/dimensions.hpp"

namespace broadside::core {

/// The tunable `threads` of every multithreaded algorithm. Finder and Tracker set their Workers from it.
Tunable threads_tunable();

/// The tunable `update` of every algorithm with which a Tracker can also find all pairs anew.
Tunable update_tunable();
Update update_of(const Settings& settings);

/// Returns Make(), or no strategies in a build without D dimensions, whose code is not linked then.
template <int D, Strategies<D> (*Make)()>
Strategies<D> in_dimension() {
  if constexpr (has_dimension<D>)
    return Make();
  else
    return {};
}

/// A function that makes an outline by calling `lay_out` of a searcher of class S.
template <typename S, int D>
MakeOutline<D> outline_by(Outline<D, float> (S::*lay_out)(std::span<const Box<D>>, const Workers&)) {
  return [lay_out](std::span<const Box<D>> boxes, const Workers& workers, const Settings& settings) {
    return (*make_strategy<S>(settings).*lay_out)(boxes, workers);
  };
}

}  // namespace broadside::core
