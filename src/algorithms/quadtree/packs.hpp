// Chains of packs of boxes in one pool, for the nodes of a quadtree that stays from frame to frame.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "kernels/packs.hpp"

namespace broadside::own {

/// A chain is named by its first pack, no_pack if it is empty. A slot is a lane of a pack, and a box keeps
/// its slot until it is erased or its chain is cleared.
template <int D>
class QuadtreePacks {
 public:
  static constexpr std::uint32_t no_slot = 0xffffffffU;

  kernels::Packs<D> view() const { return {packs_, states_}; }

  /// Puts a box into the first lane that is free.
  std::uint32_t insert(std::uint32_t& first, const Box<D>& box, BoxId id) {
    std::uint32_t pack = first;
    while (pack != kernels::no_pack && states_[pack].used == full) pack = states_[pack].next;
    if (pack == kernels::no_pack) pack = add_pack(first);
    const auto lane = static_cast<std::uint32_t>(std::countr_one(states_[pack].used));
    states_[pack].used |= static_cast<std::uint16_t>(1U << lane);
    const std::uint32_t slot = pack * lanes + lane;
    packs_[pack].id[lane] = index(id);
    set(slot, box);
    return slot;
  }

  /// The slot of a box in a chain; no_slot if it is not there.
  std::uint32_t find(std::uint32_t first, BoxId id) const {
    for (std::uint32_t pack = first; pack != kernels::no_pack; pack = states_[pack].next) {
      std::uint32_t found = 0;
      for (std::uint32_t lane = 0; lane < lanes; ++lane)
        found |= static_cast<std::uint32_t>(packs_[pack].id[lane] == index(id)) << lane;
      found &= states_[pack].used;
      if (found != 0) return pack * lanes + static_cast<std::uint32_t>(std::countr_zero(found));
    }
    return no_slot;
  }

  void set(std::uint32_t slot, const Box<D>& box) {
    kernels::Pack<D>& pack = packs_[slot / lanes];
    for (int axis = 0; axis < D; ++axis) {
      pack.min[axis][slot % lanes] = box.min[axis];
      pack.max[axis][slot % lanes] = box.max[axis];
    }
  }

  void mark(std::uint32_t slot) {
    states_[slot / lanes].moved |= static_cast<std::uint16_t>(1U << slot % lanes);
  }

  void unmark(std::uint32_t slot) {
    states_[slot / lanes].moved &= static_cast<std::uint16_t>(~(1U << slot % lanes));
  }

  /// Takes a box, marked or not, out of its chain. A pack that is left empty goes back to the pool.
  void erase(std::uint32_t& first, std::uint32_t slot) {
    const std::uint32_t pack = slot / lanes;
    unmark(slot);
    states_[pack].used &= static_cast<std::uint16_t>(~(1U << slot % lanes));
    if (states_[pack].used != 0) {
      set(slot, kernels::nowhere<D>());
      return;
    }
    std::uint32_t* link = &first;
    while (*link != pack) link = &states_[*link].next;
    *link = states_[pack].next;
    give_back(pack);
  }

  /// Calls `visit(id)` for each box of a chain, and empties the chain.
  template <typename Visit>
  void drain(std::uint32_t& first, Visit visit) {
    while (first != kernels::no_pack) {
      const std::uint32_t pack = first;
      for (std::uint32_t used = states_[pack].used; used != 0; used &= used - 1)
        visit(BoxId(packs_[pack].id[std::countr_zero(used)]));
      first = states_[pack].next;
      give_back(pack);
    }
  }

  /// Empties all chains, and gives memory back that far exceeds what was in use.
  void clear() {
    if (packs_.capacity() > 4 * (packs_.size() - free_count_) + 1024) {
      packs_ = {};
      states_ = {};
    }
    packs_.clear();
    states_.clear();
    free_ = kernels::no_pack;
    free_count_ = 0;
  }

  std::size_t bytes() const noexcept {
    return packs_.capacity() * sizeof(kernels::Pack<D>) + states_.capacity() * sizeof(kernels::PackState);
  }

 private:
  static constexpr std::uint32_t lanes = kernels::pack_size;
  static constexpr std::uint16_t full = 0xffff;

  std::uint32_t add_pack(std::uint32_t& first) {
    std::uint32_t pack = free_;
    if (pack != kernels::no_pack) {
      free_ = states_[pack].next;
      --free_count_;
    } else {
      pack = static_cast<std::uint32_t>(packs_.size());
      packs_.emplace_back();
      states_.emplace_back();
    }
    for (std::uint32_t lane = 0; lane < lanes; ++lane) set(pack * lanes + lane, kernels::nowhere<D>());
    for (std::uint32_t& id : packs_[pack].id) id = 0;
    states_[pack] = {.used = 0, .moved = 0, .next = first};
    first = pack;
    return pack;
  }

  void give_back(std::uint32_t pack) {
    states_[pack] = {.used = 0, .moved = 0, .next = free_};
    free_ = pack;
    ++free_count_;
  }

  std::vector<kernels::Pack<D>> packs_;
  std::vector<kernels::PackState> states_;
  std::uint32_t free_ = kernels::no_pack;
  std::size_t free_count_ = 0;
};

}  // namespace broadside::own
