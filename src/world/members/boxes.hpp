// World: slots, their boxes, and the handles that name them.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "broadside/debug/shadow.hpp"
#include "broadside/error.hpp"
#include "broadside/world.hpp"

#include "core/float_environment.hpp"
#include "core/message.hpp"
#include "core/number_text.hpp"
#include "interface/input_check.hpp"
#include "world/state.hpp"

namespace broadside {
template <int D, typename Real>
Handle World<D, Real>::add(const Box<D, Real>& box, const BoxOptions& options) {
  const core::DefaultEnvironment environment;
  const Box<D, Real> added = box;  // the caller's may be one of ours, and those move when the arrays grow
  state_->check_box(added, 0, "for slot", state_->next_slot());
  state_->reserve(1, options.filter != Filter{}, options.user_data != 0);
  return state_->add_valid(added, options);
}

template <int D, typename Real>
void World<D, Real>::move(Handle handle, const Box<D, Real>& box) {
  const core::DefaultEnvironment environment;
  const std::uint32_t slot = state_->live_slot(handle, "move");
  state_->check_box(box, 0, "for slot", slot);
  state_->reserve_moves(1);
  state_->set_box(slot, box);
}

template <int D, typename Real>
void World<D, Real>::move(Handle handle, const Box<D, Real>& box, const Point<D, Real>& velocity) {
  const core::DefaultEnvironment environment;
  const std::uint32_t slot = state_->live_slot(handle, "move");
  state_->check_box(box, 0, "for slot", slot);
  state_->check_velocity(velocity, 0, "for slot", slot);
  state_->reserve_moves(1);
  state_->set_box(slot, box, &velocity);
}

template <int D, typename Real>
void World<D, Real>::remove(Handle handle) {
  const std::uint32_t slot = state_->live_slot(handle, "remove");
  state_->reserve_removals(1, state_->ignored_edges.size());
  state_->list_removed(slot);
  state_->clear_removed(slot);
}

template <int D, typename Real>
bool World<D, Real>::contains(Handle handle) const noexcept {
  return state_->is_live(handle);
}

template <int D, typename Real>
const Box<D, Real>& World<D, Real>::box(Handle handle) const {
  using SlotState = typename State::SlotState;
  const std::uint32_t slot = state_->readable_slot(handle);
  switch (state_->slots[slot].state) {
    case SlotState::removed:
      return state_->removed[state_->slots[slot].place].box;
    case SlotState::reported:
      return state_->reported[state_->slots[slot].place].box;
    default:
      return state_->boxes[slot];
  }
}

template <int D, typename Real>
const Box<D, Real>& World<D, Real>::enlarged_box(Handle handle) const {
  const std::uint32_t slot = state_->live_slot(handle, "read the enlarged box of");
  return state_->has_margin() ? state_->enlarged[slot] : state_->boxes[slot];
}

template <int D, typename Real>
std::uint64_t World<D, Real>::user_data(Handle handle) const {
  const std::uint32_t slot = state_->readable_slot(handle);
  return !state_->keeps_user_data() ? 0 : state_->user_data[slot];
}

template <int D, typename Real>
void World<D, Real>::set_user_data(Handle handle, std::uint64_t user_data) {
  const std::uint32_t slot = state_->live_slot(handle, "give user data to");
  state_->reserve(0, false, true);
  state_->user_data[slot] = user_data;
}

template <int D, typename Real>
std::size_t World<D, Real>::size() const noexcept {
  return state_->size;
}

template <int D, typename Real>
std::size_t World<D, Real>::slots() const noexcept {
  return state_->slots.size();
}

template <int D, typename Real>
bool World<D, Real>::State::is_live(Handle handle) const noexcept {
  return handle.slot < slots.size() && generations[handle.slot] == handle.generation &&
         slots[handle.slot].state == SlotState::live;
}

template <int D, typename Real>
std::uint32_t World<D, Real>::State::live_slot(Handle handle, const char* action) const {
  if (!is_live(handle)) refuse(handle, action);
  return handle.slot;
}

template <int D, typename Real>
std::uint32_t World<D, Real>::State::readable_slot(Handle handle) const {
  if (handle.slot < slots.size() && generations[handle.slot] == handle.generation) {
    const SlotState state = slots[handle.slot].state;
    if (state == SlotState::live || state == SlotState::removed || state == SlotState::reported)
      return handle.slot;
  }
  refuse(handle, "read");
}

template <int D, typename Real>
void World<D, Real>::State::refuse(Handle handle, const char* action) const {
  // A slot that is free has not yet issued a handle of its own generation.
  const bool is_up_to_now = handle.slot < slots.size() ? handle.generation < generations[handle.slot] ||
                                                             (handle.generation == generations[handle.slot] &&
                                                              slots[handle.slot].state != SlotState::free)
                                                       : handle.generation < first_generation;
  // Generations restored from another world's snapshot may be older than this world's first one.
  const std::uint32_t begin = options.first_generation;
  const bool is_before =
      handle.generation < begin &&
      !std::ranges::any_of(generations, [begin](std::uint32_t one) { return one < begin; });
  const char* const why = is_up_to_now && !is_before
                              ? " names a box that was removed"
                              : " was never issued by this world: it is another world's or made up";
  throw InvalidHandle(core::message({"cannot ", action, " a box: handle (slot ", handle.slot, ", generation ",
                                     handle.generation, ")", why, "; expected a box in the world"}));
}

/// Refuses what is no box for add() and move(): an absent one is what remove() is for. `index` is the box's
/// in the array that it was handed in with; `whose` and `number` name it.
template <int D, typename Real>
void World<D, Real>::State::check_box(const Box<D, Real>& box, std::size_t index, const char* whose,
                                      std::size_t number) const {
  if (is_present(box)) return;
  if (quarantines() && !is_absent(box)) return;
  const std::string name = core::message({"the box ", whose, " ", number});
  if (is_absent(box)) throw InvalidInput(index, core::message({name, " is absent; expected a box"}));
  throw InvalidInput(index, core::fault_of(box, name, false));
}

/// The slot that the next box gets: the lowest free one, so that the arrays stay dense.
template <int D, typename Real>
std::uint32_t World<D, Real>::State::next_slot() const noexcept {
  return free.empty() ? static_cast<std::uint32_t>(slots.size()) : free.lowest();
}

/// Reserves all that adding `count` boxes takes, so that it cannot fail half way.
template <int D, typename Real>
void World<D, Real>::State::reserve(std::size_t count, bool with_filters, bool with_user_data) {
  const std::size_t added = count > free.size() ? count - free.size() : 0;
  core::check_count(slots.size() + added);
  make_room(boxes, added);
  make_room(generations, added);
  make_room(slots, added);
  reserve_moves(count);
  query_index.reserve(slots.size() + added);
  if (has_margin()) make_room(enlarged, added);
  if (with_filters || uses_filters) make_room(filters, slots.size() - filters.size() + added);
  if (with_user_data || keeps_user_data()) make_room(user_data, slots.size() - user_data.size() + added);
  free.reserve(slots.size() + added);
  // Nothing is done yet, but from here on these are in use.
  if (with_filters) filters.resize(slots.size());
  if (with_user_data) user_data.resize(slots.size());
  uses_filters |= with_filters;
  uses_user_data |= with_user_data;
}

template <int D, typename Real>
Handle World<D, Real>::State::add_valid(const Box<D, Real>& box, const BoxOptions& its_options) noexcept {
  const std::uint32_t slot = next_slot();
  if (slot == slots.size()) {
    boxes.push_back(absent_box<D, Real>());
    if (has_margin()) enlarged.push_back(absent_box<D, Real>());
    generations.push_back(first_generation);
    slots.emplace_back();
    if (uses_filters) filters.emplace_back();
    if (keeps_user_data()) user_data.emplace_back();
  } else {
    free.erase(slot);
  }
  slots[slot].state = SlotState::live;
  if (uses_filters) filters[slot] = its_options.filter;
  if (keeps_user_data()) user_data[slot] = its_options.user_data;
  set_box(slot, box);
  ++size;
  return {slot, generations[slot]};
}

template <int D, typename Real>
void World<D, Real>::State::check_velocity(const Point<D, Real>& velocity, std::size_t index,
                                           const char* whose, std::size_t number) const {
  if (margins.frames == 0) {
    throw std::logic_error(
        "a velocity was given to a world that predicts no frames; expected WorldOptions::predicted_frames "
        "above 0, or no velocity");
  }
  for (int axis = 0; axis < D; ++axis) {
    if (std::isfinite(velocity[axis])) continue;
    throw InvalidInput(index,
                       core::message({"coordinate ", axis, " of the velocity ", whose, " ", number, " is ",
                                      core::text_of(velocity[axis]), "; expected a finite number"}));
  }
}

/// Makes all the room that set_box() takes for `count` boxes.
template <int D, typename Real>
void World<D, Real>::State::reserve_moves(std::size_t count) {
  make_room(changed, count);
  if (has_margin()) make_room(moved, count);
}

/// Moves a box out of its enlarged one, and enlarges it anew. Apart from set_box(), which is then small
/// enough for the compiler to inline it.
template <int D, typename Real>
void World<D, Real>::State::set_outside(std::uint32_t slot, const Box<D, Real>& box,
                                        const Point<D, Real>* velocity) noexcept {
  boxes[slot] = box;
  mark_changed(slot);
  mark_moved(slot);
  enlarged[slot] = margins.enlarged(box, velocity);
}

/// In the default environment, and with room for what it lists. Where only enlarged boxes make pairs, a move
/// within one concerns nothing but queries.
template <int D, typename Real>
inline void World<D, Real>::State::set_box(std::uint32_t slot, const Box<D, Real>& given,
                                           const Point<D, Real>* velocity) noexcept {
  // Where invalid ones are not quarantined, it has been checked.
  const Box<D, Real> box = quarantines() && !is_present(given) ? absent_box<D, Real>() : given;
  if (has_margin() && !margins.keeps(enlarged[slot], box, velocity)) return set_outside(slot, box, velocity);
  boxes[slot] = box;
  if (!has_margin() || refines_by_boxes())
    mark_changed(slot);
  else
    query_index.mark(slot);
}

/// set_box() for many, where each is valid and there is no margin: lists them without a branch.
template <int D, typename Real>
void World<D, Real>::State::set_boxes(std::span<const Handle> handles, BoxView<D, Real> given) noexcept {
  if (given.empty()) return;
  is_settled = false;
  const std::size_t listed = changed.size();
  changed.resize(listed + given.size());
  BoxId* next = changed.data() + listed;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const std::uint32_t slot = handles[i].slot;
    if (slot >= slots.size()) continue;  // written by another thread since it was checked
    boxes[slot] = given[i];
    *next = BoxId{slot};
    next += static_cast<std::size_t>(!slots[slot].is_changed);
    slots[slot].is_changed = true;
  }
  changed.resize(static_cast<std::size_t>(next - changed.data()));
  if (!query_index.exists()) return;
  for (const Handle handle : handles) query_index.mark(handle.slot);
}

/// Makes all the room that removing `count` boxes takes, which may be part of `ignored_count` ignored pairs.
template <int D, typename Real>
void World<D, Real>::State::reserve_removals(std::size_t count, std::size_t ignored_count) {
  make_room(changed, count);
  make_room(moved, count);
  make_room(removed, count);
  make_room(ignored_changed, ignored_count);
}

template <int D, typename Real>
void World<D, Real>::State::list_removed(std::uint32_t slot) noexcept {
  slots[slot].state = SlotState::removed;
  slots[slot].place = static_cast<std::uint32_t>(removed.size());
  removed.push_back({slot, boxes[slot]});
}

/// Removes a box that list_removed() has listed from everything else.
template <int D, typename Real>
void World<D, Real>::State::clear_removed(std::uint32_t slot) noexcept {
  mark_changed(slot);
  boxes[slot] = absent_box<D, Real>();
  if (has_margin()) {
    mark_moved(slot);
    enlarged[slot] = absent_box<D, Real>();
  }
  ignored_edges.for_each_of(BoxId{slot}, [this](core::PairGraph::EdgeId edge) {
    const Pair pair = ignored_edges.pair(edge);
    ignored.erase(pair);
    ignored_changed.push_back(pair);
    ignored_edges.erase(edge);
  });
  --size;
}

template <int D, typename Real>
void World<D, Real>::State::mark_changed(std::uint32_t slot) noexcept {
  is_settled = false;
  query_index.mark(slot);
  if (slots[slot].is_changed) return;
  slots[slot].is_changed = true;
  changed.push_back(BoxId{slot});
}

template <int D, typename Real>
void World<D, Real>::State::mark_moved(std::uint32_t slot) noexcept {
  if (slots[slot].is_moved) return;
  slots[slot].is_moved = true;
  moved.push_back(BoxId{slot});
}

}  // namespace broadside
