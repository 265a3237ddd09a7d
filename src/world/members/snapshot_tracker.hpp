// World: the way from what its tracker knows to what the tracker of a snapshot knew.
#pragma once

#include <algorithm>
#include <iterator>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "broadside/sinks.hpp"
#include "broadside/world.hpp"

#include "world/snapshot_check.hpp"
#include "world/state.hpp"

namespace broadside {
namespace {

using core::difference;
using Pairs = std::vector<Pair>;

}  // namespace

template <int D, typename Real>
Frame<D, Real> World<D, Real>::State::LastFrame::frame() const noexcept {
  return {boxes, {}, filters, has_ignored ? &ignored : nullptr, {}};
}

/// Whether it can tell the pairs that its tracker has found.
template <int D, typename Real>
bool World<D, Real>::State::knows_candidates() const noexcept {
  return is_refining || options.keep_pairs;
}

/// Those pairs, sorted.
template <int D, typename Real>
std::vector<Pair> World<D, Real>::State::known_candidates() const {
  Pairs pairs;
  if (is_refining) {
    pairs = graph_pairs([](const core::PairGraph::Mark&) { return true; });
  } else {
    const std::lock_guard lock(reading);
    current.merge(generations);
    is_current = true;
    for (const HandlePair& pair : current.pairs())
      pairs.push_back({BoxId{pair.first.slot}, BoxId{pair.second.slot}});
  }
  const PairEvents waiting = candidates.netted();
  return difference(difference(pairs, waiting.begun), waiting.ended);
}

template <int D, typename Real>
typename World<D, Real>::State::PairEvents World<D, Real>::State::PairEvents::netted() const {
  Pairs its_begun = begun;
  Pairs its_ended = ended;
  std::ranges::sort(its_begun);
  std::ranges::sort(its_ended);
  PairEvents net;
  std::ranges::set_difference(its_begun, its_ended, std::back_inserter(net.begun));
  std::ranges::set_difference(its_ended, its_begun, std::back_inserter(net.ended));
  return net;
}

/// The frame from which the next update's events start.
template <int D, typename Real>
Frame<D, Real> World<D, Real>::State::last_frame() const noexcept {
  return way_back ? way_back->frame() : tracker->last_frame();
}

/// Hands the tracker a frame in which only what differs from its last one is listed. Returns the events: the
/// pairs that hold in one of the two, sorted.
template <int D, typename Real>
std::vector<Pair> World<D, Real>::State::lead(PairTracker<D, Real>& tracker, const LastFrame& to) {
  const Frame<D, Real> from = tracker.last_frame();
  Frame<D, Real> frame = to.frame();
  std::vector<BoxId> places;
  for (std::uint32_t i = 0; i < std::min(from.boxes.size(), frame.boxes.size()); ++i) {
    // After an update that failed there may be fewer filters than boxes; then all are taken anew.
    const bool filters_differ =
        i < from.filters.size() && i < frame.filters.size() && from.filters[i] != frame.filters[i];
    if (from.boxes[i] != frame.boxes[i] || filters_differ) places.push_back(BoxId{i});
  }
  frame.changed = places;
  Pairs toggled;
  const auto add_missing = [&toggled](const IgnoredPairs* set, const IgnoredPairs* other) {
    if (set == nullptr || other == nullptr) return;
    set->for_each([&](Pair pair) {
      if (!other->contains(pair)) toggled.push_back(pair);
    });
  };
  add_missing(from.ignored, frame.ignored);
  add_missing(frame.ignored, from.ignored);
  frame.ignored_changed = toggled;
  Pairs begun_pairs;
  Pairs ended_pairs;
  PairCollector begun_sink(begun_pairs);
  PairCollector ended_sink(ended_pairs);
  tracker.update(frame, begun_sink, ended_sink);
  return difference(begun_pairs, ended_pairs);
}

/// Brings the tracker back after a restore() that failed, or leaves it where it is and throws.
template <int D, typename Real>
void World<D, Real>::State::lead_back() {
  if (!way_back) return;
  lead(*tracker, *way_back);
  way_back.reset();
}

/// Takes over the other world's tracker and leads it to the frame that this one's had taken last. If that
/// throws, the other world goes on as if nothing had happened: its tracker is led back now or, where memory
/// is too short for that, by its next update.
template <int D, typename Real>
void World<D, Real>::State::take_tracker(State& other, const LastFrame& last) {
  if (is_own_tracker && options.algorithm != other.options.algorithm) {
    std::unique_ptr<PairTracker<D, Real>> made = make_own_tracker(options);
    made->set_workers(other.tracker->workers());
    check_pairs(lead(*made, last));
    tracker = std::move(made);
    return;
  }
  other.lead_back();
  const Frame<D, Real> was = other.tracker->last_frame();
  auto before = std::make_unique<LastFrame>();
  before->boxes.assign(was.boxes.begin(), was.boxes.end());
  before->filters.assign(was.filters.begin(), was.filters.end());
  before->has_ignored = was.ignored != nullptr;
  if (before->has_ignored) before->ignored = *was.ignored;
  const bool is_known = other.knows_candidates();
  const Pairs known = is_known ? other.known_candidates() : Pairs{};
  other.way_back = std::move(before);
  try {
    if (!is_known) lead(*other.tracker, LastFrame{});
    check_pairs(difference(known, lead(*other.tracker, last)));
  } catch (...) {
    try {
      other.lead_back();
    } catch (...) {
      // The exception of restore() itself is the one thrown.
    }
    throw;
  }
  tracker = std::move(other.tracker);
}

}  // namespace broadside
