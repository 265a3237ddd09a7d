// World: which overlapping boxes count as pairs.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "broadside/world.hpp"

#include "core/message.hpp"
#include "world/state.hpp"

namespace broadside {
namespace {

/// The pair of two boxes that are in the world.
Pair pair_of(Handle a, Handle b) {
  if (a.slot == b.slot) {
    throw std::invalid_argument(
        core::message({"a pair to be ignored has slot ", a.slot, " twice; expected two different boxes"}));
  }
  return {BoxId{std::min(a.slot, b.slot)}, BoxId{std::max(a.slot, b.slot)}};
}

}  // namespace

template <int D, typename Real>
Filter World<D, Real>::filter(Handle handle) const {
  const std::uint32_t slot = state_->readable_slot(handle);
  return state_->uses_filters ? state_->filters[slot] : Filter{};
}

template <int D, typename Real>
void World<D, Real>::set_filter(Handle handle, const Filter& filter) {
  const std::uint32_t slot = state_->live_slot(handle, "filter");
  if (filter == this->filter(handle)) return;
  state_->reserve_moves(1);
  state_->reserve(0, true, false);
  state_->mark_changed(slot);
  if (state_->has_margin()) state_->mark_moved(slot);
  state_->filters[slot] = filter;
}

template <int D, typename Real>
void World<D, Real>::ignore(Handle a, Handle b) {
  State& state = *state_;
  state.live_slot(a, "ignore a pair of");
  state.live_slot(b, "ignore a pair of");
  const Pair pair = pair_of(a, b);
  if (state.ignored.contains(pair)) return;
  make_room(state.ignored_changed, 1);
  state.ignored_edges.reserve(state.ignored_edges.size() + 1, std::max(a.slot, b.slot) + std::size_t{1});
  state.ignored.insert(pair);
  state.ignored_edges.insert(pair);
  state.ignored_changed.push_back(pair);
  state.is_settled = false;
}

template <int D, typename Real>
void World<D, Real>::unignore(Handle a, Handle b) {
  State& state = *state_;
  if (!is_ignored(a, b)) return;
  const Pair pair = pair_of(a, b);
  make_room(state.ignored_changed, 1);
  state.ignored.erase(pair);
  state.ignored_edges.erase(state.ignored_edges.find(pair));
  state.ignored_changed.push_back(pair);
  state.is_settled = false;
}

template <int D, typename Real>
bool World<D, Real>::is_ignored(Handle a, Handle b) const {
  state_->live_slot(a, "look up an ignored pair of");
  state_->live_slot(b, "look up an ignored pair of");
  return state_->ignored.contains(pair_of(a, b));
}

template <int D, typename Real>
void World<D, Real>::set_predicate(PairPredicate predicate) {
  State& state = *state_;
  if (!state.is_refining && state.has_updated) {
    if (!state.options.keep_pairs) {
      throw std::logic_error(
          "a predicate was set after the first update of a world that keeps no pairs; expected it before, or "
          "WorldOptions::keep_pairs");
    }
    // The pairs that hold are all of the tracker's.
    core::PairGraph graph;
    graph.reserve(state.pair_count, state.slots.size());
    for (const HandlePair& pair : pairs())
      graph.mark(graph.insert({BoxId{pair.first.slot}, BoxId{pair.second.slot}})) = {true, true, 0};
    state.graph = std::move(graph);
    // Events of an update that failed have found no way to the pairs yet, and now go the other one.
  }
  state.is_refining = true;
  state.refilters_all = true;
  state.predicate.swap(predicate);
}

template <int D, typename Real>
void World<D, Real>::refilter(Handle handle) {
  const std::uint32_t slot = state_->live_slot(handle, "refilter");
  if (!state_->uses_predicate() || state_->slots[slot].is_refilter) return;
  state_->refiltered.push_back(slot);
  state_->slots[slot].is_refilter = true;
}

template <int D, typename Real>
void World<D, Real>::refilter() {
  state_->refilters_all |= state_->uses_predicate();
}

}  // namespace broadside
