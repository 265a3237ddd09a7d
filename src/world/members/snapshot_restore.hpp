// World: what a snapshot says, checked. How a tracker comes to know what the snapshot's knew is in
// snapshot_tracker.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

#include "core/former_names.hpp"
#include "world/snapshot_check.hpp"
#include "world/snapshot_format.hpp"
#include "world/snapshot_parts.hpp"
#include "world/state.hpp"

namespace broadside {
namespace {

using core::ByteReader;
using core::expect;
using core::get_all;
using core::get_list;
using Pairs = std::vector<Pair>;

void expect_place(std::uint64_t place, std::uint64_t count, const char* what) {
  if (place < count) return;
  throw InvalidSnapshot(std::string("a snapshot names ") + what + " " + std::to_string(place) +
                        "; expected one below " + std::to_string(count));
}

/// Pairs of places below `count`.
Pairs get_pairs(ByteReader& in, std::uint64_t count, const char* things) {
  Pairs pairs = get_list<Pair>(in, things);
  for (const Pair pair : pairs) {
    expect(pair.first < pair.second, "a pair's first place is not below its second");
    expect_place(index(pair.second), count, "a pair of place");
  }
  return pairs;
}

/// Sorted ones, each once.
Pairs get_sorted_pairs(ByteReader& in, std::uint64_t count, const char* things) {
  Pairs pairs = get_pairs(in, count, things);
  expect(std::ranges::adjacent_find(pairs, std::ranges::greater_equal{}) == pairs.end(),
         "pairs that must be sorted are not");
  return pairs;
}

/// Places below `count`, ascending, each once.
std::vector<BoxId> get_places(ByteReader& in, std::uint64_t count, const char* things) {
  std::vector<BoxId> places = get_list<BoxId>(in, things);
  expect(std::ranges::adjacent_find(places, std::ranges::greater_equal{}) == places.end(),
         "places that must ascend do not");
  if (!places.empty()) expect_place(index(places.back()), count, "place");
  return places;
}

}  // namespace

/// Reads the frame that the tracker took last. `now` is the frame it would be shown, in which places outside
/// `listed` are as they were.
template <int D, typename Real>
void World<D, Real>::State::LastFrame::get(ByteReader& in, const Frame<D, Real>& now) {
  const auto flags = in.get<std::uint8_t>();
  expect((flags & ~(snapshot::last_has_filters | snapshot::last_has_ignored)) == 0,
         "the last frame has flags that there are none of");
  const auto count = in.get<std::uint64_t>();
  const std::vector<BoxId> places = get_places(in, count, "boxes that changed");
  // Each place that there is no more is among them: no claim takes more memory than its bytes justify.
  expect(count <= now.boxes.size() + places.size(), "the last frame has more boxes than it says");
  boxes.assign(now.boxes.begin(), now.boxes.end());
  boxes.resize(static_cast<std::size_t>(count), absent_box<D, Real>());
  for (const BoxId id : places) boxes[index(id)] = core::Part<Box<D, Real>>::get(in);
  const bool has_filters = (flags & snapshot::last_has_filters) != 0;
  const std::vector<BoxId> filtered = get_places(in, has_filters ? count : 0, "filters that changed");
  if (has_filters) {
    filters.assign(now.filters.begin(), now.filters.end());
    filters.resize(static_cast<std::size_t>(count));
  }
  for (const BoxId id : filtered) filters[index(id)] = core::Part<Filter>::get(in);
  has_ignored = (flags & snapshot::last_has_ignored) != 0;
  for (const Pair pair : get_sorted_pairs(in, std::uint64_t{1} << 32, "ignored pairs")) ignored.insert(pair);
  expect(has_ignored || ignored.empty(), "the last frame has ignored pairs and no set of them");

  const auto is_listed = [&](BoxId id) { return std::ranges::binary_search(now.changed, id); };
  for (std::uint32_t i = 0; i < now.boxes.size(); ++i) {
    if (i < boxes.size() && boxes[i] == now.boxes[i]) continue;
    expect((i >= boxes.size() && is_absent(now.boxes[i])) || is_listed(BoxId{i}),
           "a box changed and is not in the list of those that did");
  }
  const auto filter_of = [](std::span<const Filter> some, std::size_t i) {
    return i < some.size() ? some[i] : Filter{};
  };
  const std::size_t filtered_boxes = filters.empty() && now.filters.empty() ? 0 : now.boxes.size();
  for (std::uint32_t i = 0; i < filtered_boxes; ++i)
    expect(filter_of(filters, i) == filter_of(now.filters, i) || is_listed(BoxId{i}),
           "a filter changed and is not in the list of boxes that did");
}

template <int D, typename Real>
std::unique_ptr<typename World<D, Real>::State> World<D, Real>::State::get(ByteReader& in, const State& like,
                                                                           LastFrame& last) {
  using namespace snapshot;
  const auto flags = in.get<std::uint32_t>();
  expect((flags & ~all_flags) == 0, "the world has flags that there are none of");
  const auto is_set = [flags](std::uint32_t bit) { return (flags & bit) != 0; };
  if (is_set(has_predicate) != static_cast<bool>(like.predicate)) {
    throw InvalidSnapshot(std::string("a snapshot was taken of a world with") +
                          (is_set(has_predicate) ? "" : "out") + " a predicate and this one has " +
                          (like.predicate ? "one" : "none") +
                          "; expected the same, since none is in a snapshot");
  }
  WorldOptions options = like.options;
  options.keep_pairs = is_set(keeps_pairs);
  options.margin = in.get<double>();
  options.relative_margin = in.version() < 3 ? 0 : in.get<double>();
  options.predicted_frames = in.version() < 3 ? 0 : in.get<double>();
  options.events = is_set(tells_enlarged) ? WorldEvents::enlarged : WorldEvents::exact;
  const std::string algorithm = in.text(in.count(1, "characters of a spec"));
  std::unique_ptr<State> state;
  try {
    if (is_set(has_own_tracker) && like.is_own_tracker) options.algorithm = core::current_spec(algorithm);
    WorldOptions unshadowed = options;
    unshadowed.shadow = false;
    state = std::make_unique<State>(make_own_tracker(unshadowed), options, true);
  } catch (const InvalidSpec& error) {
    throw InvalidSnapshot(std::string("a snapshot's algorithm cannot be made: ") + error.what());
  } catch (const std::invalid_argument& error) {
    throw InvalidSnapshot(std::string("a snapshot's options are refused: ") + error.what());
  }
  state->is_own_tracker = like.is_own_tracker;
  state->is_refining = is_set(refines);
  expect(state->is_refining || (!state->refines_by_boxes() && !is_set(has_predicate)),
         "it has exact pairs of enlarged boxes or a predicate, and does not refine pairs");
  state->uses_filters = is_set(has_filters);
  state->uses_user_data = is_set(has_user_data);
  state->has_updated = is_set(was_updated);
  state->is_settled = is_set(was_settled);
  state->refilters_all = is_set(refilters);
  state->first_generation = in.get<std::uint32_t>();
  state->pair_count = static_cast<std::size_t>(in.get<std::uint64_t>());
  state->get_slots(in);
  state->get_lists(in);
  Frame<D, Real> shown = state->frame();
  std::vector<BoxId> listed(shown.changed.begin(), shown.changed.end());
  std::ranges::sort(listed);
  shown.changed = listed;
  last.get(in, shown);
  state->check_last_frame(last);
  state->get_pairs_and_events(in);
  state->check_pending(is_set(has_predicate));
  return state;
}

template <int D, typename Real>
void World<D, Real>::State::get_slots(ByteReader& in) {
  constexpr std::uint32_t last_generation = std::numeric_limits<std::uint32_t>::max();
  const std::size_t count = in.count(core::Part<Box<D, Real>>::bytes, "slots");
  boxes = get_all<Box<D, Real>>(in, count, "boxes");
  generations = get_all<std::uint32_t>(in, count, "generations");
  in.need(1, count, "states of slots");
  slots.resize(count);
  free.reserve(count);
  for (std::uint32_t slot = 0; slot < count; ++slot) {
    const auto found = in.get<std::uint8_t>();
    expect(found <= static_cast<std::uint8_t>(SlotState::retired), "a slot is in no state that there is");
    slots[slot].state = static_cast<SlotState>(found);
    if (slots[slot].state == SlotState::free) free.insert(slot);
    if (slots[slot].state == SlotState::live) ++size;
    expect(slots[slot].state != SlotState::retired || generations[slot] == last_generation,
           "a slot is used up and has generations left");
    // One that was invalid is live and absent.
    expect(slots[slot].state == SlotState::live || !is_present(boxes[slot]),
           "a slot is not live and has a box");
  }
  most_slots = count;
  if (has_margin()) {
    enlarged = get_all<Box<D, Real>>(in, count, "enlarged boxes");
    for (std::uint32_t slot = 0; slot < count; ++slot) {
      const bool is_there = is_present(boxes[slot]);
      expect(is_there == is_present(enlarged[slot]) &&
                 (!is_there || broadside::contains(enlarged[slot], boxes[slot])),
             "a box is not within its enlarged one");
    }
  }
  if (uses_filters) filters = get_all<Filter>(in, count, "filters");
  if (uses_user_data) user_data = get_all<std::uint64_t>(in, count, "user data");
}

template <int D, typename Real>
void World<D, Real>::State::get_lists(ByteReader& in) {
  const auto get_removed = [&](std::vector<Removed>& list, SlotState its_state, const char* things) {
    const std::size_t count = in.count(4 + core::Part<Box<D, Real>>::bytes, things);
    for (std::size_t i = 0; i < count; ++i) {
      const auto slot = in.get<std::uint32_t>();
      expect_place(slot, slots.size(), "slot");
      const Removed old{slot, core::Part<Box<D, Real>>::get(in)};
      expect(slots[slot].state == its_state, "a slot whose box was removed is in another state");
      slots[slot].place = static_cast<std::uint32_t>(i);
      list.push_back(old);
    }
    for (std::size_t i = 0; i < count; ++i)
      expect(slots[list[i].slot].place == i, "the box of a slot was removed twice");
    const auto there = std::ranges::count(slots, its_state, &Slot::state);
    expect(static_cast<std::size_t>(there) == count, "a slot whose box was removed is not listed");
  };
  get_removed(removed, SlotState::removed, "removed boxes");
  get_removed(reported, SlotState::reported, "boxes whose removal was told");
  const auto get_marked = [&](auto& list, bool Slot::*mark, const char* things) {
    using Place = typename std::decay_t<decltype(list)>::value_type;
    list = get_list<Place>(in, things);
    for (const Place place : list) {
      const auto slot = static_cast<std::uint32_t>(place);
      expect_place(slot, slots.size(), "slot");
      expect(is_paired(slot),
             "a slot is listed as changed and has no box, nor had one since the last update");
      expect(!(slots[slot].*mark), "a slot is listed twice");
      slots[slot].*mark = true;
    }
  };
  get_marked(changed, &Slot::is_changed, "changed boxes");
  get_marked(moved, &Slot::is_moved, "moved boxes");
  expect(has_margin() || moved.empty(), "it has no margin and boxes that left theirs");
  for (const BoxId id : moved)
    expect(slots[index(id)].is_changed, "a box left its enlarged one and did not change");
  for (const Removed& old : removed)
    expect(slots[old.slot].is_changed, "a box was removed and did not change");
  get_marked(refiltered, &Slot::is_refilter, "boxes to be asked about");
  expect(is_refining || (refiltered.empty() && !refilters_all), "it refines no pairs and asks about some");

  const Pairs pairs = get_sorted_pairs(in, slots.size(), "ignored pairs");
  ignored_edges.reserve(pairs.size(), slots.size());
  for (const Pair pair : pairs) {
    expect(slots[index(pair.first)].state == SlotState::live &&
               slots[index(pair.second)].state == SlotState::live,
           "a pair is ignored whose boxes are not both there");
    ignored.insert(pair);
    ignored_edges.insert(pair);
  }
  ignored_changed = get_pairs(in, slots.size(), "pairs ignored anew");
}

template <int D, typename Real>
void World<D, Real>::State::get_pairs_and_events(ByteReader& in) {
  const auto get = [&](const char* things) {
    Pairs pairs = get_sorted_pairs(in, slots.size(), things);
    for (const Pair pair : pairs) expect_paired(pair);
    return pairs;
  };
  const Pairs pairs = get("pairs");
  expect(options.keep_pairs || pairs.empty(), "it keeps no pairs and has some");
  current.add(pairs, {}, generations);
  current.merge(generations);
  for (const Pair pair : get("pairs that began")) begun.push_back({handle(pair.first), handle(pair.second)});
  for (const Pair pair : get_sorted_pairs(in, slots.size(), "pairs that ended")) {
    for (const BoxId id : {pair.first, pair.second})
      expect(is_paired(index(id)) || slots[index(id)].state == SlotState::reported,
             "a pair ended whose boxes can no longer be read");
    ended.push_back({handle(pair.first), handle(pair.second)});
  }

  const Pairs edges = get("pairs of enlarged boxes");
  expect(is_refining || edges.empty(), "it refines no pairs and has some to refine");
  in.need(1, edges.size(), "marks");
  graph.reserve(edges.size(), slots.size());
  for (const Pair pair : edges) {
    const int marks = in.get<std::uint8_t>();
    expect((marks & ~(snapshot::edge_overlaps | snapshot::edge_accepted)) == 0,
           "a pair has no marks like these");
    graph.mark(graph.insert(pair)) = {(marks & snapshot::edge_overlaps) != 0,
                                      (marks & snapshot::edge_accepted) != 0, 0};
  }
  candidates.begun = get("candidates that began");
  candidates.ended = get("candidates that ended");
  refined.begun = get("refined pairs that began");
  refined.ended = get("refined pairs that ended");
  fresh = get_pairs(in, slots.size(), "new candidates");
  expect(is_refining || (refined.empty() && fresh.empty()), "it refines no pairs and has refined some");
}

}  // namespace broadside
