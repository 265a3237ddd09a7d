// World: what an update does. The tracker's events are candidates; where there is a margin or a predicate,
// they are refined; then they are delivered.
//
// Each step first does all that can fail and then changes something, so that an update that throws can be
// tried again: what its steps had done by then waits in `candidates`, `fresh` and `refined`.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "broadside/sinks.hpp"
#include "broadside/world.hpp"

#include "core/float_environment.hpp"
#include "kernels/overlap_flags.hpp"
#include "world/state.hpp"

namespace broadside {
namespace {

/// Takes from both what is in both: events that were undone before they were delivered.
void cancel(std::vector<Pair>& begun, std::vector<Pair>& ended, std::vector<Pair>& scratch) {
  sort_pairs(begun, scratch);
  sort_pairs(ended, scratch);
  std::size_t kept_begun = 0;
  std::size_t kept_ended = 0;
  std::size_t j = 0;
  for (const Pair pair : begun) {
    while (j < ended.size() && ended[j] < pair) ended[kept_ended++] = ended[j++];
    if (j < ended.size() && ended[j] == pair)
      ++j;
    else
      begun[kept_begun++] = pair;
  }
  while (j < ended.size()) ended[kept_ended++] = ended[j++];
  begun.resize(kept_begun);
  ended.resize(kept_ended);
}

/// Of all slots, the part whose change makes it pay to look at every edge.
constexpr std::size_t many_changed = 4;

}  // namespace

template <int D, typename Real>
Events World<D, Real>::update() {
  State& state = *state_;
  if constexpr (!core::is_lean) state.lead_back();
  // Drops an index that queries have not used for long. The next query that needs one builds it anew.
  if (state.query_index.is_outdated(state.slots.size())) state.query_index.drop();
  const bool is_again = !state.refined.empty();
  state.ask_tracker();
  if (state.is_refining) {
    state.apply_candidates();
    state.refine();
    if (is_again) cancel(state.refined.begun, state.refined.ended, state.sorting);
    state.deliver(state.refined);
  } else {
    state.deliver(state.candidates);
  }
  state.recycle();
  state.settle();
  state.trim();
  state.release_unneeded();
  return {state.begun, state.ended, state.begun_data, state.ended_data};
}

template <int D, typename Real>
Frame<D, Real> World<D, Real>::State::frame() const noexcept {
  Frame<D, Real> frame;
  frame.boxes = has_margin() ? enlarged : boxes;
  frame.changed = has_margin() ? moved : changed;
  frame.filters = filters;
  frame.ignored = &ignored;
  frame.ignored_changed = ignored_changed;
  return frame;
}

/// Appends the tracker's events to the candidates.
template <int D, typename Real>
void World<D, Real>::State::ask_tracker() {
  is_settled = false;
  const std::size_t begun_before = candidates.begun.size();
  const std::size_t ended_before = candidates.ended.size();
  try {
    PairCollector begun_pairs(candidates.begun);
    PairCollector ended_pairs(candidates.ended);
    tracker->update_checked(frame(), begun_pairs, ended_pairs);
  } catch (...) {
    // It will tell these again.
    candidates.begun.resize(begun_before);
    candidates.ended.resize(ended_before);
    throw;
  }
  has_updated = true;
  if (begun_before + ended_before > 0) cancel(candidates.begun, candidates.ended, sorting);
}

/// Brings the graph up to date.
template <int D, typename Real>
void World<D, Real>::State::apply_candidates() {
  graph.reserve(graph.size() + candidates.begun.size(), slots.size());
  make_room(fresh, candidates.begun.size());
  make_room(refined.ended, candidates.ended.size());
  const bool is_again = !refined.ended.empty() || !fresh.empty();
  for (const Pair pair : candidates.ended) {
    const core::PairGraph::EdgeId edge = graph.find(pair);
    if (graph.mark(edge).overlaps && graph.mark(edge).accepted) refined.ended.push_back(pair);
    graph.erase(edge);
  }
  for (const Pair pair : candidates.begun) {
    graph.insert(pair);
    fresh.push_back(pair);
  }
  // Events left by a failed update go before newer ones; a snapshot lists both by id.
  if (is_again) {
    std::ranges::sort(refined.ended);
    std::ranges::sort(fresh);
  }
  candidates.clear();
}

/// Looks at all edges that may hold now and did not before, or the other way round: those of the boxes that
/// changed or, where these are many, all in a row, which takes a fraction of the time an edge.
template <int D, typename Real>
void World<D, Real>::State::refine() {
  const core::DefaultEnvironment environment;
  ++stamp;
  touched.clear();
  questions.clear();
  const bool by_boxes = refines_by_boxes();
  if (refilters_all || (by_boxes && changed.size() > slots.size() / many_changed)) {
    touch_all();
  } else {
    const auto touch_edge = [this](core::PairGraph::EdgeId edge) { touch_once(edge); };
    for (const Pair pair : fresh) {
      const core::PairGraph::EdgeId edge = graph.find(pair);
      if (edge != core::PairGraph::none) touch_once(edge);
    }
    if (by_boxes) {
      for (const BoxId id : changed) graph.for_each_of(id, touch_edge);
    }
    for (const std::uint32_t slot : refiltered) graph.for_each_of(BoxId{slot}, touch_edge);
  }

  if (uses_predicate()) {
    std::ranges::sort(questions, {}, &Question::pair);
    const core::CallersEnvironment callers;
    for (const Question& question : questions) {
      touched[question.touched].accepted =
          predicate(handle(question.pair.first), handle(question.pair.second));
    }
  }

  make_room(refined.begun, touched.size());
  make_room(refined.ended, touched.size());
  for (const Touched& now : touched) {
    core::PairGraph::Mark& mark = graph.mark(now.edge);
    const bool held = mark.overlaps && mark.accepted;
    const bool holds = now.overlaps && now.accepted;
    mark.overlaps = now.overlaps;
    mark.accepted = now.accepted;
    if (held != holds) (holds ? refined.begun : refined.ended).push_back(graph.pair(now.edge));
  }
  fresh.clear();
  sort_pairs(refined.begun, sorting);
  sort_pairs(refined.ended, sorting);
}

/// Looks at an edge that may have been looked at in this update already.
template <int D, typename Real>
void World<D, Real>::State::touch_once(core::PairGraph::EdgeId edge) {
  core::PairGraph::Mark& mark = graph.mark(edge);
  if (mark.stamp == stamp) return;
  mark.stamp = stamp;
  const auto [a, b] = graph.pair(edge);
  touch(edge, !refines_by_boxes() || overlap(boxes[index(a)], boxes[index(b)]));
}

template <int D, typename Real>
void World<D, Real>::State::touch_all() {
  constexpr std::size_t at_once = 256;
  std::array<core::PairGraph::EdgeId, at_once> edges;
  std::array<Pair, at_once> pairs;
  std::array<std::uint8_t, at_once> flags;
  flags.fill(1);
  std::size_t count = 0;
  const auto touch_these = [&] {
    if (refines_by_boxes()) {
      const std::span<const Box<D, Real>> all = boxes;
      kernels::set_overlap_flags(all, std::span<const Pair>(pairs).first(count), flags.data());
    }
    for (std::size_t i = 0; i < count; ++i) {
      const core::PairGraph::Mark& mark = graph.mark(edges[i]);
      const bool overlaps = flags[i] != 0;
      if (uses_predicate() || mark.overlaps != overlaps || mark.accepted != overlaps)
        touch(edges[i], overlaps);
    }
    count = 0;
  };
  graph.for_each([&](core::PairGraph::EdgeId edge) {
    edges[count] = edge;
    pairs[count++] = graph.pair(edge);
    if (count == at_once) touch_these();
  });
  touch_these();
}

/// An edge that stays as it was is not noted.
template <int D, typename Real>
void World<D, Real>::State::touch(core::PairGraph::EdgeId edge, bool overlaps) {
  const core::PairGraph::Mark& mark = graph.mark(edge);
  const Pair pair = graph.pair(edge);
  const std::uint32_t a = index(pair.first);
  const std::uint32_t b = index(pair.second);
  const bool is_asked = overlaps && uses_predicate() &&
                        (!mark.overlaps || refilters_all || slots[a].is_refilter || slots[b].is_refilter);
  if (is_asked)
    questions.push_back({pair, touched.size()});
  else if (overlaps == mark.overlaps && (uses_predicate() || mark.accepted == overlaps))
    return;
  touched.push_back({edge, overlaps, overlaps});
}

/// Makes the events the world's.
template <int D, typename Real>
void World<D, Real>::State::deliver(PairEvents& events) {
  begun.reserve(events.begun.size());
  ended.reserve(events.ended.size());
  if (keeps_user_data()) {
    begun_data.reserve(events.begun.size());
    ended_data.reserve(events.ended.size());
  }
  if (options.keep_pairs) current.add(events.begun, events.ended, generations);
  is_current = current.is_merged();
  is_persisting = false;
  pair_count += events.begun.size();
  pair_count -= events.ended.size();
  const auto collect = [this](std::span<const Pair> pairs, std::vector<HandlePair>& handles,
                              std::vector<UserDataPair>& data) {
    handles.clear();
    if (!core::is_lean) data.clear();
    for (const Pair pair : pairs) {
      handles.push_back({handle(pair.first), handle(pair.second)});
      if (keeps_user_data()) data.push_back({user_data[index(pair.first)], user_data[index(pair.second)]});
    }
  };
  collect(events.begun, begun, begun_data);
  collect(events.ended, ended, ended_data);
  events.clear();
}

/// A slot whose removal the last update told can be used again from here on; one whose removal this update
/// tells, from the next on.
template <int D, typename Real>
void World<D, Real>::State::recycle() noexcept {
  for (const Removed& old : reported) {
    if (generations[old.slot] == std::numeric_limits<std::uint32_t>::max()) {
      slots[old.slot].state = SlotState::retired;
      continue;
    }
    slots[old.slot].state = SlotState::free;
    ++generations[old.slot];
    free.insert(old.slot);
  }
  reported.clear();
  for (const Removed& now : removed) slots[now.slot].state = SlotState::reported;
  std::swap(reported, removed);
}

template <int D, typename Real>
void World<D, Real>::State::settle() noexcept {
  for (const BoxId id : changed) slots[index(id)].is_changed = false;
  for (const BoxId id : moved) slots[index(id)].is_moved = false;
  for (const std::uint32_t slot : refiltered) slots[slot].is_refilter = false;
  changed.clear();
  moved.clear();
  refiltered.clear();
  ignored_changed.clear();
  refilters_all = false;
  is_settled = true;
  if (is_refining && !uses_predicate() && !refines_by_boxes()) {
    graph = {};
    is_refining = false;
  }
}

}  // namespace broadside
