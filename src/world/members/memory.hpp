// World: the memory it holds, how it is given back, and what there is to count.
#pragma once

#include <algorithm>
#include <utility>

#include "broadside/sinks.hpp"
#include "broadside/world.hpp"

#include "world/state.hpp"

namespace broadside {
namespace {

/// Fewer slots than these are not worth giving back.
constexpr std::size_t few_slots = 64;
constexpr std::size_t few_slots_of_memory = 4096;

template <typename... Vectors>
void shrink(Vectors&... vectors) {
  (vectors.shrink_to_fit(), ...);
}

template <typename... Vectors>
std::size_t bytes_of(const Vectors&... vectors) noexcept {
  return (std::size_t{0} + ... + (vectors.capacity() * sizeof(typename Vectors::value_type)));
}

}  // namespace

template <int D, typename Real>
void World<D, Real>::shrink_to_fit() {
  state_->wants_release = true;
  // Another tracker has to begin where this one is.
  if (state_->is_settled) state_->release();
}

/// Drops free slots at the end once many are free (hysteresis: a few that come and go cost nothing).
template <int D, typename Real>
void World<D, Real>::State::trim() noexcept {
  most_slots = std::max(most_slots, slots.size());
  if (free.size() <= std::max(few_slots, slots.size() / 4)) return;
  while (!slots.empty() && slots.back().state == SlotState::free) {
    // Handles of this slot stay wrong if it comes back.
    first_generation = std::max(first_generation, generations.back());
    free.erase(static_cast<std::uint32_t>(slots.size() - 1));
    slots.pop_back();
    generations.pop_back();
    boxes.pop_back();
    if (has_margin()) enlarged.pop_back();
    if (uses_filters) filters.pop_back();
    if (keeps_user_data()) user_data.pop_back();
  }
}

/// Gives memory back where it was asked for, and where most of the slots are gone for which it was taken.
template <int D, typename Real>
void World<D, Real>::State::release_unneeded() noexcept {
  wants_release |= most_slots > few_slots_of_memory && slots.size() < most_slots / 4;
  if (!wants_release) return;
  try {
    release();
  } catch (...) {
    // Memory is short already, or an executor threw: the memory stays as it is.
  }
}

template <int D, typename Real>
void World<D, Real>::State::release() {
  wants_release = false;
  most_slots = slots.size();
  if (is_own_tracker && has_updated) {
    std::unique_ptr<PairTracker<D, Real>> fresh_tracker = make_own_tracker(options);
    fresh_tracker->set_workers(tracker->workers());
    PairCounter known;
    fresh_tracker->update(frame(), known, known);
    tracker = std::move(fresh_tracker);
    way_back.reset();
  }
  current.merge(generations);
  is_current = true;
  current.shrink_to_fit();
  is_persisting = false;
  persisting.clear();
  query_index.drop();
  graph.shrink_to_fit();
  ignored_edges.shrink_to_fit();
  free.shrink_to(slots.size());
  shrink(boxes, enlarged, generations, slots, filters, user_data);
  shrink(changed, moved, removed, reported, ignored_changed, refiltered, touched, questions, fresh);
  shrink(candidates.begun, candidates.ended, refined.begun, refined.ended, sorting, begun, ended);
  shrink(persisting, begun_data, ended_data);
  join_finder.reset();
}

template <int D, typename Real>
WorldStatistics World<D, Real>::statistics() const {
  const State& state = *state_;
  WorldStatistics statistics;
  statistics.boxes = state.size;
  statistics.slots = slots();
  statistics.pairs = state.pair_count;
  statistics.begun = state.begun.size();
  statistics.ended = state.ended.size();
  statistics.enlarged_pairs = state.graph.size();
  statistics.ignored_pairs = state.ignored.size();
  statistics.tracker = state.tracker->statistics();
  statistics.explanation = state.tracker->explanation();

  const std::lock_guard lock(state.reading);
  WorldBytes& bytes = statistics.bytes;
  bytes.boxes = bytes_of(state.boxes, state.enlarged, state.removed, state.reported);
  bytes.slots = bytes_of(state.generations, state.slots, state.user_data, state.changed, state.moved) +
                state.free.bytes();
  bytes.filters =
      bytes_of(state.filters, state.ignored_changed) + state.ignored_edges.bytes() + state.ignored.bytes();
  bytes.pairs = bytes_of(state.begun, state.ended, state.persisting, state.candidates.begun,
                         state.candidates.ended, state.refined.begun, state.refined.ended, state.sorting) +
                bytes_of(state.begun_data, state.ended_data, state.touched, state.questions, state.fresh,
                         state.refiltered) +
                state.current.bytes() + state.graph.bytes();
  bytes.tracker = state.tracker->bytes();
  bytes.queries = state.query_index.bytes();
  return statistics;
}

}  // namespace broadside
