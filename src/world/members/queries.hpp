// World: its index for queries, the tracker's or one built when the first query is asked.
#pragma once

#include <mutex>
#include <vector>

#include "broadside/queries.hpp"
#include "broadside/world.hpp"

#include "world/state.hpp"

namespace broadside {

template <int D, typename Real>
const BoxIndex<D, Real>& World<D, Real>::box_index() const {
  const State& state = *state_;
  if (const BoxIndex<D, Real>* const trackers = state.trackers_index()) return *trackers;
  if (!state.is_indexed.load(std::memory_order_acquire)) {
    const std::lock_guard lock(state.reading);
    if (!state.is_indexed.load(std::memory_order_relaxed)) state.bring_index_up_to_date();
  }
  return *state.queried;
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

/// Changes since the last update may be handed to the index more than once, and cost as much each time.
template <int D, typename Real>
void World<D, Real>::State::bring_index_up_to_date() const {
  if (queried == nullptr) queried = make_box_index<D, Real>();
  unindexed.insert(unindexed.end(), changed.begin(), changed.end());
  // Slots that no longer exist need not be listed; those that came and went in between must not be.
  std::erase_if(unindexed, [this](BoxId slot) { return index(slot) >= boxes.size(); });
  queried->update({.boxes = boxes, .changed = unindexed, .filters = filters});
  unindexed.clear();
  is_indexed.store(true, std::memory_order_release);
}

/// Before an update forgets what changed: keeps it for the index. One that no query has used for long, or
/// since changes while the tracker has one, is built anew by the next query that needs it.
template <int D, typename Real>
void World<D, Real>::State::note_changes_for_index() {
  if (queried == nullptr || is_indexed.load(std::memory_order_relaxed)) return;
  const bool is_unused = unindexed.size() + changed.size() > slots.size() / 2 + 1024;
  if (is_unused || (!has_margin() && tracker->box_index() != nullptr)) return drop_index();
  unindexed.insert(unindexed.end(), changed.begin(), changed.end());
}

template <int D, typename Real>
void World<D, Real>::State::drop_index() noexcept {
  queried.reset();
  unindexed = {};
  is_indexed.store(false, std::memory_order_relaxed);
}

}  // namespace broadside
