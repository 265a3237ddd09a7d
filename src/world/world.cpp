// World: how its parts work together. What an update does: the tracker's events are candidates; where there
// is a margin or a predicate, they are refined; then they are delivered. Each step first does all that can
// fail and then changes something, so that an update that throws can be tried again.
#include "broadside/world.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/float_environment.hpp"
#include "core/lean.hpp"
#include "core/message.hpp"
#include "core/number_text.hpp"
#include "kernels/overlap_flags.hpp"
#include "world/query_index.hpp"
#include "world/snapshot_codec.hpp"
#include "world/world_join.hpp"
#include "world/world_parts.hpp"
#include "world/world_tracker.hpp"

namespace broadside {
namespace {

WorldOptions with_algorithm(const Spec& spec) {
  WorldOptions options;
  options.algorithm = spec;
  return options;
}

void check_lengths(std::size_t found, const char* things, std::size_t boxes) {
  if (found == boxes) return;
  throw std::invalid_argument(
      core::message({found, " ", things, " for ", boxes, " boxes; expected one for each"}));
}

/// The pair of two boxes that are in the world.
Pair pair_of(Handle a, Handle b) {
  if (a.slot == b.slot) {
    throw std::invalid_argument(
        core::message({"a pair to be ignored has slot ", a.slot, " twice; expected two different boxes"}));
  }
  return {BoxId{std::min(a.slot, b.slot)}, BoxId{std::max(a.slot, b.slot)}};
}

}  // namespace

/// The parts that a snapshot holds, and what serves them.
template <int D, typename Real>
struct BROADSIDE_HIDDEN World<D, Real>::State : world::WorldParts<D, Real> {
  State(world::WorldTracker<D, Real> its_tracker, const WorldOptions& its_options)
      : world::WorldParts<D, Real>(its_options), tracker(std::move(its_tracker)) {}

  /// Makes room for `count` calls of add(), with a first filter and first user data if there are such.
  void reserve(std::size_t count, bool with_filters, bool with_user_data);
  Handle add(const Box<D, Real>& box, const BoxOptions& its_options) noexcept;
  void reserve_removals(std::size_t count);
  void forget(std::uint32_t slot) noexcept;
  void deliver(world::PairEvents& pairs);
  void settle() noexcept;
  void release();
  world::JoinSide<D, Real> join_side() const noexcept {
    return {this->boxes.boxes(), this->boxes.filters().values(), this->slots.generations()};
  }

  world::WorldTracker<D, Real> tracker;
  bool wants_release = false;  // by the next update
  mutable world::WorldJoin<D, Real> joined;
  mutable world::QueryIndex<D, Real> query_index;
};

template <int D, typename Real>
World<D, Real>::World(const Spec& spec) : World(with_algorithm(spec)) {}

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
  const Box<D, Real> added = box;  // the caller's may be one of ours, and those move when the arrays grow
  state_->boxes.check(added, 0, "for slot", state_->slots.next());
  state_->reserve(1, options.filter != Filter{}, options.user_data != 0);
  return state_->add(added, options);
}

template <int D, typename Real>
void World<D, Real>::add(BoxView<D, Real> boxes, std::span<Handle> handles,
                         std::span<const BoxOptions> options) {
  const core::DefaultEnvironment environment;
  check_lengths(handles.size(), "handles", boxes.size());
  if (!options.empty()) check_lengths(options.size(), "options", boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    state_->boxes.check(boxes[i], i, "to be added, number", i);
  }
  bool has_filters = false;
  bool has_user_data = false;
  for (const BoxOptions& its : options) {
    has_filters |= its.filter != Filter{};
    has_user_data |= !core::is_lean && its.user_data != 0;
  }
  // Where the boxes given are the world's own, they move when its arrays grow.
  std::vector<Box<D, Real>> copies;
  const std::less<const std::byte*> is_before;
  const std::span<const std::byte> own = std::as_bytes(state_->boxes.boxes());
  if (!is_before(boxes.first_byte(), own.data()) && is_before(boxes.first_byte(), own.data() + own.size())) {
    for (std::size_t i = 0; i < boxes.size(); ++i) copies.push_back(boxes[i]);
    boxes = copies;
  }
  state_->reserve(boxes.size(), has_filters, has_user_data);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    handles[i] = state_->add(boxes[i], options.empty() ? BoxOptions{} : options[i]);
}

template <int D, typename Real>
void World<D, Real>::State::reserve(std::size_t count, bool with_filters, bool with_user_data) {
  const std::size_t added = this->slots.reserve(count);
  const std::size_t size = this->slots.size();
  this->boxes.reserve(added, with_filters);
  this->boxes.reserve_changes(count);
  query_index.reserve(size + added);
  this->user_data.reserve(size, added, with_user_data);
  // Nothing is done yet, but from here on these are in use.
  if (with_filters) this->boxes.use_filters();
  if (with_user_data) this->user_data.use(size);
}

template <int D, typename Real>
Handle World<D, Real>::State::add(const Box<D, Real>& box, const BoxOptions& its_options) noexcept {
  const Handle handle = this->slots.add();
  if (handle.slot == this->boxes.boxes().size()) {
    this->boxes.append();
    this->user_data.append();
  }
  this->boxes.init_filter(handle.slot, its_options.filter);
  this->user_data.set(handle.slot, its_options.user_data);
  this->boxes.set(handle.slot, box, nullptr);
  query_index.mark(handle.slot);
  return handle;
}

template <int D, typename Real>
void World<D, Real>::move(Handle handle, const Box<D, Real>& box) {
  const core::DefaultEnvironment environment;
  const std::uint32_t slot = state_->slots.live_slot(handle, "move");
  state_->boxes.check(box, 0, "for slot", slot);
  state_->boxes.reserve_changes(1);
  state_->boxes.set(slot, box, nullptr);
  state_->query_index.mark(slot);
}

template <int D, typename Real>
void World<D, Real>::move(Handle handle, const Box<D, Real>& box, const Point<D, Real>& velocity) {
  const core::DefaultEnvironment environment;
  const std::uint32_t slot = state_->slots.live_slot(handle, "move");
  state_->boxes.check(box, 0, "for slot", slot);
  state_->boxes.check_velocity(velocity, 0, "for slot", slot);
  state_->boxes.reserve_changes(1);
  state_->boxes.set(slot, box, &velocity);
  state_->query_index.mark(slot);
}

template <int D, typename Real>
void World<D, Real>::move(std::span<const Handle> handles, BoxView<D, Real> boxes,
                          std::span<const Point<D, Real>> velocities) {
  const core::DefaultEnvironment environment;
  State& state = *state_;
  check_lengths(handles.size(), "handles", boxes.size());
  if (!velocities.empty()) check_lengths(velocities.size(), "velocities", boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!state.slots.is_live(handles[i])) state.slots.refuse(handles[i], "move");
    state.boxes.check(boxes[i], i, "to be moved to, number", i);
    if (!velocities.empty()) state.boxes.check_velocity(velocities[i], i, "of the box number", i);
  }
  state.boxes.reserve_changes(boxes.size());
  state.boxes.set(handles, boxes, velocities);
  state.query_index.mark(handles);
}

template <int D, typename Real>
void World<D, Real>::remove(Handle handle) {
  State& state = *state_;
  const std::uint32_t slot = state.slots.live_slot(handle, "remove");
  state.reserve_removals(1);
  state.slots.remove(slot, state.boxes.boxes()[slot]);
  state.forget(slot);
}

template <int D, typename Real>
void World<D, Real>::remove(std::span<const Handle> handles) {
  State& state = *state_;
  state.reserve_removals(handles.size());
  // Each handle is read once, because another thread may write to the caller's list. A handle that is listed
  // twice is no longer live the second time.
  const std::size_t removed_before = state.slots.removed().size();
  for (const Handle handle : handles) {
    if (state.slots.is_live(handle)) {
      state.slots.remove(handle.slot, state.boxes.boxes()[handle.slot]);
      continue;
    }
    state.slots.undo_removals(removed_before);
    state.slots.refuse(handle, state.slots.is_live(handle) ? "remove twice" : "remove");
  }
  for (const auto& removed : state.slots.removed().subspan(removed_before)) state.forget(removed.slot);
}

template <int D, typename Real>
void World<D, Real>::State::reserve_removals(std::size_t count) {
  this->slots.reserve_removals(count);
  this->boxes.reserve_changes(count);
  this->ignored.reserve_forgetting();
}

/// Takes a box that was removed from its slot out of everything else.
template <int D, typename Real>
void World<D, Real>::State::forget(std::uint32_t slot) noexcept {
  this->boxes.remove(slot);
  this->ignored.forget(slot);
  query_index.mark(slot);
}

template <int D, typename Real>
void World<D, Real>::shift_origin(const Point<D, Real>& origin) {
  const core::DefaultEnvironment environment;
  State& state = *state_;
  for (int axis = 0; axis < D; ++axis) {
    if (std::isfinite(origin[axis])) continue;
    throw std::invalid_argument(core::message({"coordinate ", axis, " of a new origin is ",
                                               core::text_of(origin[axis]), "; expected a finite number"}));
  }
  state.boxes.reserve_changes(state.slots.size());
  const auto shifted = [&origin](Box<D, Real> box) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] -= origin[axis];
      box.max[axis] -= origin[axis];
    }
    return box;
  };
  for (std::uint32_t slot = 0; slot < state.slots.size(); ++slot) {
    if (state.slots.state(slot) != world::SlotState::live) continue;
    state.boxes.reset(slot, shifted(state.boxes.boxes()[slot]));
    state.query_index.mark(slot);
  }
  for (auto& removed : state.slots.removed()) removed.box = shifted(removed.box);
  for (auto& reported : state.slots.reported()) reported.box = shifted(reported.box);
}

template <int D, typename Real>
bool World<D, Real>::contains(Handle handle) const noexcept {
  return state_->slots.is_live(handle);
}

template <int D, typename Real>
const Box<D, Real>& World<D, Real>::box(Handle handle) const {
  const std::uint32_t slot = state_->slots.readable_slot(handle);
  const Box<D, Real>* const removed = state_->slots.removed_box(slot);
  return removed != nullptr ? *removed : state_->boxes.boxes()[slot];
}

template <int D, typename Real>
const Box<D, Real>& World<D, Real>::enlarged_box(Handle handle) const {
  return state_->boxes.shown()[state_->slots.live_slot(handle, "read the enlarged box of")];
}

template <int D, typename Real>
Filter World<D, Real>::filter(Handle handle) const {
  return state_->boxes.filters().get(state_->slots.readable_slot(handle));
}

template <int D, typename Real>
std::uint64_t World<D, Real>::user_data(Handle handle) const {
  const std::uint32_t slot = state_->slots.readable_slot(handle);
  return state_->keeps_user_data() ? state_->user_data.get(slot) : 0;
}

template <int D, typename Real>
void World<D, Real>::set_user_data(Handle handle, std::uint64_t user_data) {
  const std::uint32_t slot = state_->slots.live_slot(handle, "give user data to");
  state_->reserve(0, false, true);
  state_->user_data.set(slot, user_data);
}

template <int D, typename Real>
void World<D, Real>::list_quarantined(detail::Output<Handle>& output) const {
  const State& state = *state_;
  std::vector<Handle> handles;
  for (std::uint32_t slot = 0; slot < state.slots.size(); ++slot) {
    if (state.slots.state(slot) == world::SlotState::live && is_absent(state.boxes.boxes()[slot]))
      handles.push_back(handle_of(BoxId{slot}));
  }
  std::ranges::copy(handles, output.resize(handles.size()).begin());
}

template <int D, typename Real>
std::size_t World<D, Real>::size() const noexcept {
  return state_->slots.live();
}

template <int D, typename Real>
std::size_t World<D, Real>::slots() const noexcept {
  return state_->slots.size();
}

template <int D, typename Real>
void World<D, Real>::set_filter(Handle handle, const Filter& filter) {
  State& state = *state_;
  const std::uint32_t slot = state.slots.live_slot(handle, "filter");
  if (filter == state.boxes.filters().get(slot)) return;
  state.reserve(0, true, false);
  state.boxes.reserve_changes(1);
  state.boxes.set_filter(slot, filter);
  state.query_index.mark(slot);
}

template <int D, typename Real>
void World<D, Real>::ignore(Handle a, Handle b) {
  state_->slots.live_slot(a, "ignore a pair of");
  state_->slots.live_slot(b, "ignore a pair of");
  state_->ignored.insert(pair_of(a, b));
}

template <int D, typename Real>
void World<D, Real>::unignore(Handle a, Handle b) {
  if (is_ignored(a, b)) state_->ignored.erase(pair_of(a, b));
}

template <int D, typename Real>
bool World<D, Real>::is_ignored(Handle a, Handle b) const {
  state_->slots.live_slot(a, "look up an ignored pair of");
  state_->slots.live_slot(b, "look up an ignored pair of");
  return state_->ignored.contains(pair_of(a, b));
}

template <int D, typename Real>
void World<D, Real>::set_predicate(PairPredicate predicate) {
  State& state = *state_;
  if (!state.refiner.is_refining() && state.has_updated) {
    if (!state.options.keep_pairs) {
      throw std::logic_error(
          "a predicate was set after the first update of a world that keeps no pairs; expected it before, or "
          "WorldOptions::keep_pairs");
    }
    state.refiner.adopt(pairs(), state.slots.size());
  }
  state.refiner.swap_predicate(predicate);
}

template <int D, typename Real>
void World<D, Real>::refilter(Handle handle) {
  state_->refiner.ask_again(state_->slots.live_slot(handle, "refilter"), slots());
}

template <int D, typename Real>
void World<D, Real>::refilter() {
  state_->refiner.ask_again();
}

template <int D, typename Real>
Events World<D, Real>::update() {
  State& state = *state_;
  if constexpr (!core::is_lean) state.tracker.lead_back();
  state.query_index.drop_outdated(state.slots.size());
  state.update_failed = true;
  state.tracker.update(state.frame(), state.refiner.candidates());
  state.has_updated = true;
  state.deliver(state.refiner.refine(state.slots, state.boxes));
  state.settle();
  return state.events.view();
}

/// Makes the events the world's.
template <int D, typename Real>
void World<D, Real>::State::deliver(world::PairEvents& pairs) {
  const std::span<const std::uint32_t> generations = this->slots.generations();
  this->events.reserve(pairs, this->keeps_user_data());
  this->current.add(pairs.begun, pairs.ended, generations);
  this->events.set(pairs, generations, this->user_data);
  pairs.clear();
}

/// Ends an update.
template <int D, typename Real>
void World<D, Real>::State::settle() noexcept {
  this->slots.recycle();
  this->boxes.settle();
  this->ignored.settle();
  this->refiner.settle();
  this->update_failed = false;
  if (this->slots.trim()) {
    this->boxes.shorten(this->slots.size());
    this->user_data.shorten(this->slots.size());
  }
  if (!wants_release && !this->slots.is_mostly_gone()) return;
  try {
    release();
  } catch (...) {
    // Memory is short already, or an executor threw: the memory stays as it is.
  }
}

template <int D, typename Real>
void World<D, Real>::shrink_to_fit() {
  state_->wants_release = true;
  // Another tracker has to begin where this one is.
  if (state_->is_settled()) state_->release();
}

template <int D, typename Real>
void World<D, Real>::State::release() {
  wants_release = false;
  if (this->has_updated) tracker.renew(this->frame());
  this->current.shrink_to_fit(this->slots.generations());
  query_index.drop();
  joined.drop();
  this->slots.shrink_to_fit();
  this->boxes.shrink_to_fit();
  this->user_data.shrink_to_fit();
  this->ignored.shrink_to_fit();
  this->refiner.shrink_to_fit();
  this->events.shrink_to_fit();
}

template <int D, typename Real>
std::span<const HandlePair> World<D, Real>::pairs() const {
  if (!state_->options.keep_pairs) {
    throw std::logic_error(
        "a world was asked for its pairs and keeps none; expected WorldOptions::keep_pairs, or find_pairs()");
  }
  return state_->current.pairs(state_->slots.generations());
}

template <int D, typename Real>
std::span<const HandlePair> World<D, Real>::persisting() const {
  pairs();  // throws if there are none
  return state_->current.persisting(state_->events.begun(), state_->slots.generations());
}

template <int D, typename Real>
void World<D, Real>::overlaps(std::span<const HandlePair> pairs, std::span<std::uint8_t> flags) const {
  const core::DefaultEnvironment environment;
  if (flags.size() != pairs.size()) {
    throw std::invalid_argument(
        core::message({flags.size(), " flags for ", pairs.size(), " pairs; expected one for each"}));
  }
  const State& state = *state_;
  const std::span<const Box<D, Real>> boxes = state.boxes.boxes();
  constexpr std::size_t at_once = 256;
  std::array<Pair, at_once> places;
  std::array<std::uint8_t, at_once> are_live;
  for (std::size_t begin = 0; begin < pairs.size(); begin += at_once) {
    const std::span<const HandlePair> some = pairs.subspan(begin, std::min(at_once, pairs.size() - begin));
    std::uint8_t* const its_flags = flags.data() + begin;
    if (boxes.empty()) {
      std::fill_n(its_flags, some.size(), std::uint8_t{0});
      continue;
    }
    for (std::size_t i = 0; i < some.size(); ++i) {
      are_live[i] = state.slots.is_live(some[i].first) && state.slots.is_live(some[i].second);
      places[i] = are_live[i] != 0 ? Pair{BoxId{some[i].first.slot}, BoxId{some[i].second.slot}} : Pair{};
    }
    kernels::set_overlap_flags(boxes, std::span<const Pair>(places).first(some.size()), its_flags);
    for (std::size_t i = 0; i < some.size(); ++i) its_flags[i] &= are_live[i];
  }
}

template <int D, typename Real>
void World<D, Real>::join_into(const World& other, detail::Output<HandlePair>& pairs) const {
  state_->joined.join(state_->join_side(), other.state_->join_side(), state_->tracker.spec(), workers(),
                      pairs);
}

template <int D, typename Real>
const BoxIndex<D, Real>& World<D, Real>::box_index() const {
  const State& state = *state_;
  // The tracker's own index, if it has one of the boxes as they are now.
  if (!state.boxes.enlarges() && state.boxes.changed().empty()) {
    if (const BoxIndex<D, Real>* const trackers = state.tracker.box_index()) return *trackers;
  }
  return state.query_index.updated(state.boxes.boxes(), state.boxes.filters().values());
}

template <int D, typename Real>
Handle World<D, Real>::handle_of(BoxId slot) const noexcept {
  return state_->slots.handle(slot);
}

template <int D, typename Real>
WorldStatistics World<D, Real>::statistics() const {
  const State& state = *state_;
  WorldStatistics statistics;
  statistics.boxes = size();
  statistics.slots = slots();
  statistics.pairs = state.current.size();
  statistics.begun = state.events.begun().size();
  statistics.ended = state.events.ended().size();
  statistics.enlarged_pairs = state.refiner.state().graph.size();
  statistics.ignored_pairs = state.ignored.size();
  statistics.tracker = state.tracker.statistics();
  statistics.explanation = state.tracker.explanation();
  WorldBytes& bytes = statistics.bytes;
  bytes.boxes = state.boxes.bytes() + state.slots.removed_bytes();
  bytes.slots = state.slots.bytes() + state.user_data.bytes() + state.boxes.list_bytes();
  bytes.filters = state.boxes.filter_bytes() + state.ignored.bytes();
  bytes.pairs = state.events.bytes() + state.refiner.bytes() + state.current.bytes();
  bytes.tracker = state.tracker.bytes();
  bytes.queries = state.query_index.bytes();
  return statistics;
}

template <int D, typename Real>
void World<D, Real>::write_snapshot(detail::Output<std::byte>& bytes) const {
  const core::DefaultEnvironment environment;
  world::SnapshotCodec<D, Real>::encode(*state_, state_->tracker, bytes);
}

template <int D, typename Real>
void World<D, Real>::restore(std::span<const std::byte> bytes) {
  using Codec = world::SnapshotCodec<D, Real>;
  const core::DefaultEnvironment environment;
  State& state = *state_;
  const typename Codec::Decoded decoded = Codec::decode(bytes, state, state.tracker);
  world::WorldParts<D, Real>& restored = *decoded.parts;
  state.query_index.mark_differences(state.boxes.boxes(), state.boxes.filters().values(),
                                     restored.boxes.boxes(), restored.boxes.filters().values());
  std::optional<world::WorldTracker<D, Real>> another;
  if (decoded.spec != state.tracker.spec()) another.emplace(state.tracker.remade(decoded.spec));
  world::WorldTracker<D, Real>& tracker = another ? *another : state.tracker;
  auto known = another ? std::vector<Pair>{} : state.tracked_pairs();
  try {
    Codec::check_pairs(restored, tracker.lead_to(decoded.last_frame, std::move(known)));
  } catch (...) {
    tracker.undo();
    throw;
  }
  // Nothing below throws.
  tracker.stay();
  if (another) state.tracker = std::move(*another);
  restored.refiner.take_predicate(state.refiner);
  static_cast<world::WorldParts<D, Real>&>(state) = std::move(restored);
  state.wants_release = false;
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
