// BoxTable: the boxes of a world by slot, as they are and as the tracker sees them, and which of them
// changed.
#include "world/box_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "broadside/error.hpp"

#include "core/float_environment.hpp"
#include "core/input_check.hpp"
#include "core/message.hpp"
#include "core/number_text.hpp"
#include "kernels/all_present.hpp"
#include "kernels/enlarged_boxes.hpp"
#include "world/slot_table.hpp"

namespace broadside::world {
namespace {

/// So many marks are cleared in the time that clearing those of a list takes for each of its entries.
constexpr std::size_t marks_per_list_entry = 16;

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
      quarantines_(options.bad_input == BadInput::quarantine),
      touching_(options.touching) {
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
bool BoxTable<D, Real>::are_present(BoxView<D, Real> boxes) const noexcept {
  if (boxes.is_array()) return kernels::all_present(std::span(boxes.array(), boxes.size()));
  unsigned all = 1;
  for (const Box<D, Real> box : boxes) all &= static_cast<unsigned>(is_present(box));
  return all != 0;
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
  std::array<Box<D, Real>, handles_at_once> copies;
  for (std::size_t begin = 0; begin < given.size(); begin += handles_at_once) {
    const std::size_t count = std::min(handles_at_once, given.size() - begin);
    if (!quarantines_ && velocities.empty()) {
      const Box<D, Real>* boxes = copies.data();
      if (given.is_array() && touching_)
        boxes = given.array() + begin;
      else
        std::transform(given.begin() + static_cast<std::ptrdiff_t>(begin),
                       given.begin() + static_cast<std::ptrdiff_t>(begin + count), copies.begin(),
                       [this](const Box<D, Real>& box) { return as_kept(box); });
      const std::span<const Handle> some = handles.subspan(begin, count);
      if (set_in_a_row(some, {boxes, count}) || set_scattered(some, {boxes, count})) continue;
    }
    for (std::size_t i = begin; i < begin + count; ++i) {
      const std::uint32_t slot = handles[i].slot;
      if (slot < boxes_.size()) set(slot, given[i], velocities.empty() ? nullptr : &velocities[i]);
    }
  }
}

/// Sets present boxes, if their slots are consecutive. Otherwise returns false and changes nothing.
template <int D, typename Real>
bool BoxTable<D, Real>::set_in_a_row(std::span<const Handle> handles,
                                     std::span<const Box<D, Real>> given) noexcept {
  const std::uint32_t first = handles[0].slot;
  const std::size_t count = handles.size();
  if (first + count > boxes_.size() || !are_in_a_row(handles, first)) return false;
  std::copy(given.begin(), given.end(), &boxes_[first]);
  if (boxes_make_pairs_) list_in_a_row(first, count);
  if (!enlarges_) return true;
  const std::span<Box<D, Real>> kept = std::span(enlarged_).subspan(first);
  const std::span<const Box<D, Real>> now = std::span(boxes_).subspan(first);
  const std::size_t stay = kernels::count_kept<D, Real>(kept, now, count, margins_);
  if (stay == count) return true;
  std::array<std::uint32_t, handles_at_once> places;
  const std::size_t rest = count - stay;
  const std::span<std::uint32_t> left = std::span(places).first(
      kernels::enlarge_left(kept.subspan(stay, rest), now.subspan(stay, rest), margins_, places.data()));
  for (std::uint32_t& place : left) place += first + static_cast<std::uint32_t>(stay);
  if (!boxes_make_pairs_) list(changed_, changed_mark, left);
  list(moved_, moved_mark, left);
  return true;
}

/// Sets present boxes, if their slots exist and all stay within their enlarged boxes. Otherwise returns false
/// and changes nothing.
template <int D, typename Real>
bool BoxTable<D, Real>::set_scattered(std::span<const Handle> handles,
                                      std::span<const Box<D, Real>> given) noexcept {
  const std::size_t count = handles.size();
  std::array<std::uint32_t, handles_at_once> slots;
  std::array<Box<D, Real>, handles_at_once + 1> now;
  std::array<Box<D, Real>, handles_at_once + 1> kept;
  for (std::size_t i = 0; i < count; ++i) {
    slots[i] = handles[i].slot;
    if (slots[i] >= boxes_.size()) return false;
    now[i] = given[i];
    if (enlarges_) kept[i] = enlarged_[slots[i]];
  }
  if (enlarges_) {
    now[count] = kept[count] = absent_box<D, Real>();  // count_kept() reads one box more
    if (kernels::count_kept<D, Real>(kept, now, count, margins_) < count) return false;
  }
  for (std::size_t i = 0; i < count; ++i) boxes_[slots[i]] = now[i];
  if (boxes_make_pairs_) list(changed_, changed_mark, std::span(slots).first(count));
  return true;
}

/// Lists consecutive slots as changed.
template <int D, typename Real>
void BoxTable<D, Real>::list_in_a_row(std::uint32_t first, std::size_t count) noexcept {
  const std::span<std::uint8_t> marks = std::span(marks_).subspan(first, count);
  std::uint8_t any = 0;
  for (const std::uint8_t mark : marks) any |= mark;
  if (any == 0) {
    std::fill(marks.begin(), marks.end(), changed_mark);
    const std::size_t listed = changed_.size();
    changed_.resize(listed + count);
    for (std::size_t i = 0; i < count; ++i) changed_[listed + i] = BoxId(first + i);
    return;
  }
  std::array<std::uint32_t, handles_at_once> slots;
  for (std::size_t i = 0; i < slots.size(); ++i) slots[i] = first + static_cast<std::uint32_t>(i);
  list(changed_, changed_mark, std::span(slots).first(count));
}

/// Appends the slots without the mark to a list that has room for them, and marks them.
template <int D, typename Real>
void BoxTable<D, Real>::list(std::vector<BoxId>& to, std::uint8_t mark,
                             std::span<const std::uint32_t> slots) noexcept {
  const std::size_t listed = to.size();
  to.resize(listed + slots.size());
  BoxId* next = to.data() + listed;
  std::uint8_t* const marks = marks_.data();
  for (const std::uint32_t slot : slots) {
    *next = BoxId{slot};
    next += static_cast<std::size_t>((marks[slot] & mark) == 0);
    marks[slot] |= mark;
  }
  to.resize(static_cast<std::size_t>(next - to.data()));
}

template <int D, typename Real>
void BoxTable<D, Real>::reset(std::uint32_t slot, const Box<D, Real>& box) noexcept {
  if (enlarges_) enlarged_[slot] = absent_box<D, Real>();
  store(slot, box, nullptr);
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
  if (changed_.size() > marks_.size() / marks_per_list_entry) {
    std::fill(marks_.begin(), marks_.end(), std::uint8_t{0});
  } else {
    for (const BoxId id : changed_) marks_[index(id)] = 0;
  }
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
