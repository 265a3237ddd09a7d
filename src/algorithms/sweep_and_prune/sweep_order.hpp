// SweepOrder: boxes kept in the order of a sweep from frame to frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "core/grow.hpp"
#include "kernels/find_changes.hpp"
#include "kernels/kept_run.hpp"

namespace broadside::algorithm {

/// A box's key in the order: where it begins on the swept axis, then its id.
struct SweepKey {
  float min;
  BoxId id;

  friend bool operator<(const SweepKey& a, const SweepKey& b) {
    return a.min < b.min || (a.min == b.min && a.id < b.id);
  }
};

/// A box of a new order, and where it comes from: a place in the old order, or is_new.
struct SweepEntry {
  static constexpr std::uint32_t is_new = 0xffffffffU;

  SweepKey key;
  std::uint32_t from;

  friend bool operator<(const SweepEntry& a, const SweepEntry& b) { return a.key < b.key; }
};

/// Boxes as a structure of arrays, sorted by SweepKey. Axis 0 is the swept one: the caller passes boxes with
/// their axes in the sweep's order.
///
/// The greatest maximum is kept for each block of boxes and for each block of blocks. With these, boxes that
/// begin before a box and reach into it are found fast, however long other boxes are.
template <int D>
class SweepOrder {
 public:
  std::size_t size() const noexcept { return size_; }
  SweepKey key(std::size_t place) const { return {kept_.min[0][place], kept_.id[place]}; }

  /// The place of the first box that does not come before `key`: the box's own place if it is there. By
  /// binary search or, with `near`, by galloping search from there.
  std::size_t find(const SweepKey& key, std::size_t near) const;
  std::size_t find(const SweepKey& key) const;

  /// Replaces the order by `entries`, which are sorted. `box_of(id)` is the box of a new entry.
  template <typename BoxOf>
  void assign(std::span<const SweepEntry> entries, BoxOf box_of) {
    other_.resize(entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const SweepEntry& entry = entries[i];
      other_.set(i, entry.from == SweepEntry::is_new ? box_of(entry.key.id) : box(entry.from));
      other_.id[i] = entry.key.id;
    }
    take_other();
  }

  Box<D> box(std::size_t place) const { return kept_.box(place); }

  /// Sets the bounds of the box at `place` and moves it to where it belongs. The boxes between shift by one
  /// place; returns their number.
  std::size_t move(std::size_t place, const Box<D>& box);

  /// Makes the box at `place` overlap nothing, until assign() leaves it out.
  void remove(std::size_t place) { kept_.max[0][place] = std::numeric_limits<float>::quiet_NaN(); }

  /// Writes the pairs that the moved box, with its axes in the sweep's order, begins or ends. `near` is a
  /// place near its own. Returns the number of tests.
  std::uint64_t find_changes(const core::MovedBox<D>& moved, std::size_t near,
                             const core::ChangeSinks& sinks) const;

  std::size_t bytes() const noexcept {
    return core::bytes_of(kept_.min, kept_.max, kept_.id, other_.min, other_.max, other_.id, reach_,
                          high_reach_);
  }

 private:
  static constexpr std::size_t fan = 64;  // boxes in a block, and blocks in a block of blocks

  /// The same among the boxes that may touch [min, max] on the swept axis.
  std::uint64_t find_changes(const core::MovedBox<D>& moved, float min, float max, std::size_t near,
                             const core::ChangeSinks& sinks) const;

  std::size_t find_end(float max, std::size_t near) const;
  void take_other();
  void set_reach(std::size_t first_block, std::size_t last_block);

  std::size_t size_ = 0;
  kernels::KeptRun<D> kept_;
  kernels::KeptRun<D> other_;  // for making a new order
  std::vector<float> reach_;
  std::vector<float> high_reach_;
  kernels::Run<D> run_{};
};

}  // namespace broadside::algorithm
