// DecodedSnapshot's checks: whether its parts agree, so that update(), pairs() and queries can rely on it.
// SnapshotReader has checked each part alone.
#include <algorithm>
#include <cstdint>
#include <span>

#include "world/snapshot_codec.hpp"
#include "world/snapshot_format.hpp"

namespace broadside::world {
namespace {

using Pairs = std::vector<Pair>;

/// Throws InvalidSnapshot unless what began is among the sorted `pairs`, and what ended is not.
void expect_led_to(const Pairs& pairs, const PairEvents& events, const char* if_begun, const char* if_ended) {
  for (const Pair pair : events.begun) {
    if (!std::binary_search(pairs.begin(), pairs.end(), pair)) refuse(pair, if_begun);
  }
  for (const Pair pair : events.ended) {
    if (std::binary_search(pairs.begin(), pairs.end(), pair)) refuse(pair, if_ended);
  }
}

}  // namespace

template <int D, typename Real>
void DecodedSnapshot<D, Real>::check_last_frame() const {
  check_differences();
  for (std::uint32_t slot = 0; slot < last_frame.boxes.size(); ++slot) {
    if (is_absent(last_frame.boxes[slot])) continue;
    expect(slot < parts->slots.size() && parts->slots.is_paired(slot),
           "the last frame has a box in a slot that has none now, although none was removed there");
  }
  Pairs listed(parts->ignored.changed().begin(), parts->ignored.changed().end());
  std::sort(listed.begin(), listed.end());
  const auto expect_listed = [&listed](const IgnoredPairs& some, const IgnoredPairs& others) {
    some.for_each([&](Pair pair) {
      if (others.contains(pair) || std::binary_search(listed.begin(), listed.end(), pair)) return;
      refuse(pair, "is ignored now or was in the last frame; expected both, or a list that it is in");
    });
  };
  // Without a set of ignored pairs, the next update treats all of them as changed.
  if (!last_frame.has_ignored) return;
  expect_listed(parts->ignored.pairs(), last_frame.ignored);
  expect_listed(last_frame.ignored, parts->ignored.pairs());
}

/// Checks that every box and filter that differs between the last frame and now is listed.
template <int D, typename Real>
void DecodedSnapshot<D, Real>::check_differences() const {
  const Frame<D, Real> now = parts->frame();
  std::vector<BoxId> listed(now.changed.begin(), now.changed.end());
  std::sort(listed.begin(), listed.end());
  const auto is_listed = [&listed](std::uint32_t slot) {
    return std::binary_search(listed.begin(), listed.end(), BoxId{slot});
  };
  for (std::uint32_t i = 0; i < now.boxes.size(); ++i) {
    if (i < last_frame.boxes.size() && last_frame.boxes[i] == now.boxes[i]) continue;
    expect((i >= last_frame.boxes.size() && is_absent(now.boxes[i])) || is_listed(i),
           "a box changed but is not listed as changed");
  }
  const auto filter_of = [](std::span<const Filter> some, std::size_t i) {
    return i < some.size() ? some[i] : Filter{};
  };
  const std::size_t filtered = last_frame.filters.empty() && now.filters.empty() ? 0 : now.boxes.size();
  for (std::uint32_t i = 0; i < filtered; ++i)
    expect(filter_of(last_frame.filters, i) == filter_of(now.filters, i) || is_listed(i),
           "a filter changed but its box is not listed as changed");
}

template <int D, typename Real>
void DecodedSnapshot<D, Real>::check_pending(bool is_settled, bool asks_predicate) const {
  const RefinerState& refiner = parts->refiner.state();
  const bool has_waiting = !refiner.candidates.empty() || !refiner.refined.empty() || !refiner.fresh.empty();
  if (!parts->has_updated) {
    expect(parts->current.size() == 0 && parts->current.events().begun.empty() &&
               parts->current.events().ended.empty() && refiner.graph.size() == 0 &&
               parts->slots.reported().empty() && !has_waiting,
           "it had no update but has pairs, events or boxes reported as removed");
  }
  if (is_settled) {
    expect(parts->boxes.changed().empty() && parts->slots.removed().empty() &&
               parts->ignored.changed().empty() && !has_waiting,
           "nothing is pending but an update has something to report");
  }
  if (refiner.is_refining) check_marks(asks_predicate);
}

/// Checks the marks of edges that did not change, since an update does not review them.
template <int D, typename Real>
void DecodedSnapshot<D, Real>::check_marks(bool asks_predicate) const {
  const PairGraph& graph = parts->refiner.state().graph;
  const std::span<const Box<D, Real>> boxes = parts->boxes.boxes();
  const bool by_boxes = parts->boxes.refines();
  Pairs new_edges = parts->refiner.state().fresh;
  std::sort(new_edges.begin(), new_edges.end());
  for (PairGraph::EdgeId edge = 0; edge < graph.size(); ++edge) {
    const Pair pair = graph.pairs()[edge];
    const std::uint8_t mark = graph.marks()[edge];
    if (mark == edge_accepted) refuse(pair, "is accepted but does not overlap");
    const std::uint32_t a = index(pair.first);
    const std::uint32_t b = index(pair.second);
    const bool is_looked_at = parts->refiner.asks_about(a) || parts->refiner.asks_about(b) ||
                              (by_boxes && (parts->boxes.is_changed(a) || parts->boxes.is_changed(b))) ||
                              std::binary_search(new_edges.begin(), new_edges.end(), pair);
    if (is_looked_at) continue;
    const bool overlaps = !by_boxes || overlap(boxes[a], boxes[b]);
    if ((mark != 0) != overlaps) {
      refuse(pair, overlaps ? "is marked as not overlapping; expected overlapping, like its unchanged boxes"
                            : "is marked as overlapping; expected not overlapping, like its unchanged boxes");
    }
    if (!asks_predicate && mark == edge_overlaps)
      refuse(pair, "overlaps but is not accepted; expected a predicate that refused it");
  }
}

template <int D, typename Real>
void DecodedSnapshot<D, Real>::check_pairs(const Pairs& tracked) const {
  const RefinerState& refiner = parts->refiner.state();
  expect_led_to(tracked, refiner.candidates, "is a candidate that began; expected the tracker to have it",
                "is a candidate that ended; expected the tracker not to have it");
  const Pairs known = refiner.candidates.undone(tracked);
  Pairs held = known;
  if (refiner.is_refining) {
    expect(parts->refiner.edges() == known, "its pairs to refine are not those of its boxes");
    held = parts->refiner.held_edges();
    expect_led_to(held, refiner.refined, "began when refined; expected it to hold",
                  "ended when refined; expected it not to hold");
  }
  // The pairs that a failed update refined are not among the pairs yet.
  const Pairs told = refiner.refined.undone(held);
  if (parts->current.size() != told.size()) {
    throw InvalidSnapshot("a snapshot contradicts itself: it counts " +
                          std::to_string(parts->current.size()) + " pairs; expected " +
                          std::to_string(told.size()) + ", which its boxes make");
  }
  if (parts->current.keeps()) {
    expect(parts->current.slot_pairs() == told, "its pairs are not those of its boxes");
  }
  const Events last = parts->current.events();
  expect_led_to(told, {slots_of(last.begun), slots_of(last.ended)},
                "began with the last update; expected it to hold",
                "ended with the last update; expected it not to hold");
}

template struct DecodedSnapshot<2, float>;
template struct DecodedSnapshot<2, double>;
template struct DecodedSnapshot<3, float>;
template struct DecodedSnapshot<3, double>;

}  // namespace broadside::world
