// Boxes kept in the order of a sweep from frame to frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "core/grow.hpp"
#include "kernels/kept_run.hpp"
#include "kernels/moved.hpp"

namespace broadside::algorithm {

/// A box's place in the order: by where it begins on the swept axis, and of equal ones by id.
struct SweepKey {
  float min;
  BoxId id;

  friend bool operator<(const SweepKey& a, const SweepKey& b) {
    return a.min < b.min || (a.min == b.min && a.id < b.id);
  }
};

/// Where a box of a new order comes from: a place of the old one, or it is new.
struct SweepEntry {
  static constexpr std::uint32_t is_new = 0xffffffffU;

  SweepKey key;
  std::uint32_t from;

  friend bool operator<(const SweepEntry& a, const SweepEntry& b) { return a.key < b.key; }
};

/// Boxes as a structure of arrays, sorted by SweepKey. Axis 0 is the swept one: boxes must be handed in with
/// their axes in the sweep's order.
///
/// How far boxes reach is kept for blocks of them and for blocks of blocks, so that those which begin before
/// a box and reach into it are found however long others are.
template <int D>
class SweepOrder {
 public:
  std::size_t size() const noexcept { return size_; }
  SweepKey key(std::size_t place) const { return {kept_.min[0][place], kept_.id[place]}; }

  /// The place of the first box that does not come before `key`: of the box itself where it is there. By
  /// binary search, in the neighbourhood of `near` first.
  std::size_t find(const SweepKey& key, std::size_t near) const;
  std::size_t find(const SweepKey& key) const;

  /// Makes the boxes those of `entries`, which are in order. `box_of(id)` is a new one's box.
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

  /// Gives the box at `place` other bounds and moves it to where it belongs, and those between by one.
  /// Returns how many these are.
  std::size_t move(std::size_t place, const Box<D>& box);

  /// Lets the box at `place` overlap nothing, until it is left out of a new order.
  void remove(std::size_t place) { kept_.max[0][place] = std::numeric_limits<float>::quiet_NaN(); }

  /// Writes what the moved box, whose axes are in the sweep's order, begins to overlap or ceases to. `near`
  /// is a place near its own. Returns how many boxes were compared.
  std::uint64_t find_changes(const core::MovedBox<D>& moved, std::size_t near,
                             const core::ChangeSinks& sinks) const;

  std::size_t bytes() const noexcept {
    return core::bytes_of(kept_.min, kept_.max, kept_.id, other_.min, other_.max, other_.id, reach_,
                          high_reach_);
  }

 private:
  static constexpr std::size_t fan = 64;  // boxes in a block, and blocks in a block of blocks

  /// Those among the boxes that may touch [min, max] on the swept axis.
  std::uint64_t find_changes(const core::MovedBox<D>& moved, float min, float max, std::size_t near,
                             const core::ChangeSinks& sinks) const;

  std::size_t find_end(float max, std::size_t near) const;
  void take_other();
  void set_reach(std::size_t first_block, std::size_t last_block);

  std::size_t size_ = 0;
  kernels::KeptRun<D> kept_;
  kernels::KeptRun<D> other_;  // while a new order is made
  std::vector<float> reach_;
  std::vector<float> high_reach_;
  kernels::Run<D> run_{};
};

}  // namespace broadside::algorithm
