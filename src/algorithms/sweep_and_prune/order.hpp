// Boxes kept in the order of a sweep from frame to frame.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "kernels/toggle.hpp"

namespace broadside::own {

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
  SweepKey key(std::size_t place) const { return {min_[0][place], id_[place]}; }

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
      other_.set(i, entry.from == SweepEntry::is_new ? box_of(entry.key.id) : box(entry.from), entry.key.id);
    }
    take_other();
  }

  Box<D> box(std::size_t place) const;

  /// Gives the box at `place` other bounds and moves it to where it belongs, and those between by one.
  void move(std::size_t place, const Box<D>& box);

  /// Lets the box at `place` overlap nothing, until it is left out of a new order.
  void remove(std::size_t place);

  /// Calls `visit` with each box whose overlap with the mover its step changes. `near` is a place near the
  /// mover's. Returns how many boxes were compared.
  template <typename Visit>
  std::uint64_t find_toggles(const kernels::Mover<D>& mover, std::size_t near, Visit visit) {
    const Box<D>& before = mover.before;
    const Box<D>& now = mover.now;
    if (!is_present(before)) return find_toggles(mover, now.min[0], now.max[0], near, visit);
    if (!is_present(now)) return find_toggles(mover, before.min[0], before.max[0], near, visit);
    const float min = std::min(before.min[0], now.min[0]);
    const float max = std::max(before.max[0], now.max[0]);
    if (max - min <= 2 * ((before.max[0] - before.min[0]) + (now.max[0] - now.min[0])))
      return find_toggles(mover, min, max, near, visit);
    return find_toggles(mover, before.min[0], before.max[0], near, visit) +
           find_toggles(mover, now.min[0], now.max[0], near, visit);
  }

  std::size_t bytes() const noexcept;

 private:
  static constexpr std::size_t fan = 64;  // boxes in a block, and blocks in a block of blocks
  static constexpr std::size_t at_once = 1024;

  struct Arrays {
    std::array<std::vector<float>, D> min;
    std::array<std::vector<float>, D> max;
    std::vector<BoxId> id;

    void resize(std::size_t size);
    void set(std::size_t place, const Box<D>& box, BoxId box_id);
    std::size_t bytes() const noexcept;
  };

  /// Those among the boxes that may touch [min, max] on the swept axis.
  template <typename Visit>
  std::uint64_t find_toggles(const kernels::Mover<D>& mover, float min, float max, std::size_t near,
                             Visit visit) {
    const std::size_t begin = find({min, BoxId(0)}, near);
    const std::size_t end = std::max(begin, find_end(max, begin));
    std::uint64_t tests = end - begin;
    const std::size_t begin_block = begin / fan;
    for (std::size_t high = 0; high * fan <= begin_block; ++high) {
      if (!(high_reach_[high] >= min)) continue;
      for (std::size_t block = high * fan; block <= std::min(begin_block, high * fan + fan - 1); ++block) {
        if (block >= reach_.size() || !(reach_[block] >= min)) continue;
        const std::size_t block_end = std::min(block * fan + fan, begin);
        tests += block_end - block * fan;
        compare(mover, block * fan, block_end, visit);
      }
    }
    compare(mover, begin, end, visit);
    return tests;
  }

  template <typename Visit>
  void compare(const kernels::Mover<D>& mover, std::size_t begin, std::size_t end, Visit visit) {
    for (; begin < end; begin += at_once) {
      const std::size_t count =
          kernels::find_toggles(mover, run_, begin, std::min(begin + at_once, end), toggles_.data());
      for (std::size_t i = 0; i < count; ++i) visit(toggles_[i]);
    }
  }

  std::size_t find_end(float max, std::size_t near) const;
  void take_other();
  void set_reach(std::size_t first_block, std::size_t last_block);

  std::size_t size_ = 0;
  Arrays arrays_;
  Arrays other_;  // while a new order is made
  std::vector<float> reach_;
  std::vector<float> high_reach_;
  kernels::Run<D> run_{};
  std::array<kernels::Toggle, at_once> toggles_{};

  std::array<std::vector<float>, D>& min_ = arrays_.min;
  std::array<std::vector<float>, D>& max_ = arrays_.max;
  std::vector<BoxId>& id_ = arrays_.id;
};

}  // namespace broadside::own
