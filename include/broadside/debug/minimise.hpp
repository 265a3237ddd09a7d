// minimise(): reduces failing inputs by delta debugging (Zeller and Hildebrandt 2002). It removes whatever
// can be removed while the failure remains.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <type_traits>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/debug/history.hpp"
#include "broadside/export.hpp"

namespace broadside {

/// Returns whether boxes, or a history of boxes, still fail. An exception from it ends the search.
template <int D, typename Real>
using BoxesFail = std::type_identity_t<std::function<bool(std::span<const Box<D, Real>>)>>;
template <int D, typename Real>
using HistoryFails = std::type_identity_t<std::function<bool(const History<D, Real>&)>>;

namespace detail {
/// Moves the boxes that minimise() keeps to the front, and returns their number.
template <int D, typename Real>
BROADSIDE_PUBLIC std::size_t minimise(std::span<Box<D, Real>> boxes, const BoxesFail<D, Real>& fails,
                                      const std::function<bool()>& stop);
}  // namespace detail

/// Removes boxes while the others still fail: first halves, then ever smaller parts, down to single boxes.
/// Each remaining box was needed when its removal was tried. `boxes` must fail. Calls `fails` about m log n
/// times, for m boxes left of n. If `stop` is given, the search ends early when it returns true.
template <int D, typename Real>
void minimise(std::vector<Box<D, Real>>& boxes, const BoxesFail<D, Real>& fails,
              const std::function<bool()>& stop = {}) {
  boxes.resize(detail::minimise<D, Real>(boxes, fails, stop));
}

/// Reduces a history in the same way: removes frames, boxes (the ids of later boxes decrease), changes, and
/// ignored pairs.
template <int D, typename Real>
BROADSIDE_PUBLIC void minimise(History<D, Real>& history, const HistoryFails<D, Real>& fails,
                               const std::function<bool()>& stop = {});

/// The history of only these boxes, numbered from 0. `places` must be ascending.
template <int D, typename Real>
[[nodiscard]] BROADSIDE_PUBLIC History<D, Real> only(std::span<const std::size_t> places,
                                                     const History<D, Real>& history);

}  // namespace broadside
