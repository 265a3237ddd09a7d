// BoxTable: the boxes of a world by slot, as they are and as the tracker sees them, and which of them
// changed.
#include "world/box_table.hpp"

#include <algorithm>
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
#include "kernels/count_kept.hpp"
#include "world/slot_table.hpp"

namespace broadside::world {
namespace {

/// The number of boxes that are set one by one where some cannot be set together; it doubles from the one to
/// the other while none can.
constexpr std::size_t min_singles = 16;
constexpr std::size_t max_singles = 256;

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
  const bool are_in_array = given.is_array() && (enlarges_ || !quarantines_);
  const std::span<const Box<D, Real>> array(given.array(), are_in_array ? given.size() : 0);
  std::size_t singles = min_singles;
  for (std::size_t i = 0; i < given.size();) {
    if (are_in_array) {
      const std::size_t count = set_in_a_row(handles.subspan(i), array.subspan(i));
      i += count;
      if (count == handles_at_once) continue;
      singles = count > 0 ? min_singles : std::min(2 * singles, max_singles);
    }
    for (const std::size_t end = std::min(i + singles, given.size()); i < end; ++i) {
      const std::uint32_t slot = handles[i].slot;
      if (slot < boxes_.size()) set(slot, given[i], velocities.empty() ? nullptr : &velocities[i]);
    }
  }
}

/// Sets some of the boxes, from the first one on, if their slots are consecutive and they stay within their
/// enlarged boxes. Returns their number, perhaps 0.
template <int D, typename Real>
std::size_t BoxTable<D, Real>::set_in_a_row(std::span<const Handle> handles,
                                            std::span<const Box<D, Real>> given) noexcept {
  std::size_t count = std::min(given.size(), handles_at_once);
  const std::uint32_t first = handles[0].slot;
  if (first + count > boxes_.size() || !are_in_a_row(handles.first(count), first)) return 0;
  if (enlarges_) {
    const auto kept = std::span<const Box<D, Real>>(enlarged_).subspan(first);
    count = kernels::count_kept(kept, given, count, margins_.side_slack());
  }
  std::copy(given.begin(), given.begin() + static_cast<std::ptrdiff_t>(count), &boxes_[first]);
  if (boxes_make_pairs_) mark_changed_in_a_row(first, count);
  return count;
}

/// mark_changed() for consecutive slots.
template <int D, typename Real>
void BoxTable<D, Real>::mark_changed_in_a_row(std::uint32_t first, std::size_t count) noexcept {
  std::uint8_t* const marks = &marks_[first];
  std::uint8_t all = 0;
  for (std::size_t i = 0; i < count; ++i) all |= marks[i];
  if (all != 0) {
    for (std::uint32_t i = 0; i < count; ++i) mark_changed(first + i);
    return;
  }
  std::fill_n(marks, count, changed_mark);
  const std::size_t listed = changed_.size();
  changed_.resize(listed + count);
  for (std::uint32_t i = 0; i < count; ++i) changed_[listed + i] = BoxId{first + i};
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
