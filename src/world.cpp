// World: handles over a tracker's array of boxes.
#include "broadside/world.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

#include "broadside/error.hpp"
#include "broadside/sinks.hpp"

#include "core/input_check.hpp"

namespace broadside {
namespace {

/// Refuses what is no box for add() and move(): an absent one is what remove() is for.
template <int D, typename Real>
void check_present(const Box<D, Real>& box, std::uint32_t slot) {
  if (is_present(box)) return;
  const std::string name = "the box for slot " + std::to_string(slot);
  if (is_absent(box)) throw InvalidInput(slot, name + " is absent; expected a box");
  core::refuse_box(box, slot, name);
}

}  // namespace

template <int D, typename Real>
World<D, Real>::World(std::string_view spec) : World(make_tracker<D, Real>(spec)) {}

template <int D, typename Real>
World<D, Real>::World(std::unique_ptr<PairTracker<D, Real>> tracker) : tracker_(std::move(tracker)) {
  if (!tracker_) throw std::invalid_argument("World was given a null tracker; expected a tracker");
}

template <int D, typename Real>
Handle World<D, Real>::add(const Box<D, Real>& box) {
  const Box<D, Real> added = box;  // the caller's may be one of ours, and those move when the arrays grow
  const auto slot = free_.empty() ? static_cast<std::uint32_t>(slots_.size()) : free_.back();
  check_present(box, slot);
  if (free_.empty()) {
    core::check_count(slots_.size() + 1);
    boxes_.resize(slots_.size() + 1, absent_box<D, Real>());
    slots_.emplace_back();
  } else {
    free_.pop_back();
  }
  mark_changed(slot);
  slots_[slot].state = SlotState::live;
  boxes_[slot] = added;
  ++size_;
  return {slot, slots_[slot].generation};
}

template <int D, typename Real>
void World<D, Real>::move(Handle handle, const Box<D, Real>& box) {
  if (!contains(handle)) refuse(handle, "move");
  check_present(box, handle.slot);
  mark_changed(handle.slot);
  boxes_[handle.slot] = box;
}

template <int D, typename Real>
void World<D, Real>::remove(Handle handle) {
  if (!contains(handle)) refuse(handle, "remove");
  mark_changed(handle.slot);
  last_boxes_.insert_or_assign(handle.slot, boxes_[handle.slot]);
  removed_.push_back(handle.slot);
  boxes_[handle.slot] = absent_box<D, Real>();
  slots_[handle.slot].state = SlotState::removed;
  --size_;
}

template <int D, typename Real>
Events World<D, Real>::update() {
  begun_ids_.clear();
  ended_ids_.clear();
  PairCollector begun(begun_ids_);
  PairCollector ended(ended_ids_);
  tracker_->update({boxes_, changed_}, begun, ended);

  collect(begun_ids_, begun_);
  collect(ended_ids_, ended_);
  if (!begun_.empty() || !ended_.empty()) {
    merged_.clear();
    std::ranges::set_difference(pairs_, ended_, std::back_inserter(merged_));
    pairs_.clear();
    std::ranges::merge(merged_, begun_, std::back_inserter(pairs_));
  }

  // A slot whose removal the last update reported can be used again from here on; one whose removal this
  // update reports, from the next on.
  for (const std::uint32_t slot : reported_) {
    last_boxes_.erase(slot);
    slots_[slot].state = SlotState::free;
    ++slots_[slot].generation;
    free_.push_back(slot);
  }
  reported_.clear();
  for (const std::uint32_t slot : removed_) slots_[slot].state = SlotState::reported;
  std::swap(reported_, removed_);
  for (const BoxId id : changed_) slots_[index(id)].changed = false;
  changed_.clear();
  return {begun_, ended_};
}

template <int D, typename Real>
bool World<D, Real>::contains(Handle handle) const noexcept {
  return handle.slot < slots_.size() && slots_[handle.slot].generation == handle.generation &&
         slots_[handle.slot].state == SlotState::live;
}

template <int D, typename Real>
const Box<D, Real>& World<D, Real>::box(Handle handle) const {
  if (contains(handle)) return boxes_[handle.slot];
  if (handle.slot < slots_.size() && slots_[handle.slot].generation == handle.generation) {
    if (const auto last = last_boxes_.find(handle.slot); last != last_boxes_.end()) return last->second;
  }
  refuse(handle, "read");
}

template <int D, typename Real>
void World<D, Real>::mark_changed(std::uint32_t slot) {
  if (slots_[slot].changed) return;
  changed_.push_back(BoxId{slot});
  slots_[slot].changed = true;
}

template <int D, typename Real>
void World<D, Real>::refuse(Handle handle, const char* action) const {
  const std::string found = "handle (slot " + std::to_string(handle.slot) + ", generation " +
                            std::to_string(handle.generation) + ")";
  // A slot that is free has not yet issued a handle of its own generation.
  const bool issued =
      handle.slot < slots_.size() &&
      (handle.generation < slots_[handle.slot].generation ||
       (handle.generation == slots_[handle.slot].generation && slots_[handle.slot].state != SlotState::free));
  const char* const why = issued ? " names a box that was removed" : " was never issued by this world";
  throw InvalidHandle(std::string("cannot ") + action + " a box: " + found + why +
                      "; expected a box in the world");
}

template <int D, typename Real>
void World<D, Real>::collect(std::span<const Pair> pairs, std::vector<HandlePair>& handles) const {
  handles.clear();
  const auto handle = [this](BoxId id) { return Handle{index(id), slots_[index(id)].generation}; };
  for (const Pair pair : pairs) handles.push_back({handle(pair.first), handle(pair.second)});
}

template class World<2, float>;
template class World<2, double>;
template class World<3, float>;
template class World<3, double>;

}  // namespace broadside
