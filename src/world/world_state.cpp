// WorldState: how the parts of a world change together. An update: the tracker's events are candidates; where
// there is a margin or a predicate, they are refined; then they are delivered. Each step first does all that
// can fail and then changes something, so that an update that throws can be tried again.
#include "world/world_state.hpp"

#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/lean.hpp"
#include "core/message.hpp"
#include "core/number_text.hpp"
#include "world/snapshot_codec.hpp"

namespace broadside::world {
namespace {

void check_lengths(std::size_t found, const char* things, std::size_t boxes) {
  if (found == boxes) return;
  throw std::invalid_argument(
      core::message({found, " ", things, " for ", boxes, " boxes; expected one for each"}));
}

}  // namespace

template <int D, typename Real>
WorldState<D, Real>::WorldState(WorldTracker<D, Real> its_tracker, const WorldOptions& options)
    : parts(options), tracker(std::move(its_tracker)) {}

template <int D, typename Real>
void WorldState<D, Real>::add(BoxView<D, Real> boxes, std::span<Handle> handles,
                              std::span<const BoxOptions> options) {
  check_lengths(handles.size(), "handles", boxes.size());
  if (!options.empty()) check_lengths(options.size(), "options", boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    parts.boxes.check(boxes[i], i, "to be added, number", i);
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
  const std::span<const std::byte> own = std::as_bytes(parts.boxes.boxes());
  if (!is_before(boxes.first_byte(), own.data()) && is_before(boxes.first_byte(), own.data() + own.size())) {
    for (std::size_t i = 0; i < boxes.size(); ++i) copies.push_back(boxes[i]);
    boxes = copies;
  }
  reserve(boxes.size(), has_filters, has_user_data);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    handles[i] = add(boxes[i], options.empty() ? BoxOptions{} : options[i]);
}

template <int D, typename Real>
void WorldState<D, Real>::reserve(std::size_t count, bool with_filters, bool with_user_data) {
  const std::size_t added = parts.slots.reserve(count);
  const std::size_t size = parts.slots.size();
  parts.boxes.reserve(added, with_filters);
  parts.boxes.reserve_changes(count);
  query_index.reserve(size + added);
  parts.user_data.reserve(size, added, with_user_data);
  // Nothing is done yet, but from here on these are in use.
  if (with_filters) parts.boxes.use_filters();
  if (with_user_data) parts.user_data.use(size);
}

template <int D, typename Real>
Handle WorldState<D, Real>::add(const Box<D, Real>& box, const BoxOptions& its_options) noexcept {
  const Handle handle = parts.slots.add();
  if (handle.slot == parts.boxes.boxes().size()) {
    parts.boxes.append();
    parts.user_data.append();
  }
  parts.boxes.init_filter(handle.slot, its_options.filter);
  parts.user_data.set(handle.slot, its_options.user_data);
  parts.boxes.set(handle.slot, box, nullptr);
  query_index.mark(handle.slot);
  return handle;
}

template <int D, typename Real>
void WorldState<D, Real>::move(std::span<const Handle> handles, BoxView<D, Real> boxes,
                               std::span<const Point<D, Real>> velocities) {
  check_lengths(handles.size(), "handles", boxes.size());
  if (!velocities.empty()) check_lengths(velocities.size(), "velocities", boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!parts.slots.is_live(handles[i])) parts.slots.refuse(handles[i], "move");
    parts.boxes.check(boxes[i], i, "to be moved to, number", i);
    if (!velocities.empty()) parts.boxes.check_velocity(velocities[i], i, "of the box number", i);
  }
  parts.boxes.reserve_changes(boxes.size());
  parts.boxes.set(handles, boxes, velocities);
  query_index.mark(handles);
}

template <int D, typename Real>
void WorldState<D, Real>::remove(std::span<const Handle> handles) {
  parts.slots.reserve_removals(handles.size());
  parts.boxes.reserve_changes(handles.size());
  parts.ignored.reserve_forgetting();
  // Each handle is read once, because another thread may write to the caller's list. A handle that is listed
  // twice is no longer live the second time.
  const std::size_t removed_before = parts.slots.removed().size();
  for (const Handle handle : handles) {
    if (parts.slots.is_live(handle)) {
      parts.slots.remove(handle.slot, parts.boxes.boxes()[handle.slot]);
      continue;
    }
    parts.slots.undo_removals(removed_before);
    parts.slots.refuse(handle, parts.slots.is_live(handle) ? "remove twice" : "remove");
  }
  for (const auto& removed : parts.slots.removed().subspan(removed_before)) forget(removed.slot);
}

/// Takes a box that was removed from its slot out of everything else.
template <int D, typename Real>
void WorldState<D, Real>::forget(std::uint32_t slot) noexcept {
  parts.boxes.remove(slot);
  parts.ignored.forget(slot);
  query_index.mark(slot);
}

template <int D, typename Real>
void WorldState<D, Real>::shift_origin(const Point<D, Real>& origin) {
  for (int axis = 0; axis < D; ++axis) {
    if (std::isfinite(origin[axis])) continue;
    throw std::invalid_argument(core::message({"coordinate ", axis, " of a new origin is ",
                                               core::text_of(origin[axis]), "; expected a finite number"}));
  }
  parts.boxes.reserve_changes(parts.slots.size());
  const auto shifted = [&origin](Box<D, Real> box) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] -= origin[axis];
      box.max[axis] -= origin[axis];
    }
    return box;
  };
  for (std::uint32_t slot = 0; slot < parts.slots.size(); ++slot) {
    if (parts.slots.state(slot) != SlotState::live) continue;
    parts.boxes.reset(slot, shifted(parts.boxes.boxes()[slot]));
    query_index.mark(slot);
  }
  for (auto& removed : parts.slots.removed()) removed.box = shifted(removed.box);
  for (auto& reported : parts.slots.reported()) reported.box = shifted(reported.box);
}

template <int D, typename Real>
void WorldState<D, Real>::set_filter(std::uint32_t slot, const Filter& filter) {
  if (filter == parts.boxes.filters().get(slot)) return;
  parts.boxes.reserve_changes(1);
  reserve(0, true, false);  // begins to use filters, so it comes last
  parts.boxes.set_filter(slot, filter);
  query_index.mark(slot);
}

template <int D, typename Real>
void WorldState<D, Real>::update() {
  if constexpr (!core::is_lean) tracker.lead_back();
  query_index.drop_outdated(parts.slots.size());
  parts.update_failed = true;
  tracker.update(parts.frame(), parts.refiner.candidates());
  parts.has_updated = true;
  deliver(parts.refiner.refine(parts.slots, parts.boxes));
  settle();
}

/// Makes the events the world's.
template <int D, typename Real>
void WorldState<D, Real>::deliver(PairEvents& pairs) {
  const std::span<const std::uint32_t> generations = parts.slots.generations();
  parts.events.reserve(pairs, parts.keeps_user_data());
  parts.current.add(pairs.begun, pairs.ended, generations);
  parts.events.set(pairs, generations, parts.user_data);
  pairs.clear();
}

/// Ends an update.
template <int D, typename Real>
void WorldState<D, Real>::settle() noexcept {
  parts.slots.recycle();
  parts.boxes.settle();
  parts.ignored.settle();
  parts.refiner.settle();
  parts.update_failed = false;
  if (parts.slots.trim()) {
    parts.boxes.shorten(parts.slots.size());
    parts.user_data.shorten(parts.slots.size());
  }
  if (!wants_release && !parts.slots.is_mostly_gone()) return;
  try {
    release();
  } catch (...) {
    // Memory is short already, or an executor threw: the memory stays as it is.
  }
}

template <int D, typename Real>
void WorldState<D, Real>::release() {
  wants_release = false;
  if (parts.has_updated) tracker.renew(parts.frame());
  parts.current.shrink_to_fit(parts.slots.generations());
  query_index.drop();
  joined.drop();
  parts.slots.shrink_to_fit();
  parts.boxes.shrink_to_fit();
  parts.user_data.shrink_to_fit();
  parts.ignored.shrink_to_fit();
  parts.refiner.shrink_to_fit();
  parts.events.shrink_to_fit();
}

template <int D, typename Real>
WorldStatistics WorldState<D, Real>::statistics() const {
  WorldStatistics statistics;
  statistics.boxes = parts.slots.live();
  statistics.slots = parts.slots.size();
  statistics.pairs = parts.current.size();
  statistics.begun = parts.events.begun().size();
  statistics.ended = parts.events.ended().size();
  statistics.enlarged_pairs = parts.refiner.state().graph.size();
  statistics.ignored_pairs = parts.ignored.size();
  statistics.tracker = tracker.statistics();
  statistics.explanation = tracker.explanation();
  WorldBytes& bytes = statistics.bytes;
  bytes.boxes = parts.boxes.bytes() + parts.slots.removed_bytes();
  bytes.slots = parts.slots.bytes() + parts.user_data.bytes() + parts.boxes.list_bytes();
  bytes.filters = parts.boxes.filter_bytes() + parts.ignored.bytes();
  bytes.pairs = parts.events.bytes() + parts.refiner.bytes() + parts.current.bytes();
  bytes.tracker = tracker.bytes();
  bytes.queries = query_index.bytes();
  return statistics;
}

template <int D, typename Real>
void WorldState<D, Real>::restore(std::span<const std::byte> bytes) {
  using Codec = SnapshotCodec<D, Real>;
  const typename Codec::Decoded decoded = Codec::decode(bytes, parts, tracker);
  WorldParts<D, Real>& restored = *decoded.parts;
  query_index.mark_differences(parts.boxes.boxes(), parts.boxes.filters().values(), restored.boxes.boxes(),
                               restored.boxes.filters().values());
  std::optional<WorldTracker<D, Real>> another;
  if (decoded.spec != tracker.spec()) another.emplace(tracker.remade(decoded.spec));
  WorldTracker<D, Real>& led = another ? *another : tracker;
  auto known = another ? std::vector<Pair>{} : parts.tracked_pairs();
  try {
    Codec::check_pairs(restored, led.lead_to(decoded.last_frame, std::move(known)));
  } catch (...) {
    led.undo();
    throw;
  }
  // Nothing below throws.
  led.stay();
  if (another) tracker = std::move(*another);
  restored.refiner.take_predicate(parts.refiner);
  parts = std::move(restored);
  wants_release = false;
}

template class WorldState<2, float>;
template class WorldState<2, double>;
template class WorldState<3, float>;
template class WorldState<3, double>;

}  // namespace broadside::world
