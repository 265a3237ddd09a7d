// WorldState: calls that concern several parts of a world and are longer than a few lines.
#include "world/world_state.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "core/message.hpp"
#include "kernels/overlap_flags.hpp"
#include "world/snapshot_codec.hpp"

namespace broadside::world {

template <int D, typename Real>
void WorldState<D, Real>::refuse_from_predicate(const char* function) const {
  if (!is_updating) return;
  throw std::logic_error(
      core::message({"a predicate called World::", function, "(); expected one that only reads the world"}));
}

template <int D, typename Real>
void WorldState<D, Real>::reserve(std::size_t count, bool with_filters, bool with_user_data) {
  const std::size_t max_boxes = parts.options.max_boxes;
  if (max_boxes != 0 && count > max_boxes - std::min(max_boxes, parts.slots.live()))
    throw InvalidFrame(core::message({parts.slots.live() + count, " boxes in a world; expected at most ",
                                      max_boxes, ", its option max_boxes"}));
  const std::size_t added = parts.slots.reserve(count);
  const std::size_t size = parts.slots.size();
  parts.boxes.reserve(added, with_filters);
  parts.boxes.reserve_changes(count);
  query_index.reserve(size + added);
  parts.user_data.reserve(size, added, with_user_data);
  // Nothing is added yet, but from here on these are in use.
  if (with_filters) parts.boxes.use_filters();
  if (with_user_data) parts.user_data.use(size);
}

template <int D, typename Real>
Handle WorldState<D, Real>::add(const Box<D, Real>& box, const BoxOptions& options) noexcept {
  const Handle handle = parts.slots.add();
  if (handle.slot == parts.boxes.boxes().size()) {
    parts.boxes.append();
    parts.user_data.append();
  }
  parts.boxes.init_filter(handle.slot, options.filter);
  parts.user_data.set(handle.slot, options.user_data);
  parts.boxes.set(handle.slot, box, nullptr);
  query_index.mark(handle.slot);
  return handle;
}

template <int D, typename Real>
void WorldState<D, Real>::add(BoxView<D, Real> boxes, std::span<Handle> handles,
                              std::span<const BoxOptions> options) {
  const BoxTable<D, Real>& table = parts.boxes;
  for (std::size_t i = 0; i < boxes.size(); ++i) table.check(boxes[i], i, "added box", i);
  bool has_filters = false;
  bool has_user_data = false;
  for (const BoxOptions& its : options) {
    has_filters |= its.filter != Filter{};
    has_user_data |= its.user_data != 0;
  }
  // If the given boxes are in the world's own arrays, they move when these grow.
  std::vector<Box<D, Real>> copies;
  const std::less<const std::byte*> is_before;
  const std::span<const std::byte> own = std::as_bytes(table.boxes());
  if (!is_before(boxes.first_byte(), own.data()) && is_before(boxes.first_byte(), own.data() + own.size())) {
    for (std::size_t i = 0; i < boxes.size(); ++i) copies.push_back(boxes[i]);
    boxes = copies;
  }
  reserve(boxes.size(), has_filters, has_user_data);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    handles[i] = add(boxes[i], options.empty() ? BoxOptions{} : options[i]);
}

template <int D, typename Real>
void WorldState<D, Real>::shift_origin(const Point<D, Real>& origin) {
  parts.boxes.reserve_changes(parts.slots.size());
  // A half-open box is lowered again after the shift, or rounding would raise its maximum to the next tile.
  const auto shifted = [&](Box<D, Real> box) {
    for (int axis = 0; axis < D; ++axis) {
      if (!parts.options.touching && box.min[axis] < box.max[axis] && std::isfinite(box.max[axis]))
        box.max[axis] = -broadside::detail::next_below(-box.max[axis]);
      box.min[axis] -= origin[axis];
      box.max[axis] -= origin[axis];
    }
    return parts.boxes.as_kept(box);
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
void WorldState<D, Real>::release_if_due() noexcept {
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
  parts.current.shrink_to_fit();
  query_index.drop();
  joiner.reset();
  parts.slots.shrink_to_fit();
  parts.boxes.shrink_to_fit();
  parts.user_data.shrink_to_fit();
  parts.ignored.shrink_to_fit();
  parts.refiner.shrink_to_fit();
}

template <int D, typename Real>
void WorldState<D, Real>::set_overlap_flags(std::span<const HandlePair> pairs,
                                            std::span<std::uint8_t> flags) const {
  const std::span<const Box<D, Real>> boxes = parts.boxes.boxes();
  if (boxes.empty()) std::fill(flags.begin(), flags.end(), std::uint8_t{0});
  std::array<Pair, 256> places;
  std::array<std::uint8_t, places.size()> are_live;
  for (std::size_t begin = 0; begin < pairs.size() && !boxes.empty(); begin += places.size()) {
    const auto some = pairs.subspan(begin, std::min(places.size(), pairs.size() - begin));
    for (std::size_t i = 0; i < some.size(); ++i) {
      are_live[i] = parts.slots.is_live(some[i].first) && parts.slots.is_live(some[i].second);
      places[i] = are_live[i] != 0 ? slots_of(some[i]) : Pair{};
    }
    kernels::set_overlap_flags(boxes, std::span<const Pair>(places).first(some.size()), &flags[begin]);
    for (std::size_t i = 0; i < some.size(); ++i) flags[begin + i] &= are_live[i];
  }
}

template <int D, typename Real>
void WorldState<D, Real>::join(const WorldState& other, detail::Output<HandlePair>& pairs) {
  // The kept finder serves one reader at a time.
  const std::unique_lock lock(joining, std::try_to_lock);
  std::optional<Finder<D, Real>> another;
  std::optional<Finder<D, Real>>& finder = lock.owns_lock() ? joiner : another;
  if (!finder) finder.emplace(tracker.spec());
  finder->set_workers(tracker.workers());
  std::span<HandlePair> handles = pairs.resize(0);
  const auto collect = [&](std::span<const Pair> found) {
    const std::size_t size = handles.size();
    handles = pairs.resize(size + found.size());
    std::transform(found.begin(), found.end(), handles.begin() + static_cast<std::ptrdiff_t>(size),
                   [&](Pair pair) {
                     return HandlePair{parts.slots.handle(pair.first), other.parts.slots.handle(pair.second)};
                   });
  };
  const BoxTable<D, Real>& left = parts.boxes;
  const BoxTable<D, Real>& right = other.parts.boxes;
  finder->find_between(left.boxes(), right.boxes(), collect,
                       {left.filters().values(), right.filters().values()});
  std::sort(handles.begin(), handles.end());
}

template <int D, typename Real>
WorldStatistics WorldState<D, Real>::statistics() const {
  WorldStatistics statistics;
  statistics.boxes = parts.slots.live();
  statistics.slots = parts.slots.size();
  statistics.pairs = parts.current.size();
  statistics.begun = parts.current.events().begun.size();
  statistics.ended = parts.current.events().ended.size();
  statistics.enlarged_pairs = parts.refiner.state().graph.size();
  statistics.ignored_pairs = parts.ignored.size();
  statistics.tracker = tracker.statistics();
  statistics.explanation = tracker.explanation();
  WorldBytes& bytes = statistics.bytes;
  bytes.boxes = parts.boxes.bytes() + parts.slots.removed_bytes();
  bytes.slots = parts.slots.bytes() + parts.user_data.bytes() + parts.boxes.list_bytes();
  bytes.filters = parts.boxes.filter_bytes() + parts.ignored.bytes();
  bytes.pairs = parts.refiner.bytes() + parts.current.bytes();
  bytes.tracker = tracker.bytes();
  bytes.queries = query_index.bytes();
  return statistics;
}

template <int D, typename Real>
void WorldState<D, Real>::restore(std::span<const std::byte> bytes) {
  const auto decoded = SnapshotCodec<D, Real>::decode(bytes, parts, tracker);
  WorldParts<D, Real>& restored = *decoded.parts;
  query_index.mark_differences(parts.boxes, restored.boxes);
  std::optional<WorldTracker<D, Real>> another;
  if (decoded.spec != tracker.spec()) another.emplace(tracker.remade(decoded.spec));
  WorldTracker<D, Real>& led = another ? *another : tracker;
  // A new tracker knows no pairs. If a world neither refines nor keeps pairs, they have to be found.
  std::optional<std::vector<Pair>> known;
  if (another)
    known.emplace();
  else if (parts.refiner.is_refining())
    known = parts.refiner.tracked({});
  else if (parts.current.keeps())
    known = parts.refiner.tracked(parts.current.slot_pairs());
  led.lead_to(decoded.last_frame, std::move(known),
              [&decoded](const std::vector<Pair>& pairs) { decoded.check_pairs(pairs); });
  // Nothing below throws.
  if (another) {
    tracker = std::move(*another);
    joiner.reset();
  }
  restored.refiner.take_predicate(parts.refiner);
  parts = std::move(restored);
  wants_release = false;
}

template struct WorldState<2, float>;
template struct WorldState<2, double>;
template struct WorldState<3, float>;
template struct WorldState<3, double>;

}  // namespace broadside::world
