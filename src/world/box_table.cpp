// BoxTable: the boxes of a world by slot, as they are and as the tracker sees them, and which of them
// changed.
#include "world/box_table.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "broadside/error.hpp"

#include "core/float_environment.hpp"
#include "core/input_check.hpp"
#include "core/message.hpp"
#include "core/number_text.hpp"

namespace broadside::world {
namespace {

/// One of the distances that boxes are enlarged by, as a number of the world's type.
template <typename Real>
Real checked_distance(const char* name, const double& number) {
  const core::DefaultEnvironment environment;
  const volatile Real rounded = static_cast<Real>(number);
  if (!(rounded >= 0) || !std::isfinite(rounded)) {
    throw std::invalid_argument(core::message({"the ", name, " of a world is ", core::text_of(number),
                                               "; expected a finite number of at least 0"}));
  }
  return rounded;
}

}  // namespace

template <int D, typename Real>
BoxTable<D, Real>::BoxTable(const WorldOptions& options)
    : margins_{.margin = checked_distance<Real>("margin", options.margin),
               .relative = checked_distance<Real>("relative margin", options.relative_margin),
               .frames = checked_distance<Real>("number of predicted frames", options.predicted_frames),
               .has_margin = options.margin > 0,
               .has_relative = options.relative_margin > 0},
      enlarges_(margins_.any()),
      boxes_make_pairs_(options.events == WorldEvents::exact),
      quarantines_(options.bad_input == BadInput::quarantine) {
  if (!boxes_make_pairs_ && !enlarges_) {
    throw std::invalid_argument(
        "a world reports enlarged boxes but enlarges none; expected a margin, a relative margin or a "
        "number of predicted frames above 0");
  }
}

template <int D, typename Real>
void BoxTable<D, Real>::refuse_unless_quarantined(const Box<D, Real>& box, std::size_t index,
                                                  const char* what, std::size_t number) const {
  if (quarantines_ && !is_absent(box)) return;
  const std::string name = core::message({what, " ", number});
  if (is_absent(box)) throw InvalidInput(index, core::message({name, " is absent; expected a box"}));
  throw InvalidInput(index, core::fault_of(box, name, false));
}

template <int D, typename Real>
void BoxTable<D, Real>::check_velocity(const Point<D, Real>& velocity, std::size_t index, const char* whose,
                                       std::size_t number) const {
  if (margins_.frames == 0) {
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

template <int D, typename Real>
void BoxTable<D, Real>::reserve(std::size_t added, bool with_filter) {
  core::make_room(boxes_, added);
  core::make_room(marks_, added);
  if (enlarges_) core::make_room(enlarged_, added);
  filters_.reserve(boxes_.size(), added, with_filter);
}

template <int D, typename Real>
void BoxTable<D, Real>::append() noexcept {
  boxes_.push_back(absent_box<D, Real>());
  marks_.push_back(0);
  if (enlarges_) enlarged_.push_back(absent_box<D, Real>());
  filters_.append();
}

/// Moves a box out of its enlarged one, and enlarges it anew. Separate from set(), so that set() is small
/// enough to be inlined.
template <int D, typename Real>
void BoxTable<D, Real>::set_outside(std::uint32_t slot, const Box<D, Real>& box,
                                    const Point<D, Real>* velocity) noexcept {
  boxes_[slot] = box;
  mark_changed(slot);
  mark_moved(slot);
  enlarged_[slot] = margins_.enlarged(box, velocity);
}

template <int D, typename Real>
void BoxTable<D, Real>::set(std::span<const Handle> handles, BoxView<D, Real> given,
                            std::span<const Point<D, Real>> velocities) noexcept {
  if (!enlarges_ && !quarantines_) return set_listed(handles, given);
  for (std::size_t i = 0; i < given.size(); ++i) {
    const std::uint32_t slot = handles[i].slot;
    if (slot < boxes_.size()) set(slot, given[i], velocities.empty() ? nullptr : &velocities[i]);
  }
}

/// For valid boxes that are not enlarged: lists them without a branch.
template <int D, typename Real>
void BoxTable<D, Real>::set_listed(std::span<const Handle> handles, BoxView<D, Real> given) noexcept {
  if (given.empty()) return;
  const std::size_t listed = changed_.size();
  changed_.resize(listed + given.size());
  BoxId* next = changed_.data() + listed;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const std::uint32_t slot = handles[i].slot;
    if (slot >= boxes_.size()) continue;
    boxes_[slot] = given[i];
    *next = BoxId{slot};
    next += static_cast<std::size_t>(marks_[slot] == 0);
    marks_[slot] = changed_mark;
  }
  changed_.resize(static_cast<std::size_t>(next - changed_.data()));
}

template <int D, typename Real>
void BoxTable<D, Real>::reset(std::uint32_t slot, const Box<D, Real>& box) noexcept {
  if (enlarges_) enlarged_[slot] = absent_box<D, Real>();
  set(slot, box, nullptr);
}

template <int D, typename Real>
void BoxTable<D, Real>::set_filter(std::uint32_t slot, const Filter& filter) noexcept {
  mark_changed(slot);
  if (enlarges_) mark_moved(slot);
  filters_.set(slot, filter);
}

template <int D, typename Real>
void BoxTable<D, Real>::remove(std::uint32_t slot) noexcept {
  mark_changed(slot);
  boxes_[slot] = absent_box<D, Real>();
  if (!enlarges_) return;
  mark_moved(slot);
  enlarged_[slot] = absent_box<D, Real>();
}

template <int D, typename Real>
void BoxTable<D, Real>::settle() noexcept {
  for (const BoxId id : changed_) marks_[index(id)] = 0;
  for (const BoxId id : moved_) marks_[index(id)] = 0;
  changed_.clear();
  moved_.clear();
}

template <int D, typename Real>
void BoxTable<D, Real>::shorten(std::size_t slots) noexcept {
  boxes_.resize(slots);
  marks_.resize(slots);
  if (enlarges_) enlarged_.resize(slots);
  filters_.shorten(slots);
}

template <int D, typename Real>
void BoxTable<D, Real>::shrink_to_fit() {
  core::shrink(boxes_, enlarged_, marks_, changed_, moved_);
  filters_.shrink_to_fit();
}

template <int D, typename Real>
void BoxTable<D, Real>::restore(std::vector<Box<D, Real>> boxes, std::vector<Box<D, Real>> enlarged) {
  marks_.assign(boxes.size(), 0);
  boxes_ = std::move(boxes);
  enlarged_ = std::move(enlarged);
}

template <int D, typename Real>
void BoxTable<D, Real>::restore_changes(std::vector<BoxId> changed, std::vector<BoxId> moved) {
  changed_ = std::move(changed);
  moved_ = std::move(moved);
  for (const BoxId id : changed_) marks_[index(id)] |= changed_mark;
  for (const BoxId id : moved_) marks_[index(id)] |= moved_mark;
}

template class BoxTable<2, float>;
template class BoxTable<2, double>;
template class BoxTable<3, float>;
template class BoxTable<3, double>;

}  // namespace broadside::world
