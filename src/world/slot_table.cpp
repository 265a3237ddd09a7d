// SlotTable: the slots of a world, and the handles that name the boxes in them.
#include "world/slot_table.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "broadside/error.hpp"

#include "core/input_check.hpp"
#include "core/message.hpp"

namespace broadside::world {
namespace {

constexpr std::uint32_t last_generation = std::numeric_limits<std::uint32_t>::max();

/// Fewer free slots are not worth dropping, and the memory of fewer slots is not worth giving back.
constexpr std::size_t min_dropped_slots = 64;
constexpr std::size_t min_released_slots = 4096;

}  // namespace

template <int D, typename Real>
bool SlotTable<D, Real>::are_live(std::span<const Handle> handles) const noexcept {
  while (!handles.empty()) {
    const std::span<const Handle> some = handles.first(std::min(handles.size(), handles_at_once));
    handles = handles.subspan(some.size());
    if (are_live_in_a_row(some)) continue;
    for (const Handle handle : some) {
      if (!is_live(handle)) return false;
    }
  }
  return true;
}

/// Whether the handles are live and their slots consecutive. Without branches, so that it becomes vector
/// instructions.
template <int D, typename Real>
bool SlotTable<D, Real>::are_live_in_a_row(std::span<const Handle> handles) const noexcept {
  const std::uint32_t first = handles[0].slot;
  if (first + handles.size() > size() || !are_in_a_row(handles, first)) return false;
  const std::uint32_t* const generations = &generations_[first];
  std::uint32_t differing = 0;
  for (std::size_t i = 0; i < handles.size(); ++i) differing |= handles[i].generation ^ generations[i];
  const SlotState* const states = &states_[first];
  for (std::size_t i = 0; i < handles.size(); ++i)
    differing |= static_cast<std::uint8_t>(states[i]) ^ static_cast<std::uint8_t>(SlotState::live);
  return differing == 0;
}

template <int D, typename Real>
std::uint32_t SlotTable<D, Real>::readable_slot(Handle handle) const {
  if (handle.slot < size() && generations_[handle.slot] == handle.generation) {
    const SlotState state = states_[handle.slot];
    if (state == SlotState::live || state == SlotState::removed || state == SlotState::reported)
      return handle.slot;
  }
  refuse(handle, "read");
}

template <int D, typename Real>
const Box<D, Real>* SlotTable<D, Real>::removed_box(std::uint32_t slot) const noexcept {
  if (states_[slot] == SlotState::removed) return &removed_[places_[slot]].box;
  if (states_[slot] == SlotState::reported) return &reported_[places_[slot]].box;
  return nullptr;
}

template <int D, typename Real>
void SlotTable<D, Real>::refuse(Handle handle, const char* action, const char* times) const {
  // A free slot has not yet issued a handle of its current generation.
  const bool is_up_to_now = handle.slot < size() ? handle.generation < generations_[handle.slot] ||
                                                       (handle.generation == generations_[handle.slot] &&
                                                        states_[handle.slot] != SlotState::free)
                                                 : handle.generation < first_generation_;
  // Generations restored from another world's snapshot may be older than this world's first one.
  const std::uint32_t begin = table_generation_;
  const bool is_before =
      handle.generation < begin && !std::any_of(generations_.begin(), generations_.end(),
                                                [begin](std::uint32_t one) { return one < begin; });
  const char* const why = is_up_to_now && !is_before
                              ? " names a box that was removed"
                              : " was never issued by this world: it belongs to another world or is invalid";
  throw InvalidHandle(
      core::message({"cannot ", action, " a box", times, ": handle (slot ", handle.slot, ", generation ",
                     handle.generation, ")", why, "; expected a box in the world"}));
}

template <int D, typename Real>
std::size_t SlotTable<D, Real>::reserve(std::size_t count) {
  const std::size_t added = count > free_.size() ? count - free_.size() : 0;
  core::check_count(size() + added);
  core::make_room(generations_, added);
  core::make_room(places_, added);
  core::make_room(states_, added);
  free_.reserve(size() + added);
  return added;
}

template <int D, typename Real>
Handle SlotTable<D, Real>::add() noexcept {
  const std::uint32_t slot = next();
  if (slot == size()) {
    generations_.push_back(first_generation_);
    places_.push_back(0);
    states_.push_back(SlotState::live);
  } else {
    free_.erase(slot);
    states_[slot] = SlotState::live;
  }
  ++live_;
  return {slot, generations_[slot]};
}

template <int D, typename Real>
std::span<const RemovedBox<D, Real>> SlotTable<D, Real>::remove(std::span<const Handle> handles,
                                                                std::span<const Box<D, Real>> boxes) {
  core::make_room(removed_, handles.size());
  const std::size_t before = removed_.size();
  // Each handle is read once, because another thread may write to the caller's list. A handle that is listed
  // twice is no longer live the second time.
  for (const Handle handle : handles) {
    if (!is_live(handle)) {
      for (; removed_.size() > before; removed_.pop_back(), ++live_)
        states_[removed_.back().slot] = SlotState::live;
      refuse(handle, "remove", is_live(handle) ? " twice" : "");
    }
    states_[handle.slot] = SlotState::removed;
    places_[handle.slot] = static_cast<std::uint32_t>(removed_.size());
    removed_.push_back({handle.slot, boxes[handle.slot]});
    --live_;
  }
  return removed().subspan(before);
}

template <int D, typename Real>
void SlotTable<D, Real>::recycle() noexcept {
  for (const Removed& old : reported_) {
    if (generations_[old.slot] == last_generation) {
      states_[old.slot] = SlotState::retired;
      continue;
    }
    states_[old.slot] = SlotState::free;
    ++generations_[old.slot];
    free_.insert(old.slot);
  }
  reported_.clear();
  for (const Removed& now : removed_) states_[now.slot] = SlotState::reported;
  std::swap(reported_, removed_);
}

template <int D, typename Real>
bool SlotTable<D, Real>::trim() noexcept {
  max_slots_ = std::max(max_slots_, size());
  if (free_.size() <= std::max(min_dropped_slots, size() / 4)) return false;
  const std::size_t before = size();
  while (!states_.empty() && states_.back() == SlotState::free) {
    // Old handles of this slot stay invalid if it is appended again.
    first_generation_ = std::max(first_generation_, generations_.back());
    free_.erase(static_cast<std::uint32_t>(size() - 1));
    states_.pop_back();
    places_.pop_back();
    generations_.pop_back();
  }
  return size() < before;
}

template <int D, typename Real>
bool SlotTable<D, Real>::is_mostly_gone() const noexcept {
  return max_slots_ > min_released_slots && size() < max_slots_ / 4;
}

template <int D, typename Real>
void SlotTable<D, Real>::shrink_to_fit() {
  max_slots_ = size();
  free_.shrink_to(size());
  core::shrink(generations_, places_, states_, removed_, reported_);
}

template <int D, typename Real>
void SlotTable<D, Real>::restore(std::uint32_t first_generation, std::vector<std::uint32_t> generations,
                                 std::vector<SlotState> states, std::vector<Removed> removed,
                                 std::vector<Removed> reported) {
  first_generation_ = first_generation;
  generations_ = std::move(generations);
  states_ = std::move(states);
  removed_ = std::move(removed);
  reported_ = std::move(reported);
  max_slots_ = size();
  live_ = static_cast<std::size_t>(std::count(states_.begin(), states_.end(), SlotState::live));
  free_ = {};
  free_.reserve(size());
  for (std::uint32_t slot = 0; slot < size(); ++slot) {
    if (states_[slot] == SlotState::free) free_.insert(slot);
  }
  places_.assign(size(), 0);
  for (const std::vector<Removed>* const list : {&removed_, &reported_}) {
    for (std::uint32_t place = 0; place < list->size(); ++place) places_[(*list)[place].slot] = place;
  }
}

template class SlotTable<2, float>;
template class SlotTable<2, double>;
template class SlotTable<3, float>;
template class SlotTable<3, double>;

}  // namespace broadside::world
