// World: checks that a snapshot's parts agree, so that update(), pairs() and queries can rely on it.
// Each part alone is checked where it is read, in snapshot_restore.hpp.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

#include "world/snapshot_check.hpp"
#include "world/state.hpp"

namespace broadside {
namespace {

using core::difference;
using core::expect;
using core::expect_apart;
using core::expect_within;
using Pairs = std::vector<Pair>;

Pairs slots_of(const std::vector<HandlePair>& handles) {
  Pairs pairs;
  pairs.reserve(handles.size());
  for (const HandlePair& pair : handles) pairs.push_back({BoxId{pair.first.slot}, BoxId{pair.second.slot}});
  return pairs;
}

}  // namespace

/// Whether the slot may be part of a pair: of one that holds, or of one whose end no update has told yet.
template <int D, typename Real>
bool World<D, Real>::State::is_paired(std::uint32_t slot) const noexcept {
  return slots[slot].state == SlotState::live || slots[slot].state == SlotState::removed;
}

template <int D, typename Real>
void World<D, Real>::State::expect_paired(Pair pair) const {
  if (is_paired(index(pair.first)) && is_paired(index(pair.second))) return;
  core::refuse(pair,
               "has a slot without a box; expected boxes in the world, or removed since the last update");
}

/// The tracker tells the ends of what it saw: by slots that there are, and that no other box has since.
template <int D, typename Real>
void World<D, Real>::State::check_last_frame(const LastFrame& last) const {
  for (std::uint32_t slot = 0; slot < last.boxes.size(); ++slot) {
    if (is_absent(last.boxes[slot])) continue;
    expect(slot < slots.size() && is_paired(slot),
           "the last frame has a box in a slot that has none now, and none was removed there");
  }
  Pairs listed = ignored_changed;
  std::ranges::sort(listed);
  const auto expect_listed = [&listed](const IgnoredPairs& some, const IgnoredPairs& others) {
    some.for_each([&](Pair pair) {
      if (others.contains(pair) || std::ranges::binary_search(listed, pair)) return;
      core::refuse(pair, "is ignored now or was in the last frame; expected both, or a list that it is in");
    });
  };
  // Without a set of them, the next update takes all for changed.
  if (!last.has_ignored) return;
  expect_listed(ignored, last.ignored);
  expect_listed(last.ignored, ignored);
}

/// Its flags: what has happened, and what is still to be delivered.
template <int D, typename Real>
void World<D, Real>::State::check_pending(bool asks_predicate) const {
  if (!has_updated) {
    expect(pair_count == 0 && begun.empty() && ended.empty() && graph.size() == 0 && reported.empty() &&
               candidates.empty() && refined.empty() && fresh.empty(),
           "it had no update and has pairs, events or boxes whose removal was told");
  }
  if (is_settled) {
    expect(changed.empty() && removed.empty() && ignored_changed.empty() && candidates.empty() &&
               refined.empty() && fresh.empty(),
           "nothing is pending and an update has something to tell");
  }
  if (is_refining) check_marks(asks_predicate);
}

/// An update looks only at what changed: the marks of all other edges must be right as they are.
template <int D, typename Real>
void World<D, Real>::State::check_marks(bool asks_predicate) const {
  Pairs new_edges = fresh;
  std::ranges::sort(new_edges);
  graph.for_each([&](core::PairGraph::EdgeId edge) {
    const Pair pair = graph.pair(edge);
    const core::PairGraph::Mark& mark = graph.mark(edge);
    if (mark.accepted && !mark.overlaps) core::refuse(pair, "is accepted and does not overlap");
    const Slot& a = slots[index(pair.first)];
    const Slot& b = slots[index(pair.second)];
    const bool is_looked_at = refilters_all || a.is_refilter || b.is_refilter ||
                              (refines_by_boxes() && (a.is_changed || b.is_changed)) ||
                              std::ranges::binary_search(new_edges, pair);
    if (is_looked_at) return;
    const bool overlaps = !refines_by_boxes() || overlap(boxes[index(pair.first)], boxes[index(pair.second)]);
    if (mark.overlaps != overlaps) {
      core::refuse(pair, std::string("is said to ") + (mark.overlaps ? "" : "not ") +
                             "overlap; expected what its boxes do, which did not change");
    }
    if (!asks_predicate && overlaps && !mark.accepted)
      core::refuse(pair, "overlaps and is not accepted; expected a predicate that refused it");
  });
}

/// Checks the pairs found, delivered and not yet delivered against those of the tracker; sorted.
template <int D, typename Real>
void World<D, Real>::State::check_pairs(const Pairs& tracked) const {
  expect_within(candidates.begun, tracked, "is a candidate that began; expected the tracker to have it");
  expect_apart(candidates.ended, tracked, "is a candidate that ended; expected the tracker not to have it");
  const Pairs known = difference(difference(tracked, candidates.begun), candidates.ended);
  Pairs held = known;
  if (is_refining) {
    expect(graph_pairs([](const core::PairGraph::Mark&) { return true; }) == known,
           "its pairs to refine are not those of its boxes");
    held = graph_pairs([](const core::PairGraph::Mark& mark) { return mark.overlaps && mark.accepted; });
    expect_within(refined.begun, held, "began when refined; expected it to hold");
    expect_apart(refined.ended, held, "ended when refined; expected it not to hold");
  }
  // The pairs that a failed update refined are not among the pairs yet.
  const Pairs told = difference(difference(held, refined.begun), refined.ended);
  if (pair_count != told.size()) {
    throw InvalidSnapshot("a snapshot contradicts itself: it counts " + std::to_string(pair_count) +
                          " pairs; expected " + std::to_string(told.size()) + ", which its boxes make");
  }
  if (options.keep_pairs) {
    const std::span<const HandlePair> pairs = current.pairs();
    expect(slots_of({pairs.begin(), pairs.end()}) == told, "its pairs are not those of its boxes");
  }
  expect_within(slots_of(begun), told, "began with the last update; expected it to hold");
  expect_apart(slots_of(ended), told, "ended with the last update; expected it not to hold");
}

}  // namespace broadside
