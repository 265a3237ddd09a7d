// Failing inputs made small by delta debugging (Zeller and Hildebrandt 2002): whatever can go goes, as long
// as the failure remains.
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

/// Whether boxes, or a history of them, still fail. What it throws ends the search.
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

/// Drops boxes without which `boxes`, which fail, still fail; halves first, then ever smaller parts, down to
/// single boxes. None that is left can go alone. Calls `fails` about as often as there are boxes left times
/// the logarithm of how many there were. `stop`, where there is one, ends it early.
template <int D, typename Real>
void minimise(std::vector<Box<D, Real>>& boxes, const BoxesFail<D, Real>& fails,
              const std::function<bool()>& stop = {}) {
  boxes.resize(detail::minimise<D, Real>(boxes, fails, stop));
}

/// Likewise a history: drops frames, places of the array (those behind move up), changes, and ignored pairs.
template <int D, typename Real>
BROADSIDE_PUBLIC void minimise(History<D, Real>& history, const HistoryFails<D, Real>& fails,
                               const std::function<bool()>& stop = {});

/// The history of these places, which are ascending, alone; they are counted anew.
template <int D, typename Real>
BROADSIDE_PUBLIC History<D, Real> only(std::span<const std::size_t> places, const History<D, Real>& history);

}  // namespace broadside
