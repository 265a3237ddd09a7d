// Ids of boxes, pairs of ids, and PairSink: where an algorithm writes the pairs it finds.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "broadside/export.hpp"

namespace broadside {
class Checkpoint;

namespace core {
class FilterSink;
}  // namespace core

/// The index of a box in the caller's array, counted from 0. It converts implicitly to a number, so boxes[id]
/// is that box. The conversion from a number must be explicit: BoxId(number).
enum BoxId : std::uint32_t {};

/// The id as a 32-bit number, for an explicit conversion.
constexpr std::uint32_t index(BoxId id) noexcept { return static_cast<std::uint32_t>(id); }

/// Two different boxes; first < second. Where two sets are joined, a box of the left one and a box of the
/// right one.
struct Pair {
  BoxId first;
  BoxId second;

  friend constexpr auto operator<=>(const Pair&, const Pair&) = default;
};

/// A pair as one number that orders as pairs do: first in the high half, second in the low.
constexpr std::uint64_t key(Pair pair) noexcept {
  return std::uint64_t{index(pair.first)} << 32 | index(pair.second);
}

namespace detail {
/// Up to this number of pairs, a comparison sort costs less than a radix sort and needs no scratch memory.
inline constexpr std::size_t max_compared_pairs = 128;

/// sort_pairs() with two arrays. If there are more than max_compared_pairs, `scratch` must be as long as
/// `pairs`. Returns true if the sorted pairs are in `scratch`, false if they are in `pairs`.
BROADSIDE_PUBLIC bool sort_pairs(std::span<Pair> pairs, std::span<Pair> scratch);
}  // namespace detail

/// Sorts pairs by first, then by second id. O(n) for many pairs: a radix sort over the bits in which they
/// differ. `scratch` is memory to keep between calls; what it holds afterwards is unspecified.
inline void sort_pairs(std::vector<Pair>& pairs, std::vector<Pair>& scratch) {
  if (pairs.size() > detail::max_compared_pairs) scratch.resize(pairs.size());
  if (detail::sort_pairs(pairs, scratch)) pairs.swap(scratch);
}

/// The same in place, by comparison. `checkpoint` (executor.hpp) counts the comparisons, so that the caller
/// can end a long sort. Throws what the checkpoint throws; the order is then unspecified.
BROADSIDE_PUBLIC void sort_pairs(std::span<Pair> pairs, Checkpoint& checkpoint);

/// Takes pairs in chunks: writing one is inline, into a small buffer; consume() is called once a full chunk.
///
/// Finder and Tracker flush the sink they were given before they return. One thread at a time: a
/// search by several threads collects what they find and calls consume() in the thread that called find(),
/// with the pairs in the order in which one thread would have found them; unless the sink can be cloned.
class BROADSIDE_PUBLIC PairSink {
 public:
  /// The most pairs room() can be asked for at once.
  static constexpr std::size_t max_room = 512;

  virtual ~PairSink() = default;

  /// Writes the pair of two different boxes, in either order.
  void add(BoxId a, BoxId b) {
    if (used_ == buffer_.size()) flush();
    buffer_[used_++] = a < b ? Pair{a, b} : Pair{b, a};
  }

  /// Space for `count` <= max_room pairs, which a kernel writes at once and then commits. What is written
  /// there must have first < second. The pointer holds until the next call of any member.
  Pair* room(std::size_t count) {
    if (buffer_.size() - used_ < count) flush();
    return buffer_.data() + used_;
  }

  /// Says that the first `count` pairs of the last room() were written and count.
  void commit(std::size_t count) noexcept { used_ += count; }

  /// Hands on what is in the buffer. Throws what consume() throws; that chunk then counts as handed on.
  void flush() {
    if (const std::size_t count = std::exchange(used_, 0); count > 0) consume({buffer_.data(), count});
  }

  /// Hands on what is in the buffer and then `pairs`, which must have first < second, in full chunks and
  /// without copying them. Throws as flush() does.
  void put(std::span<const Pair> pairs) {
    flush();
    while (!pairs.empty()) {
      const std::span<const Pair> chunk = pairs.first(std::min(pairs.size(), buffer_.size()));
      consume(chunk);
      pairs = pairs.subspan(chunk.size());
    }
  }

  /// Forgets what is in the buffer: after an exception in the middle of a search.
  void discard() noexcept { used_ = 0; }

  /// A new sink of the same kind that has taken no pairs. A sink that makes the same of its pairs in whatever
  /// order they come, such as a count, overrides this and merge(): then a search by several threads gives
  /// each its own clone, and keeps no pairs. A null pointer, which is the standard: it cannot be cloned.
  virtual std::unique_ptr<PairSink> empty_clone() const { return nullptr; }

  /// Takes over what a flushed clone of this sink has made of its pairs. In the thread that called find().
  /// Throws std::logic_error where it is not overridden.
  virtual void merge(PairSink& clone);

  /// For the library, which shares the work of its own filters among threads: this sink, if it is one of
  /// them.
  virtual core::FilterSink* as_filter() noexcept { return nullptr; }

 protected:
  PairSink() = default;
  /// A copy has the same pairs still to hand on.
  PairSink(const PairSink& other) : used_(other.used_) {
    std::copy_n(other.buffer_.begin(), used_, buffer_.begin());
  }
  PairSink& operator=(const PairSink& other) {
    used_ = other.used_;
    std::copy_n(other.buffer_.begin(), used_, buffer_.begin());
    return *this;
  }

 private:
  virtual void consume(std::span<const Pair> pairs) = 0;

  std::size_t used_ = 0;
  std::array<Pair, 2 * max_room> buffer_;
};

}  // namespace broadside
