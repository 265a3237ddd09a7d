// World: checks handles and sets the floating-point environment, and hands on to WorldState and its parts.
#include "broadside/world.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "core/float_environment.hpp"
#include "core/message.hpp"
#include "kernels/overlap_flags.hpp"
#include "world/snapshot_codec.hpp"
#include "world/world_state.hpp"

namespace broadside {
namespace {

WorldOptions with_algorithm(const Spec& spec) {
  WorldOptions options;
  options.algorithm = spec;
  return options;
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

template <int D, typename Real>
World<D, Real>::World(const Spec& spec) : World(with_algorithm(spec)) {}

template <int D, typename Real>
World<D, Real>::World(const WorldOptions& options)
    : state_(std::make_unique<world::WorldState<D, Real>>(world::WorldTracker<D, Real>(options), options)) {}

template <int D, typename Real>
World<D, Real>::World(Tracker<D, Real> tracker, const WorldOptions& options)
    : state_(std::make_unique<world::WorldState<D, Real>>(
          world::WorldTracker<D, Real>(std::move(tracker), options), options)) {}

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
  state_->parts.boxes.check(added, 0, "for slot", state_->parts.slots.next());
  state_->reserve(1, options.filter != Filter{}, options.user_data != 0);
  return state_->add(added, options);
}

template <int D, typename Real>
void World<D, Real>::add(BoxView<D, Real> boxes, std::span<Handle> handles,
                         std::span<const BoxOptions> options) {
  const core::DefaultEnvironment environment;
  state_->add(boxes, handles, options);
}

template <int D, typename Real>
void World<D, Real>::move(Handle handle, const Box<D, Real>& box) {
  const core::DefaultEnvironment environment;
  state_->move(state_->parts.slots.live_slot(handle, "move"), box, nullptr);
}

template <int D, typename Real>
void World<D, Real>::move(Handle handle, const Box<D, Real>& box, const Point<D, Real>& velocity) {
  const core::DefaultEnvironment environment;
  state_->move(state_->parts.slots.live_slot(handle, "move"), box, &velocity);
}

template <int D, typename Real>
void World<D, Real>::move(std::span<const Handle> handles, BoxView<D, Real> boxes,
                          std::span<const Point<D, Real>> velocities) {
  const core::DefaultEnvironment environment;
  state_->move(handles, boxes, velocities);
}

template <int D, typename Real>
void World<D, Real>::remove(Handle handle) {
  state_->remove(std::span(&handle, 1));
}

template <int D, typename Real>
void World<D, Real>::remove(std::span<const Handle> handles) {
  state_->remove(handles);
}

template <int D, typename Real>
void World<D, Real>::shift_origin(const Point<D, Real>& origin) {
  const core::DefaultEnvironment environment;
  state_->shift_origin(origin);
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
  const std::uint32_t slot = state_->parts.slots.readable_slot(handle);
  return state_->parts.keeps_user_data() ? state_->parts.user_data.get(slot) : 0;
}

template <int D, typename Real>
void World<D, Real>::set_user_data(Handle handle, std::uint64_t user_data) {
  const std::uint32_t slot = state_->parts.slots.live_slot(handle, "give user data to");
  state_->reserve(0, false, true);
  state_->parts.user_data.set(slot, user_data);
}

template <int D, typename Real>
void World<D, Real>::list_quarantined(detail::Output<Handle>& output) const {
  const world::WorldParts<D, Real>& parts = state_->parts;
  std::vector<Handle> handles;
  for (std::uint32_t slot = 0; slot < parts.slots.size(); ++slot) {
    if (parts.slots.state(slot) == world::SlotState::live && is_absent(parts.boxes.boxes()[slot]))
      handles.push_back(handle_of(BoxId{slot}));
  }
  std::ranges::copy(handles, output.resize(handles.size()).begin());
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
void World<D, Real>::set_filter(Handle handle, const Filter& filter) {
  state_->set_filter(state_->parts.slots.live_slot(handle, "filter"), filter);
}

template <int D, typename Real>
void World<D, Real>::ignore(Handle a, Handle b) {
  state_->parts.slots.live_slot(a, "ignore a pair of");
  state_->parts.slots.live_slot(b, "ignore a pair of");
  state_->parts.ignored.insert(pair_of(a, b));
}

template <int D, typename Real>
void World<D, Real>::unignore(Handle a, Handle b) {
  if (is_ignored(a, b)) state_->parts.ignored.erase(pair_of(a, b));
}

template <int D, typename Real>
bool World<D, Real>::is_ignored(Handle a, Handle b) const {
  state_->parts.slots.live_slot(a, "look up an ignored pair of");
  state_->parts.slots.live_slot(b, "look up an ignored pair of");
  return state_->parts.ignored.contains(pair_of(a, b));
}

template <int D, typename Real>
void World<D, Real>::set_predicate(PairPredicate predicate) {
  world::WorldParts<D, Real>& parts = state_->parts;
  if (!parts.refiner.is_refining() && parts.has_updated) {
    if (!parts.options.keep_pairs) {
      throw std::logic_error(
          "a predicate was set after the first update of a world that keeps no pairs; expected it before, or "
          "WorldOptions::keep_pairs");
    }
    parts.refiner.adopt(pairs(), parts.slots.size());
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

template <int D, typename Real>
Events World<D, Real>::update() {
  state_->update();
  return state_->parts.events.view();
}

template <int D, typename Real>
void World<D, Real>::shrink_to_fit() {
  state_->wants_release = true;
  // Another tracker has to begin where this one is.
  if (state_->parts.is_settled()) state_->release();
}

template <int D, typename Real>
std::span<const HandlePair> World<D, Real>::pairs() const {
  if (!state_->parts.options.keep_pairs) {
    throw std::logic_error(
        "a world was asked for its pairs and keeps none; expected WorldOptions::keep_pairs, or find_pairs()");
  }
  return state_->parts.current.pairs(state_->parts.slots.generations());
}

template <int D, typename Real>
std::span<const HandlePair> World<D, Real>::persisting() const {
  static_cast<void>(pairs());  // throws if there are none
  return state_->parts.current.persisting(state_->parts.events.begun(), state_->parts.slots.generations());
}

template <int D, typename Real>
void World<D, Real>::overlaps(std::span<const HandlePair> pairs, std::span<std::uint8_t> flags) const {
  const core::DefaultEnvironment environment;
  if (flags.size() != pairs.size()) {
    throw std::invalid_argument(
        core::message({flags.size(), " flags for ", pairs.size(), " pairs; expected one for each"}));
  }
  const world::WorldParts<D, Real>& parts = state_->parts;
  const std::span<const Box<D, Real>> boxes = parts.boxes.boxes();
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
      are_live[i] = parts.slots.is_live(some[i].first) && parts.slots.is_live(some[i].second);
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
  const world::WorldParts<D, Real>& parts = state_->parts;
  // The tracker's own index, if it has one of the boxes as they are now.
  if (!parts.boxes.enlarges() && parts.boxes.changed().empty()) {
    if (const BoxIndex<D, Real>* const trackers = state_->tracker.box_index()) return *trackers;
  }
  return state_->query_index.updated(parts.boxes.boxes(), parts.boxes.filters().values());
}

template <int D, typename Real>
Handle World<D, Real>::handle_of(BoxId slot) const noexcept {
  return state_->parts.slots.handle(slot);
}

template <int D, typename Real>
WorldStatistics World<D, Real>::statistics() const {
  return state_->statistics();
}

template <int D, typename Real>
void World<D, Real>::write_snapshot(detail::Output<std::byte>& bytes) const {
  const core::DefaultEnvironment environment;
  world::SnapshotCodec<D, Real>::encode(state_->parts, state_->tracker, bytes);
}

template <int D, typename Real>
void World<D, Real>::restore(std::span<const std::byte> snapshot) {
  const core::DefaultEnvironment environment;
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
