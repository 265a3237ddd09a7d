// Chains of blocks of boxes, for the nodes of a quadtree that stays from frame to frame.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "kernels/block_pool.hpp"

namespace broadside::algorithm {

/// A chain is named by its first block, no_slot if it is empty. A box keeps its slot until it is erased or
/// its chain is drained.
template <int D>
class QuadtreeChains {
 public:
  kernels::BlockPool<D>& pool() { return pool_; }
  const kernels::BlockPool<D>& pool() const { return pool_; }

  /// Puts a box into the first slot of a node's chain that is free.
  std::uint32_t insert(std::uint32_t& first, std::uint32_t node, const Box<D>& box, BoxId id) {
    std::uint32_t block = first;
    while (block != kernels::no_slot && pool_.is_full(block)) block = pool_.head(block).next;
    if (block == kernels::no_slot) {
      pool_.add_block(first, node);
      block = first;
    }
    return pool_.insert(block, box, id);
  }

  /// The slot of a box in a chain; no_slot if it is not there.
  std::uint32_t find(std::uint32_t first, BoxId id) const {
    const kernels::BlocksView<D> view = pool_.view();
    for (std::uint32_t block = first; block != kernels::no_slot; block = view.heads[block].next) {
      std::uint32_t found = 0;
      for (std::uint32_t lane = 0; lane < width; ++lane)
        found |= static_cast<std::uint32_t>(view.blocks[block].id[lane] == index(id)) << lane;
      found &= view.heads[block].used;
      if (found != 0) return block * width + static_cast<std::uint32_t>(std::countr_zero(found));
    }
    return kernels::no_slot;
  }

  /// Takes a box out of its chain, and its block if that is left empty.
  void erase(std::uint32_t& first, std::uint32_t slot) {
    pool_.erase(slot);
    if (pool_.head(slot / width).used == 0) pool_.remove_block(first, slot / width);
  }

  /// Calls `visit(id)` for each box of a chain, and empties the chain.
  template <typename Visit>
  void drain(std::uint32_t& first, Visit visit) {
    while (first != kernels::no_slot) {
      const std::uint32_t block = first;
      for (std::uint32_t used = pool_.head(block).used; used != 0; used &= used - 1)
        visit(pool_.id(block * width + static_cast<std::uint32_t>(std::countr_zero(used))));
      pool_.remove_block(first, block);
    }
  }

 private:
  static constexpr std::uint32_t width = kernels::BlockPool<D>::width;

  kernels::BlockPool<D> pool_;
};

}  // namespace broadside::algorithm
