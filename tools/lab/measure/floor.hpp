// The lower bound of a search's time ("floor" in results): one pass that moves the boxes into parts, one that
// reads them back, and writing the pairs, timed beside the searches.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::lab {

/// Below this many boxes there is no lower bound: a few hundred boxes fit into the first cache and are best
/// left where they are.
inline constexpr std::size_t min_boxes_of_floor = 1'000;

/// How the lower bound writes to memory.
enum class Stores {
  plain,    ///< through the caches
  streamed  ///< past them (non-temporal), so that no line is read before it is overwritten
};

/// A search of more boxes than fit into a cache must move each box near its neighbours, read it there, and
/// write the pairs. This does that and nothing else: counts how many boxes begin in each of up to 512 stripes
/// of the first axis, moves the boxes with their indices into their stripes, reads them back, and writes as
/// many pairs as a search gives. So its time is that of a search that needs no time within its parts.
///
/// Boxes gather in a buffer for each stripe and leave it as whole cache lines: software write combining
/// (Wassenberg and Sanders 2011, arXiv 1008.2849). Streamed stores are faster where boxes and pairs exceed
/// the caches, plain ones otherwise: the bound is the lesser time.
///
/// Keeps its memory from one call to the next, as finders do. Single-threaded.
template <int D>
class Floor {
 public:
  /// Does the work for `boxes`, overwriting all of `pairs`. The written pairs are not overlapping pairs.
  void run(std::span<const Box<D>> boxes, std::span<Pair> pairs, Stores stores);

  /// A box that was moved.
  struct Moved {
    std::uint32_t index;
    Box<D> box;
    std::size_t stripe;
  };

  /// The boxes of the last run in their new order: by stripe, within a stripe in the caller's order.
  std::vector<Moved> moved() const;

 private:
  static constexpr std::size_t box_words = 2 * D;
  static constexpr std::size_t moved_words = box_words + 1;  // the bounds and the index

  /// A buffer: 16 moved boxes, which are a whole number of cache lines.
  static constexpr std::size_t block_boxes = 16;
  struct alignas(64) Block {
    std::array<std::uint32_t, block_boxes * moved_words> words;
  };

  /// Memory that is written to before it is read.
  class Blocks {
   public:
    /// At least this many blocks. Keeps the memory, but not what it holds.
    void reserve(std::size_t count);
    Block& operator[](std::size_t i) noexcept { return memory_[i]; }
    const Block& operator[](std::size_t i) const noexcept { return memory_[i]; }

   private:
    std::unique_ptr<Block[]> memory_;
    std::size_t count_ = 0;
  };

  struct Stripe {
    std::size_t begin = 0;  // the first of its blocks in moved_, which are whole but for the last one
    std::size_t count = 0;  // of its boxes
    std::size_t moved = 0;  // how many of these have been moved so far
  };

  void count(std::span<const Box<D>> boxes);
  template <Stores S>
  void move(std::span<const Box<D>> boxes);
  void read_back();

  std::vector<Stripe> stripes_;
  std::vector<std::uint16_t> stripe_of_;  // each box's
  Blocks buffers_;                        // one of each stripe
  Blocks moved_;
  std::uint32_t sum_ = 0;  // of the words read back, so that the compiler cannot leave that out
};

}  // namespace broadside::lab
