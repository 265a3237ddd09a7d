// BlockPool: blocks of sixteen boxes in chains, for structures that persist from frame to frame.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hwy/cache_control.h>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "kernels/block.hpp"

namespace broadside::kernels {

inline void prefetch(const void* memory) { hwy::Prefetch(static_cast<const char*>(memory)); }

/// Sets or clears bits of a word while other threads set or clear its other bits. It orders no other memory
/// access: joining the threads does.
inline void set_shared(std::uint16_t& word, std::uint16_t bits) noexcept {
#ifdef __cpp_lib_atomic_ref
  std::atomic_ref(word).fetch_or(bits, std::memory_order_relaxed);
#else  // libc++ before 19
  __atomic_fetch_or(&word, bits, __ATOMIC_RELAXED);
#endif
}

inline void clear_shared(std::uint16_t& word, std::uint16_t bits) noexcept {
#ifdef __cpp_lib_atomic_ref
  std::atomic_ref(word).fetch_and(static_cast<std::uint16_t>(~bits), std::memory_order_relaxed);
#else
  __atomic_fetch_and(&word, static_cast<std::uint16_t>(~bits), __ATOMIC_RELAXED);
#endif
}

/// Data about a block that a search can read without its boxes.
struct BlockHead {
  std::uint32_t next;    ///< the next block of the same chain, or no_slot
  std::uint32_t owner;   ///< the number of the cell or node that owns the chain
  std::uint16_t used;    ///< bit i: lane i holds a box
  std::uint16_t moving;  ///< bit i: the box in lane i moves in this update and covers it before and now
};

/// All blocks, by number.
template <int D>
struct BlocksView {
  const BlockHead* heads;
  const Block<D>* blocks;
};

/// A chain is named by its first block. A slot is a block and a lane: 16 * block + lane.
template <int D>
class BlockPool {
 public:
  static constexpr std::uint32_t width = block_size;
  static constexpr std::uint16_t all_used = 0xffff;

  BlocksView<D> view() const { return {heads_.data(), blocks_.data()}; }
  const BlockHead& head(std::uint32_t block) const { return heads_[block]; }
  bool is_full(std::uint32_t block) const { return heads_[block].used == all_used; }
  std::size_t block_count() const { return blocks_.size(); }

  /// Adds an empty block at the front of the chain `first`.
  void add_block(std::uint32_t& first, std::uint32_t owner) {
    std::uint32_t block = static_cast<std::uint32_t>(blocks_.size());
    if (free_.empty()) {
      if (blocks_.size() == blocks_.capacity()) reserve(blocks_.size());
      heads_.emplace_back();
      blocks_.emplace_back();
    } else {
      block = free_.back();
      free_.pop_back();
    }
    heads_[block] = {first, owner, 0, 0};
    blocks_[block].clear();
    first = block;
  }

  /// Removes a block and the boxes in it from the chain `first`.
  void remove_block(std::uint32_t& first, std::uint32_t block) {
    std::uint32_t* link = &first;
    while (*link != block) link = &heads_[*link].next;
    *link = heads_[block].next;
    heads_[block] = {no_slot, no_slot, 0, 0};
    free_.push_back(block);
  }

  /// The slot of the first lane of a block among `lanes`, given as bits.
  static std::uint32_t slot(std::uint32_t block, std::uint32_t lanes) {
    return block * width + static_cast<std::uint32_t>(std::countr_zero(lanes));
  }

  /// Puts a box into the first free lane of the block. Returns its slot.
  std::uint32_t insert(std::uint32_t block, const Box<D>& box, BoxId id) {
    const auto lane = static_cast<std::uint32_t>(std::countr_one(heads_[block].used));
    const std::uint32_t slot = block * width + lane;
    put(slot, box, id);
    return slot;
  }

  /// Puts a box into a free slot.
  void put(std::uint32_t slot, const Box<D>& box, BoxId id) {
    heads_[slot / width].used = static_cast<std::uint16_t>(heads_[slot / width].used | bit(slot));
    blocks_[slot / width].id[slot % width] = index(id);
    set(slot, box);
  }

  /// Empties a slot.
  void erase(std::uint32_t slot) {
    heads_[slot / width].used = static_cast<std::uint16_t>(heads_[slot / width].used & ~bit(slot));
    unmark(slot);
    set(slot, nan_box<D>());
  }

  Box<D> box(std::uint32_t slot) const { return blocks_[slot / width].box(slot % width); }
  BoxId id(std::uint32_t slot) const { return BoxId{blocks_[slot / width].id[slot % width]}; }
  void set(std::uint32_t slot, const Box<D>& box) { blocks_[slot / width].set(slot % width, box); }

  /// Prefetches a slot that will be set.
  void prefetch(std::uint32_t slot) const {
    const std::uint32_t block = slot / width;
    if (block >= blocks_.size()) return;
    kernels::prefetch(&heads_[block]);
    for (int axis = 0; axis < D; ++axis) {
      kernels::prefetch(blocks_[block].min[axis].data());
      kernels::prefetch(blocks_[block].max[axis].data());
    }
  }

  /// Marks the box of a slot as moving, or as no longer moving.
  void mark(std::uint32_t slot) {
    heads_[slot / width].moving = static_cast<std::uint16_t>(heads_[slot / width].moving | bit(slot));
  }
  void unmark(std::uint32_t slot) {
    heads_[slot / width].moving = static_cast<std::uint16_t>(heads_[slot / width].moving & ~bit(slot));
  }
  /// The same, while other threads mark and unmark other slots.
  void mark_beside_others(std::uint32_t slot) {
    set_shared(heads_[slot / width].moving, static_cast<std::uint16_t>(bit(slot)));
  }
  void unmark_beside_others(std::uint32_t slot) {
    clear_shared(heads_[slot / width].moving, static_cast<std::uint16_t>(bit(slot)));
  }
  bool is_marked(std::uint32_t slot) const { return (heads_[slot / width].moving & bit(slot)) != 0; }

  /// Reserves memory for an eighth more blocks than `count`. Blocks are most of a structure's memory, which
  /// should not double as a vector does.
  void reserve(std::size_t count) {
    constexpr std::size_t spare = 16;
    heads_.reserve(count + count / 8 + spare);
    blocks_.reserve(count + count / 8 + spare);
  }

  /// Drops all blocks, and releases the memory if it far exceeds what was in use.
  void clear() {
    if (blocks_.capacity() > 4 * (blocks_.size() - free_.size()) + 1024) {
      // Not `= {}`, which assigns an empty list and keeps the memory.
      heads_ = std::vector<BlockHead>();
      blocks_ = std::vector<Block<D>>();
      free_ = std::vector<std::uint32_t>();
    }
    heads_.clear();
    blocks_.clear();
    free_.clear();
  }

  std::size_t bytes() const noexcept {
    return heads_.capacity() * sizeof(BlockHead) + blocks_.capacity() * sizeof(Block<D>) +
           free_.capacity() * sizeof(std::uint32_t);
  }

 private:
  static constexpr std::uint32_t bit(std::uint32_t slot) { return 1U << slot % width; }

  std::vector<BlockHead> heads_;
  std::vector<Block<D>> blocks_;
  std::vector<std::uint32_t> free_;
};

}  // namespace broadside::kernels
