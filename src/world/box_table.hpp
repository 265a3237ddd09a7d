// BoxTable: the boxes of a world by slot, as they are and as the tracker sees them, and which of them
// changed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"
#include "broadside/world.hpp"

#include "core/grow.hpp"
#include "core/margins.hpp"
#include "world/slot_column.hpp"

namespace broadside::world {

/// If a world enlarges boxes, its tracker sees the enlarged ones. A box gets a new enlarged box only when it
/// has left the old one. Every array has a place for each slot. Two lists say what changed since the last
/// update, each slot once: `changed` for boxes and filters, `moved` for enlarged boxes and filters.
template <int D, typename Real>
class BoxTable {
 public:
  /// Throws std::invalid_argument if a margin or the number of predicted frames is negative or not finite, or
  /// if enlarged boxes must make the pairs and no box is enlarged.
  explicit BoxTable(const WorldOptions& options);

  std::span<const Box<D, Real>> boxes() const noexcept { return boxes_; }
  std::span<const Box<D, Real>> enlarged() const noexcept { return enlarged_; }
  const SlotColumn<Filter>& filters() const noexcept { return filters_; }
  std::span<const BoxId> changed() const noexcept { return changed_; }
  std::span<const BoxId> moved() const noexcept { return moved_; }
  bool is_changed(std::uint32_t slot) const noexcept { return (marks_[slot] & changed_mark) != 0; }

  /// Whether the tracker sees enlarged boxes.
  bool enlarges() const noexcept { return enlarges_; }

  /// Whether the tracker sees enlarged boxes, and the boxes themselves decide about its pairs.
  bool refines() const noexcept { return enlarges_ && boxes_make_pairs_; }

  /// What the tracker sees, and the list of what changed in it.
  std::span<const Box<D, Real>> shown() const noexcept { return enlarges_ ? enlarged_ : boxes_; }
  std::span<const BoxId> shown_changes() const noexcept { return enlarges_ ? moved_ : changed_; }

  /// Throws InvalidInput, with `index`, if the box is absent, or invalid and not to be quarantined. `what`
  /// and `number` name it, as in "added box 3".
  void check(const Box<D, Real>& box, std::size_t index, const char* what, std::size_t number) const {
    if (!is_present(box)) refuse_unless_quarantined(box, index, what, number);
  }

  /// Whether all boxes are present, and check() accepts them.
  bool are_present(BoxView<D, Real> boxes) const noexcept;

  /// Throws InvalidInput if a coordinate is not finite, std::logic_error if no frames are predicted.
  void check_velocity(const Point<D, Real>& velocity, std::size_t index, const char* whose,
                      std::size_t number) const;

  /// Makes room for `added` calls of append(), and for the first filter if one follows.
  void reserve(std::size_t added, bool with_filter);

  /// Makes room for `count` calls of set(), reset(), set_filter() or remove(), so that they do not throw.
  void reserve_changes(std::size_t count) {
    core::make_room(changed_, count);
    if (enlarges_) core::make_room(moved_, count);
  }

  /// Begins to keep filters; reserve() must have made room.
  void use_filters() noexcept { filters_.use(boxes_.size()); }

  /// Appends a slot without a box.
  void append() noexcept;

  /// Sets a slot's box, which check() has accepted, in the default floating-point environment. If only
  /// enlarged boxes make pairs, a move within one affects only queries.
  void set(std::uint32_t slot, const Box<D, Real>& given, const Point<D, Real>* velocity) noexcept {
    // Without quarantine, check() has thrown for an invalid box.
    store(slot, quarantines_ && !is_present(given) ? absent_box<D, Real>() : as_kept(given), velocity);
  }

  /// The box as the table keeps it.
  Box<D, Real> as_kept(const Box<D, Real>& box) const noexcept { return touching_ ? box : half_open(box); }

  /// The same for many boxes; velocities for all of them or none. Skips slots that do not exist: another
  /// thread may have written to the caller's handles since they were checked.
  void set(std::span<const Handle> handles, BoxView<D, Real> boxes,
           std::span<const Point<D, Real>> velocities) noexcept;

  /// Stores a box that as_kept() returned, and enlarges it again even if its enlarged box still contains it.
  void reset(std::uint32_t slot, const Box<D, Real>& box) noexcept;

  /// Sets a slot's filter in a table that keeps filters, and lists the slot.
  void set_filter(std::uint32_t slot, const Filter& filter) noexcept;

  /// Sets the filter of a new box, which is listed anyway.
  void init_filter(std::uint32_t slot, const Filter& filter) noexcept { filters_.set(slot, filter); }

  /// Makes the slot's box absent.
  void remove(std::uint32_t slot) noexcept;

  /// At the end of an update: clears the lists of changes. O(changes).
  void settle() noexcept;

  /// Drops the slots from `slots` on; no list may name one.
  void shorten(std::size_t slots) noexcept;

  void shrink_to_fit();

  /// The bytes of boxes, of filters, and of the lists.
  std::size_t bytes() const noexcept { return core::bytes_of(boxes_, enlarged_); }
  std::size_t filter_bytes() const noexcept { return filters_.bytes(); }
  std::size_t list_bytes() const noexcept { return core::bytes_of(marks_, changed_, moved_); }

  /// Takes the checked boxes of a snapshot: first the arrays, then the lists.
  void restore(std::vector<Box<D, Real>> boxes, std::vector<Box<D, Real>> enlarged);
  void restore_filters(std::vector<Filter> filters) noexcept { filters_.restore(std::move(filters)); }
  void restore_changes(std::vector<BoxId> changed, std::vector<BoxId> moved);

 private:
  static constexpr std::uint8_t changed_mark = 1;  // is in changed_
  static constexpr std::uint8_t moved_mark = 2;    // is in moved_

  void refuse_unless_quarantined(const Box<D, Real>& box, std::size_t index, const char* what,
                                 std::size_t number) const;
  void set_outside(std::uint32_t slot, const Box<D, Real>& box, const Point<D, Real>* velocity) noexcept;
  bool set_in_a_row(std::span<const Handle> handles, std::span<const Box<D, Real>> given) noexcept;
  bool set_scattered(std::span<const Handle> handles, std::span<const Box<D, Real>> given) noexcept;
  void list_in_a_row(std::uint32_t first, std::size_t count) noexcept;
  void list(std::vector<BoxId>& to, std::uint8_t mark, std::span<const std::uint32_t> slots) noexcept;

  /// Stores a box that as_kept() returned.
  void store(std::uint32_t slot, const Box<D, Real>& box, const Point<D, Real>* velocity) noexcept {
    if (enlarges_ && !margins_.keeps(enlarged_[slot], box, velocity)) return set_outside(slot, box, velocity);
    boxes_[slot] = box;
    if (boxes_make_pairs_) mark_changed(slot);
  }

  void mark_changed(std::uint32_t slot) noexcept {
    if ((marks_[slot] & changed_mark) != 0) return;
    marks_[slot] |= changed_mark;
    changed_.push_back(BoxId{slot});
  }
  void mark_moved(std::uint32_t slot) noexcept {
    if ((marks_[slot] & moved_mark) != 0) return;
    marks_[slot] |= moved_mark;
    moved_.push_back(BoxId{slot});
  }

  core::Margins<D, Real> margins_;
  bool enlarges_;
  bool boxes_make_pairs_;  // and not the enlarged ones
  bool quarantines_;
  bool touching_;
  std::vector<Box<D, Real>> boxes_;     // absent in slots without a box
  std::vector<Box<D, Real>> enlarged_;  // empty if boxes are not enlarged
  std::vector<std::uint8_t> marks_;
  SlotColumn<Filter> filters_;  // in use from the first filter on that is not the default
  std::vector<BoxId> changed_;
  std::vector<BoxId> moved_;  // unused if boxes are not enlarged
};

}  // namespace broadside::world
