// World: the index for queries, which is the tracker's or the world's own.
#pragma once

#include <mutex>
#include <vector>

#include "broadside/index.hpp"
#include "broadside/world.hpp"

#include "world/state.hpp"

namespace broadside {

template <int D, typename Real>
const BoxIndex<D, Real>& World<D, Real>::box_index() const {
  const State& state = *state_;
  if (const BoxIndex<D, Real>* const trackers = state.trackers_index()) return *trackers;
  if (!state.query_index.is_current()) {
    const std::lock_guard lock(state.reading);
    if (!state.query_index.is_current()) state.query_index.update(state.boxes, state.filters);
  }
  return state.query_index.get();
}

template <int D, typename Real>
Handle World<D, Real>::handle_of(BoxId slot) const noexcept {
  return state_->handle(slot);
}

/// The tracker's own index, if it has one of the boxes as they are now.
template <int D, typename Real>
const BoxIndex<D, Real>* World<D, Real>::State::trackers_index() const noexcept {
  if (has_margin() || !changed.empty() || (!core::is_lean && way_back != nullptr)) return nullptr;
  return tracker->box_index();
}

/// Lists the slots in which the two states differ, before the other state takes over the index.
template <int D, typename Real>
void World<D, Real>::State::mark_differences(const State& other) {
  if (!query_index.exists()) return;
  query_index.reserve(other.slots.size());
  if (other.slots.size() < slots.size()) query_index.shorten();
  const auto filter_of = [](const State& state, std::uint32_t slot) {
    return state.uses_filters ? state.filters[slot] : Filter{};
  };
  for (std::uint32_t slot = 0; slot < other.slots.size(); ++slot) {
    const bool is_same = slot < slots.size() && boxes[slot] == other.boxes[slot] &&
                         filter_of(*this, slot) == filter_of(other, slot);
    if (!is_same) query_index.mark(slot);
  }
}

}  // namespace broadside
