// World: many boxes at once, all or none; and all of them in a new origin.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

#include "core/float_environment.hpp"
#include "core/message.hpp"
#include "core/number_text.hpp"
#include "world/state.hpp"

namespace broadside {
namespace {

void check_lengths(std::size_t found, const char* things, std::size_t boxes) {
  if (found == boxes) return;
  throw std::invalid_argument(
      core::message({found, " ", things, " for ", boxes, " boxes; expected one for each"}));
}

}  // namespace

template <int D, typename Real>
void World<D, Real>::add(BoxView<D, Real> boxes, std::span<Handle> handles,
                         std::span<const BoxOptions> options) {
  const core::DefaultEnvironment environment;
  check_lengths(handles.size(), "handles", boxes.size());
  if (!options.empty()) check_lengths(options.size(), "options", boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    state_->check_box(boxes[i], i, "to be added, number", i);
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
  const std::span<const std::byte> own = std::as_bytes(std::span(state_->boxes));
  if (!is_before(boxes.first_byte(), own.data()) && is_before(boxes.first_byte(), own.data() + own.size())) {
    for (std::size_t i = 0; i < boxes.size(); ++i) copies.push_back(boxes[i]);
    boxes = copies;
  }
  state_->reserve(boxes.size(), has_filters, has_user_data);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    handles[i] = state_->add_valid(boxes[i], options.empty() ? BoxOptions{} : options[i]);
}

template <int D, typename Real>
void World<D, Real>::move(std::span<const Handle> handles, BoxView<D, Real> boxes,
                          std::span<const Point<D, Real>> velocities) {
  const core::DefaultEnvironment environment;
  check_lengths(handles.size(), "handles", boxes.size());
  if (!velocities.empty()) check_lengths(velocities.size(), "velocities", boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!state_->is_live(handles[i])) state_->refuse(handles[i], "move");
    if (!is_present(boxes[i])) state_->check_box(boxes[i], i, "to be moved to, number", i);
    if (!velocities.empty()) state_->check_velocity(velocities[i], i, "of the box number", i);
  }
  state_->reserve_moves(boxes.size());
  if (!state_->has_margin() && !state_->quarantines()) return state_->set_boxes(handles, boxes);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const std::uint32_t slot = handles[i].slot;
    if (slot >= state_->slots.size()) continue;  // written by another thread since it was checked
    state_->set_box(slot, boxes[i], velocities.empty() ? nullptr : &velocities[i]);
  }
}

template <int D, typename Real>
void World<D, Real>::remove(std::span<const Handle> handles) {
  using SlotState = typename State::SlotState;
  state_->reserve_removals(handles.size(), state_->ignored_edges.size());
  // Each handle is read once, because another thread may write to the caller's list. A handle that is listed
  // twice is no longer live the second time.
  const std::size_t removed_before = state_->removed.size();
  for (const Handle handle : handles) {
    if (state_->is_live(handle)) {
      state_->list_removed(handle.slot);
      continue;
    }
    for (std::size_t i = removed_before; i < state_->removed.size(); ++i)
      state_->slots[state_->removed[i].slot].state = SlotState::live;
    state_->removed.erase(state_->removed.begin() + static_cast<std::ptrdiff_t>(removed_before),
                          state_->removed.end());
    state_->refuse(handle, state_->is_live(handle) ? "remove twice" : "remove");
  }
  for (std::size_t i = removed_before; i < state_->removed.size(); ++i)
    state_->clear_removed(state_->removed[i].slot);
}

template <int D, typename Real>
void World<D, Real>::list_quarantined(detail::Output<Handle>& output) const {
  const State& state = *state_;
  std::vector<Handle> handles;
  for (std::uint32_t slot = 0; slot < state.slots.size(); ++slot) {
    if (state.slots[slot].state == State::SlotState::live && is_absent(state.boxes[slot]))
      handles.push_back({slot, state.generations[slot]});
  }
  std::ranges::copy(handles, output.resize(handles.size()).begin());
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
  state.reserve_moves(state.slots.size());
  const auto shifted = [&origin](Box<D, Real> box) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] -= origin[axis];
      box.max[axis] -= origin[axis];
    }
    return box;
  };
  for (std::uint32_t slot = 0; slot < state.slots.size(); ++slot) {
    if (state.slots[slot].state != State::SlotState::live) continue;
    // So that it is enlarged anew, and not kept where it was.
    if (state.has_margin()) state.enlarged[slot] = absent_box<D, Real>();
    state.set_box(slot, shifted(state.boxes[slot]));
  }
  for (auto& removed : state.removed) removed.box = shifted(removed.box);
  for (auto& reported : state.reported) reported.box = shifted(reported.box);
}

}  // namespace broadside
