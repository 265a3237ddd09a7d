// The tunables that several algorithms have, and what of an algorithm a build registers.
#pragma once

#include "broadside/algorithm.hpp"

#include "core/dimensions.hpp"
#include "core/lean.hpp"

namespace broadside::core {

/// The tunable `threads`, of every algorithm that uses several: Finder and Tracker set their Workers by it.
Tunable threads_tunable();

/// The tunable `update`, of every algorithm of which a Tracker may also find all pairs anew.
Tunable update_tunable();
Update update_of(const Settings& settings);

/// The followers that `make` lists; none in a build without D dimensions, so that nothing of them is linked.
template <int D>
detail::Vector<FollowerChoice<D>> followers_in_dimension(detail::Vector<FollowerChoice<D>> (*make)()) {
  if constexpr (has_dimension<D>)
    return make();
  else
    return {};
}

/// Likewise a function that lays an algorithm's outline out; lean builds have none.
template <int D, typename Maker>
constexpr Maker* outline_in_dimension(Maker* make) noexcept {
  return is_lean ? nullptr : in_dimension<D>(make);
}

}  // namespace broadside::core
