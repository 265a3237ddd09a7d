// World: what each call does to the parts of a world. Each call first does all that can fail and then changes
// something, so that a call that throws can be tried again.
#include "broadside/world.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/float_environment.hpp"
#include "core/message.hpp"
#include "core/number_text.hpp"
#include "world/snapshot_codec.hpp"
#include "world/world_state.hpp"

namespace broadside {
namespace {

/// The pair of two boxes in the world. Throws InvalidHandle, which names the `action`, if one is not there.
template <int D, typename Real>
Pair live_pair(const world::SlotTable<D, Real>& slots, Handle a, Handle b, const char* action) {
  const std::uint32_t first = slots.live_slot(a, action);
  const std::uint32_t second = slots.live_slot(b, action);
  if (first == second) {
    throw std::invalid_argument(
        core::message({"a pair to be ignored has slot ", first, " twice; expected two different boxes"}));
  }
  return {BoxId{std::min(first, second)}, BoxId{std::max(first, second)}};
}

void check_lengths(std::size_t found, const char* things, std::size_t count, const char* expected) {
  if (found == count) return;
  throw std::invalid_argument(
      core::message({found, " ", things, " for ", count, " ", expected, "; expected one for each"}));
}

/// Sets a flag as long as it exists.
class Updating {
 public:
  explicit Updating(bool& flag) noexcept : flag_(flag) { flag_ = true; }
  Updating(const Updating&) = delete;
  Updating& operator=(const Updating&) = delete;
  ~Updating() { flag_ = false; }

 private:
  bool& flag_;
};

}  // namespace

template <int D, typename Real>
struct BROADSIDE_HIDDEN World<D, Real>::State final : world::WorldState<D, Real> {
  using world::WorldState<D, Real>::WorldState;
};

template <int D, typename Real>
World<D, Real>::World(const Spec& spec) : World(WorldOptions{.algorithm = spec}) {}

template <int D, typename Real>
World<D, Real>::World(const WorldOptions& options)
    : state_(std::make_unique<State>(world::WorldTracker<D, Real>(options), options)) {}

template <int D, typename Real>
World<D, Real>::World(Tracker<D, Real> tracker, const WorldOptions& options)
    : state_(std::make_unique<State>(world::WorldTracker<D, Real>(std::move(tracker), options), options)) {}

template <int D, typename Real>
World<D, Real>::World(World&& other) noexcept = default;
template <int D, typename Real>
World<D, Real>& World<D, Real>::operator=(World&& other) noexcept = default;
template <int D, typename Real>
World<D, Real>::~World() = default;

template <int D, typename Real>
Handle World<D, Real>::add(const Box<D, Real>& box, const BoxOptions& options) {
  const core::DefaultEnvironment environment;
  state_->refuse_from_predicate("add");
  const Box<D, Real> added = box;  // a copy: `box` may be in one of our arrays, which may grow
  state_->parts.boxes.check(added, 0, "the box for slot", state_->parts.slots.next());
  state_->reserve(1, options.filter != Filter{}, options.user_data != 0);
  return state_->add(added, options);
}

template <int D, typename Real>
void World<D, Real>::add(BoxView<D, Real> boxes, std::span<Handle> handles,
                         std::span<const BoxOptions> options) {
  const core::DefaultEnvironment environment;
  state_->refuse_from_predicate("add");
  check_lengths(handles.size(), "handles", boxes.size(), "boxes");
  if (!options.empty()) check_lengths(options.size(), "options", boxes.size(), "boxes");
  state_->add(boxes, handles, options);
}

template <int D, typename Real>
void World<D, Real>::move_to(Handle handle, const Box<D, Real>& box, const Point<D, Real>* velocity) {
  const core::DefaultEnvironment environment;
  state_->refuse_from_predicate("move");
  world::BoxTable<D, Real>& boxes = state_->parts.boxes;
  const std::uint32_t slot = state_->parts.slots.live_slot(handle, "move");
  boxes.check(box, 0, "the box for slot", slot);
  if (velocity != nullptr) boxes.check_velocity(*velocity, 0, "for slot", slot);
  boxes.reserve_changes(1);
  boxes.set(slot, box, velocity);
  state_->query_index.mark(slot);
}

template <int D, typename Real>
void World<D, Real>::move(std::span<const Handle> handles, BoxView<D, Real> boxes,
                          std::span<const Point<D, Real>> velocities) {
  const core::DefaultEnvironment environment;
  state_->refuse_from_predicate("move");
  world::WorldParts<D, Real>& parts = state_->parts;
  check_lengths(handles.size(), "handles", boxes.size(), "boxes");
  if (!velocities.empty()) check_lengths(velocities.size(), "velocities", boxes.size(), "boxes");
  if (!velocities.empty() || !parts.slots.are_live(handles) || !parts.boxes.are_present(boxes)) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      parts.slots.live_slot(handles[i], "move");
      parts.boxes.check(boxes[i], i, "target box", i);
      if (!velocities.empty()) parts.boxes.check_velocity(velocities[i], i, "of target box", i);
    }
  }
  parts.boxes.reserve_changes(boxes.size());
  parts.boxes.set(handles, boxes, velocities);
  state_->query_index.mark(handles);
}

template <int D, typename Real>
void World<D, Real>::remove(std::span<const Handle> handles) {
  state_->refuse_from_predicate("remove");
  world::WorldParts<D, Real>& parts = state_->parts;
  parts.boxes.reserve_changes(handles.size());
  parts.ignored.reserve_forgetting();
  for (const auto& removed : parts.slots.remove(handles, parts.boxes.boxes())) {
    parts.boxes.remove(removed.slot);
    parts.ignored.forget(removed.slot);
    state_->query_index.mark(removed.slot);
  }
}

template <int D, typename Real>
void World<D, Real>::shift_origin(const Point<D, Real>& origin) {
  const core::DefaultEnvironment environment;
  for (int axis = 0; axis < D; ++axis) {
    if (std::isfinite(origin[axis])) continue;
    throw std::invalid_argument(core::message({"coordinate ", axis, " of a new origin is ",
                                               core::text_of(origin[axis]), "; expected a finite number"}));
  }
  state_->refuse_from_predicate("shift_origin");
  state_->shift_origin(origin);
}

template <int D, typename Real>
void World<D, Real>::set_filter(Handle handle, const Filter& filter) {
  state_->refuse_from_predicate("set_filter");
  world::BoxTable<D, Real>& boxes = state_->parts.boxes;
  const std::uint32_t slot = state_->parts.slots.live_slot(handle, "filter");
  if (filter == boxes.filters().get(slot)) return;
  boxes.reserve_changes(1);
  state_->reserve(0, true, false);  // begins to use filters, so it comes last
  boxes.set_filter(slot, filter);
  state_->query_index.mark(slot);
}

template <int D, typename Real>
void World<D, Real>::set_user_data(Handle handle, std::uint64_t user_data) {
  const std::uint32_t slot = state_->parts.slots.live_slot(handle, "give user data to");
  state_->reserve(0, false, true);
  state_->parts.user_data.set(slot, user_data);
}

template <int D, typename Real>
void World<D, Real>::ignore(Handle a, Handle b) {
  state_->parts.ignored.insert(live_pair(state_->parts.slots, a, b, "ignore a pair of"));
}

template <int D, typename Real>
void World<D, Real>::unignore(Handle a, Handle b) {
  state_->parts.ignored.erase(live_pair(state_->parts.slots, a, b, "stop ignoring a pair of"));
}

template <int D, typename Real>
bool World<D, Real>::is_ignored(Handle a, Handle b) const {
  return state_->parts.ignored.contains(live_pair(state_->parts.slots, a, b, "look up a pair of"));
}

template <int D, typename Real>
void World<D, Real>::set_predicate(PairPredicate predicate) {
  state_->refuse_from_predicate("set_predicate");
  world::WorldParts<D, Real>& parts = state_->parts;
  if (!parts.refiner.is_refining() && parts.has_updated) {
    if (!parts.options.keep_pairs) {
      throw std::logic_error(
          "a predicate was set after the first update of a world that keeps no pairs; expected it before, or "
          "WorldOptions::keep_pairs");
    }
    parts.refiner.adopt(parts.current.slot_pairs(), parts.slots.size());
  }
  parts.refiner.swap_predicate(predicate);
}

template <int D, typename Real>
void World<D, Real>::refilter(Handle handle) {
  state_->parts.refiner.ask_again(state_->parts.slots.live_slot(handle, "refilter"), slots());
}

template <int D, typename Real>
void World<D, Real>::refilter() {
  state_->parts.refiner.ask_again();
}

/// The tracker's events are candidates. They are refined if there is a margin or a predicate.
template <int D, typename Real>
Events World<D, Real>::update() {
  state_->refuse_from_predicate("update");
  const Updating updating(state_->is_updating);
  world::WorldParts<D, Real>& parts = state_->parts;
  state_->query_index.drop_outdated(parts.slots.size());
  parts.update_failed = true;
  state_->tracker.update(parts.frame(), parts.refiner.candidates());
  parts.has_updated = true;
  world::PairEvents& events = parts.refiner.refine(parts.boxes, parts.slots.generations());
  parts.current.take(events, parts.slots.generations(), parts.user_data);
  // Nothing below throws.
  parts.update_failed = false;
  parts.slots.recycle();
  parts.boxes.settle();
  parts.ignored.settle();
  parts.refiner.settle();
  if (parts.slots.trim()) {
    parts.boxes.shorten(parts.slots.size());
    parts.user_data.shorten(parts.slots.size());
  }
  state_->release_if_due();
  return parts.current.events();
}

template <int D, typename Real>
std::span<const HandlePair> World<D, Real>::pairs() const {
  if (!state_->parts.options.keep_pairs) {
    throw std::logic_error(
        "the world does not keep its pairs; expected WorldOptions::keep_pairs, or find_pairs()");
  }
  return state_->parts.current.pairs(state_->parts.slots.generations());
}

template <int D, typename Real>
std::span<const HandlePair> World<D, Real>::persisting() const {
  static_cast<void>(pairs());  // throws if none are kept
  return state_->parts.current.persisting(state_->parts.slots.generations());
}

template <int D, typename Real>
void World<D, Real>::overlaps(std::span<const HandlePair> pairs, std::span<std::uint8_t> flags) const {
  const core::DefaultEnvironment environment;
  check_lengths(flags.size(), "flags", pairs.size(), "pairs");
  state_->set_overlap_flags(pairs, flags);
}

template <int D, typename Real>
void World<D, Real>::join_into(const World& other, detail::Output<HandlePair>& pairs) const {
  state_->join(*other.state_, pairs);
}

template <int D, typename Real>
const BoxIndex<D, Real>& World<D, Real>::box_index() const {
  const world::BoxTable<D, Real>& boxes = state_->parts.boxes;
  // The tracker's own index, if it has one of the boxes as they are now.
  if (!boxes.enlarges() && boxes.changed().empty()) {
    if (const BoxIndex<D, Real>* const trackers = state_->tracker.box_index()) return *trackers;
  }
  return state_->query_index.updated(boxes);
}

template <int D, typename Real>
Box<D, Real> World<D, Real>::as_kept(const Box<D, Real>& box) const noexcept {
  const core::DefaultEnvironment environment;
  return state_->parts.boxes.as_kept(box);
}

template <int D, typename Real>
Handle World<D, Real>::handle_of(BoxId slot) const noexcept {
  return state_->parts.slots.handle(slot);
}

template <int D, typename Real>
bool World<D, Real>::contains(Handle handle) const noexcept {
  return state_->parts.slots.is_live(handle);
}

template <int D, typename Real>
const Box<D, Real>& World<D, Real>::box(Handle handle) const {
  const std::uint32_t slot = state_->parts.slots.readable_slot(handle);
  const Box<D, Real>* const removed = state_->parts.slots.removed_box(slot);
  return removed != nullptr ? *removed : state_->parts.boxes.boxes()[slot];
}

template <int D, typename Real>
const Box<D, Real>& World<D, Real>::enlarged_box(Handle handle) const {
  return state_->parts.boxes.shown()[state_->parts.slots.live_slot(handle, "read the enlarged box of")];
}

template <int D, typename Real>
Filter World<D, Real>::filter(Handle handle) const {
  return state_->parts.boxes.filters().get(state_->parts.slots.readable_slot(handle));
}

template <int D, typename Real>
std::uint64_t World<D, Real>::user_data(Handle handle) const {
  return state_->parts.user_data.get(state_->parts.slots.readable_slot(handle));
}

template <int D, typename Real>
void World<D, Real>::list_quarantined(detail::Output<Handle>& output) const {
  const world::WorldParts<D, Real>& parts = state_->parts;
  std::vector<Handle> handles;
  for (std::uint32_t slot = 0; slot < parts.slots.size(); ++slot) {
    if (parts.slots.state(slot) == world::SlotState::live && is_absent(parts.boxes.boxes()[slot]))
      handles.push_back(handle_of(BoxId{slot}));
  }
  std::copy(handles.begin(), handles.end(), output.resize(handles.size()).begin());
}

template <int D, typename Real>
std::size_t World<D, Real>::size() const noexcept {
  return state_->parts.slots.live();
}

template <int D, typename Real>
std::size_t World<D, Real>::slots() const noexcept {
  return state_->parts.slots.size();
}

template <int D, typename Real>
WorldStatistics World<D, Real>::statistics() const {
  return state_->statistics();
}

template <int D, typename Real>
void World<D, Real>::shrink_to_fit() {
  state_->wants_release = true;
  // The new tracker begins with the current frame, so no change may be pending.
  if (state_->parts.is_settled()) state_->release();
}

template <int D, typename Real>
void World<D, Real>::write_snapshot(detail::Output<std::byte>& bytes) const {
  const core::DefaultEnvironment environment;
  world::SnapshotCodec<D, Real>::encode(state_->parts, state_->tracker, bytes);
}

template <int D, typename Real>
void World<D, Real>::restore(std::span<const std::byte> snapshot) {
  const core::DefaultEnvironment environment;
  state_->refuse_from_predicate("restore");
  state_->restore(snapshot);
}

template <int D, typename Real>
const Workers& World<D, Real>::workers() const noexcept {
  return state_->tracker.workers();
}

template <int D, typename Real>
void World<D, Real>::set_workers(const Workers& workers) {
  state_->tracker.set_workers(workers);
}

template class World<2, float>;
template class World<2, double>;
template class World<3, float>;
template class World<3, double>;

}  // namespace broadside
