// PairList and PairBlocks: pairs that wait to be delivered, in blocks, so that memory for them has a limit.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "broadside/pair.hpp"

namespace broadside::core {

/// Some thousand pairs, and the block that follows in a list.
struct PairBlock {
  PairBlock* next;
  std::size_t size;
  std::array<Pair, 4096> pairs;
};

/// The blocks of all lists of a search. Keeps those that are given back. Thread-safe.
class PairBlocks {
 public:
  /// The most blocks in use at once: 64 MiB.
  static constexpr std::size_t max_blocks = (std::size_t{64} << 20) / sizeof(PairBlock::pairs);

  /// An empty block; null where `max_blocks` are in use. Throws std::bad_alloc.
  PairBlock* take();

  /// Gives back a block and all that follow it.
  void give_back(PairBlock* first) noexcept;

  std::size_t used() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<PairBlock>> all_;
  PairBlock* free_ = nullptr;
  std::size_t used_ = 0;
};

/// Pairs in the order in which they were appended. Gives its blocks back.
class PairList {
 public:
  PairList() = default;
  PairList(PairList&& other) noexcept
      : blocks_(other.blocks_),
        first_(std::exchange(other.first_, nullptr)),
        last_(std::exchange(other.last_, nullptr)) {}
  PairList& operator=(PairList&& other) noexcept {
    clear();
    blocks_ = other.blocks_;
    first_ = std::exchange(other.first_, nullptr);
    last_ = std::exchange(other.last_, nullptr);
    return *this;
  }
  ~PairList() { clear(); }

  /// False if `blocks` has too little room for all of them, or throws std::bad_alloc; the list is then good
  /// for clear() alone.
  bool append(std::span<const Pair> pairs, PairBlocks& blocks);

  /// Hands all pairs on, and gives back each block once the sink has taken it.
  void move_to(PairSink& sink);

  void clear() noexcept;

 private:
  PairBlocks* blocks_ = nullptr;  // null before the first block
  PairBlock* first_ = nullptr;
  PairBlock* last_ = nullptr;
};

}  // namespace broadside::core
