// SnapshotReader: reads the content of a snapshot, and checks it part by part.
#include "world/snapshot_reader.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "broadside/error.hpp"

#include "core/former_names.hpp"
#include "world/snapshot_format.hpp"

namespace broadside::world {
namespace {

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
    expect_place(index(pair.second), count, "a pair with index");
  }
  return pairs;
}

/// Sorted pairs of places below `count`, each once.
Pairs get_sorted_pairs(ByteReader& in, std::uint64_t count, const char* things) {
  Pairs pairs = get_pairs(in, count, things);
  expect(std::adjacent_find(pairs.begin(), pairs.end(), std::greater_equal<>{}) == pairs.end(),
         "pairs that must be sorted are not");
  return pairs;
}

/// Places below `count`, ascending, each once.
std::vector<BoxId> get_places(ByteReader& in, std::uint64_t count, const char* things) {
  std::vector<BoxId> places = get_list<BoxId>(in, things);
  expect(std::adjacent_find(places.begin(), places.end(), std::greater_equal<>{}) == places.end(),
         "places that must ascend do not");
  if (!places.empty()) expect_place(index(places.back()), count, "place");
  return places;
}

}  // namespace

template <int D, typename Real>
void SnapshotReader<D, Real>::read(const Parts& world, const WorldTracker<D, Real>& tracker) {
  read_options(world, tracker);
  const auto first_generation = in_.get<std::uint32_t>();
  const auto pair_count = static_cast<std::size_t>(in_.get<std::uint64_t>());
  read_slots(first_generation);
  read_changes();
  read_ignored();
  Parts& parts = *decoded_.parts;
  // If nothing is listed and the flag is not set, an update has failed.
  parts.update_failed = !is_set(snapshot::was_settled) && parts.is_settled();
  read_last_frame();
  decoded_.check_last_frame();
  read_pairs(pair_count);
  read_edges();
  parts.refiner.restore(std::move(refiner_), parts.slots.size());
  decoded_.check_pending(is_set(snapshot::was_settled), is_set(snapshot::has_predicate));
}

template <int D, typename Real>
void SnapshotReader<D, Real>::read_options(const Parts& world, const WorldTracker<D, Real>& tracker) {
  using namespace snapshot;
  flags_ = in_.get<std::uint32_t>();
  expect((flags_ & ~all_flags) == 0, "the world has unknown flags");
  if (is_set(has_predicate) != world.refiner.has_predicate()) {
    throw InvalidSnapshot(std::string("a snapshot was taken of a world with") +
                          (is_set(has_predicate) ? "" : "out") + " a predicate, but this one has " +
                          (world.refiner.has_predicate() ? "one" : "none") +
                          "; expected the same, since none is in a snapshot");
  }
  WorldOptions options = world.options;
  options.keep_pairs = is_set(keeps_pairs);
  options.margin = in_.get<double>();
  options.relative_margin = in_.version() < 3 ? 0 : in_.get<double>();
  options.predicted_frames = in_.version() < 3 ? 0 : in_.get<double>();
  options.touching = !is_set(leaves_out_touching);
  options.events = is_set(tells_enlarged) ? WorldEvents::enlarged : WorldEvents::exact;
  const std::string spec = in_.text(in_.count(1, "characters of a spec"));
  try {
    decoded_.spec = tracker.spec();
    if (is_set(has_own_tracker) && tracker.is_own()) {
      decoded_.spec = core::current_spec(spec);
      // Makes a tracker, to see whether it can be made.
      if (decoded_.spec != tracker.spec()) decoded_.spec = tracker.remade(decoded_.spec).spec();
    }
    decoded_.parts = std::make_unique<Parts>(options);
  } catch (const InvalidSpec& error) {
    throw InvalidSnapshot(std::string("a snapshot's algorithm cannot be made: ") + error.what());
  } catch (const std::invalid_argument& error) {
    throw InvalidSnapshot(std::string("a snapshot's options are invalid: ") + error.what());
  }
  decoded_.parts->has_updated = is_set(was_updated);
  refiner_.is_refining = is_set(refines);
  refiner_.asks_about_all = is_set(refilters);
  expect(refiner_.is_refining || (!decoded_.parts->boxes.refines() && !is_set(has_predicate)),
         "it has exact pairs of enlarged boxes or a predicate, but does not refine pairs");
}

template <int D, typename Real>
void SnapshotReader<D, Real>::read_slots(std::uint32_t first_generation) {
  constexpr std::uint32_t max_generation = std::numeric_limits<std::uint32_t>::max();
  const std::size_t count = in_.count(Serializer<Box<D, Real>>::bytes, "slots");
  auto boxes = get_all<Box<D, Real>>(in_, count, "boxes");
  auto generations = get_all<std::uint32_t>(in_, count, "generations");
  auto states = get_all<SlotState>(in_, count, "states of slots");
  for (std::uint32_t slot = 0; slot < count; ++slot) {
    expect(states[slot] <= SlotState::retired, "a slot is in an unknown state");
    expect(states[slot] != SlotState::retired || generations[slot] == max_generation,
           "a slot is used up but has generations left");
    // A quarantined box is live and absent.
    expect(states[slot] == SlotState::live || !is_present(boxes[slot]), "a slot is not live but has a box");
  }
  Parts& parts = *decoded_.parts;
  const auto live = static_cast<std::size_t>(std::count(states.begin(), states.end(), SlotState::live));
  const std::size_t max_boxes = parts.options.max_boxes;
  if (max_boxes != 0 && live > max_boxes)
    throw InvalidSnapshot("a snapshot has " + std::to_string(live) + " boxes; expected at most " +
                          std::to_string(max_boxes) + ", the world's option max_boxes");
  std::vector<Box<D, Real>> enlarged;
  if (parts.boxes.enlarges()) {
    enlarged = get_all<Box<D, Real>>(in_, count, "enlarged boxes");
    for (std::uint32_t slot = 0; slot < count; ++slot) {
      const bool is_there = is_present(boxes[slot]);
      expect(is_there == is_present(enlarged[slot]) &&
                 (!is_there || broadside::contains(enlarged[slot], boxes[slot])),
             "a box is not within its enlarged box");
    }
  }
  parts.boxes.restore(std::move(boxes), std::move(enlarged));
  if (is_set(snapshot::has_filters)) parts.boxes.restore_filters(get_all<Filter>(in_, count, "filters"));
  if (is_set(snapshot::has_user_data))
    parts.user_data.restore(get_all<std::uint64_t>(in_, count, "user data"));
  auto removed = read_removed(states, SlotState::removed, "removed boxes");
  auto reported = read_removed(states, SlotState::reported, "boxes reported as removed");
  parts.slots.restore(first_generation, std::move(generations), std::move(states), std::move(removed),
                      std::move(reported));
}

template <int D, typename Real>
std::vector<RemovedBox<D, Real>> SnapshotReader<D, Real>::read_removed(const std::vector<SlotState>& states,
                                                                       SlotState state, const char* things) {
  const std::size_t count = in_.count(4 + Serializer<Box<D, Real>>::bytes, things);
  std::vector<RemovedBox<D, Real>> list;
  std::vector<bool> is_listed(states.size());
  bool is_twice = false;
  for (std::size_t i = 0; i < count; ++i) {
    const auto slot = in_.get<std::uint32_t>();
    expect_place(slot, states.size(), "slot");
    list.push_back({slot, Serializer<Box<D, Real>>::get(in_)});
    expect(states[slot] == state, "a slot whose box was removed is in another state");
    is_twice |= is_listed[slot];
    is_listed[slot] = true;
  }
  expect(!is_twice, "the box of a slot was removed twice");
  expect(static_cast<std::size_t>(std::count(states.begin(), states.end(), state)) == count,
         "a slot whose box was removed is not listed");
  return list;
}

/// A list of paired slots, each once.
template <int D, typename Real>
std::vector<BoxId> SnapshotReader<D, Real>::read_marked(const char* things) {
  const SlotTable<D, Real>& slots = decoded_.parts->slots;
  std::vector<BoxId> list = get_list<BoxId>(in_, things);
  std::vector<bool> is_listed(slots.size());
  for (const BoxId id : list) {
    expect_place(index(id), slots.size(), "slot");
    expect(slots.is_paired(index(id)),
           "a slot is listed as changed but has no box, nor had one since the last update");
    expect(!is_listed[index(id)], "a slot is listed twice");
    is_listed[index(id)] = true;
  }
  return list;
}

template <int D, typename Real>
void SnapshotReader<D, Real>::read_changes() {
  Parts& parts = *decoded_.parts;
  auto changed = read_marked("changed boxes");
  auto moved = read_marked("moved boxes");
  expect(parts.boxes.enlarges() || moved.empty(), "it has no margin but has boxes that left theirs");
  parts.boxes.restore_changes(std::move(changed), std::move(moved));
  for (const BoxId id : parts.boxes.moved())
    expect(parts.boxes.is_changed(index(id)), "a box left its enlarged box but did not change");
  for (const RemovedBox<D, Real>& old : parts.slots.removed())
    expect(parts.boxes.is_changed(old.slot), "a box was removed but did not change");
  refiner_.asked_slots = read_marked("boxes to be asked about");
  expect(refiner_.is_refining || (refiner_.asked_slots.empty() && !refiner_.asks_about_all),
         "it refines no pairs but asks about some");
}

template <int D, typename Real>
void SnapshotReader<D, Real>::read_ignored() {
  const SlotTable<D, Real>& slots = decoded_.parts->slots;
  const Pairs pairs = get_sorted_pairs(in_, slots.size(), "ignored pairs");
  for (const Pair pair : pairs) {
    expect(slots.state(index(pair.first)) == SlotState::live &&
               slots.state(index(pair.second)) == SlotState::live,
           "an ignored pair has a missing box");
  }
  decoded_.parts->ignored.restore(pairs, get_pairs(in_, slots.size(), "pairs ignored anew"));
}

/// Reads the last frame that the tracker took. Unlisted places are as in the current frame.
template <int D, typename Real>
void SnapshotReader<D, Real>::read_last_frame() {
  const Frame<D, Real> now = decoded_.parts->frame();
  auto& [boxes, filters, ignored, has_ignored] = decoded_.last_frame;
  const auto flags = in_.get<std::uint8_t>();
  expect((flags & ~(snapshot::last_has_filters | snapshot::last_has_ignored)) == 0,
         "the last frame has unknown flags");
  const auto count = in_.get<std::uint64_t>();
  const std::vector<BoxId> places = get_places(in_, count, "boxes that changed");
  // All places that no longer exist are listed, so no claim takes more memory than its bytes justify.
  expect(count <= now.boxes.size() + places.size(), "the last frame has more boxes than it lists");
  boxes.assign(now.boxes.begin(), now.boxes.end());
  boxes.resize(static_cast<std::size_t>(count), absent_box<D, Real>());
  for (const BoxId id : places) boxes[index(id)] = Serializer<Box<D, Real>>::get(in_);
  const bool has_filters = (flags & snapshot::last_has_filters) != 0;
  const std::vector<BoxId> filtered = get_places(in_, has_filters ? count : 0, "filters that changed");
  if (has_filters) {
    filters.assign(now.filters.begin(), now.filters.end());
    filters.resize(static_cast<std::size_t>(count));
  }
  for (const BoxId id : filtered) filters[index(id)] = Serializer<Filter>::get(in_);
  has_ignored = (flags & snapshot::last_has_ignored) != 0;
  for (const Pair pair : get_sorted_pairs(in_, std::uint64_t{1} << 32, "ignored pairs")) ignored.insert(pair);
  expect(has_ignored || ignored.empty(), "the last frame has ignored pairs but no set of them");
}

template <int D, typename Real>
Pairs SnapshotReader<D, Real>::read_paired(const char* things) {
  const SlotTable<D, Real>& slots = decoded_.parts->slots;
  Pairs pairs = get_sorted_pairs(in_, slots.size(), things);
  for (const Pair pair : pairs) {
    if (slots.is_paired(index(pair.first)) && slots.is_paired(index(pair.second))) continue;
    refuse(pair, "has a slot without a box; expected boxes in the world, or removed since the last update");
  }
  return pairs;
}

template <int D, typename Real>
void SnapshotReader<D, Real>::read_pairs(std::size_t pair_count) {
  Parts& parts = *decoded_.parts;
  const SlotTable<D, Real>& slots = parts.slots;
  const Pairs pairs = read_paired("pairs");
  expect(parts.options.keep_pairs || pairs.empty(), "it keeps no pairs but has some");
  const Pairs begun = read_paired("pairs that began");
  const Pairs ended = get_sorted_pairs(in_, slots.size(), "pairs that ended");
  for (const Pair pair : ended) {
    for (const BoxId id : {pair.first, pair.second})
      expect(slots.is_paired(index(id)) || slots.state(index(id)) == SlotState::reported,
             "a pair ended whose boxes can no longer be read");
  }
  parts.current.restore(pairs, pair_count, {begun, ended}, slots.generations());
}

template <int D, typename Real>
void SnapshotReader<D, Real>::read_edges() {
  const std::size_t slots = decoded_.parts->slots.size();
  auto& [is_refining, asks_about_all, asked_slots, graph, candidates, refined, fresh] = refiner_;
  const Pairs edges = read_paired("pairs of enlarged boxes");
  expect(is_refining || edges.empty(), "it refines no pairs but has some to refine");
  in_.need(1, edges.size(), "marks");
  graph.reserve(edges.size(), slots);
  for (const Pair pair : edges) {
    const auto mark = in_.get<std::uint8_t>();
    expect(mark <= edge_holds, "a pair has invalid marks");
    graph.insert(pair, mark);
  }
  candidates.begun = read_paired("candidates that began");
  candidates.ended = read_paired("candidates that ended");
  refined.begun = read_paired("refined pairs that began");
  refined.ended = read_paired("refined pairs that ended");
  fresh = get_pairs(in_, slots, "new candidates");
  expect(is_refining || (refined.empty() && fresh.empty()), "it refines no pairs but has refined some");
}

template class SnapshotReader<2, float>;
template class SnapshotReader<2, double>;
template class SnapshotReader<3, float>;
template class SnapshotReader<3, double>;

}  // namespace broadside::world
