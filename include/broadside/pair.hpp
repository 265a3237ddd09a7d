// BoxId, Pair, and PairSink: where an algorithm writes the pairs that it finds.
#pragma once

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
/// is that box. A number must be converted explicitly: BoxId(number).
enum BoxId : std::uint32_t {};

/// The id as a 32-bit number, for an explicit conversion.
[[nodiscard]] constexpr std::uint32_t index(BoxId id) noexcept { return static_cast<std::uint32_t>(id); }

/// Two different boxes, with first < second. If two sets are searched: a box of the left set and a box of the
/// right set.
struct Pair {
  BoxId first;
  BoxId second;

  friend constexpr auto operator<=>(const Pair&, const Pair&) = default;
};

/// The pair as one number that sorts as pairs do: first in the high half, second in the low half.
[[nodiscard]] constexpr std::uint64_t key(Pair pair) noexcept {
  return std::uint64_t{index(pair.first)} << 32 | index(pair.second);
}

namespace detail {
/// Up to this number of pairs, a comparison sort costs less than a radix sort and needs no scratch memory.
inline constexpr std::size_t max_compared_pairs = 128;

/// sort_pairs() with two arrays. If there are more than max_compared_pairs, `scratch` must be as long as
/// `pairs`. Returns true if the sorted pairs are in `scratch`, false if they are in `pairs`.
BROADSIDE_PUBLIC bool sort_pairs(std::span<Pair> pairs, std::span<Pair> scratch);

/// Mixes bits, so that each one changes about half the bits of the result: the finaliser of MurmurHash3.
constexpr std::uint64_t mixed(std::uint64_t bits) noexcept {
  bits = (bits ^ bits >> 33) * 0xff51afd7ed558ccdU;
  bits = (bits ^ bits >> 33) * 0xc4ceb9fe1a85ec53U;
  return bits ^ bits >> 33;
}
}  // namespace detail

/// Sorts pairs by their first and then by their second id. Many pairs are sorted in O(n), by a radix sort
/// over the bits in which they differ. `scratch` is memory to keep between calls; its contents afterwards are
/// unspecified.
inline void sort_pairs(std::vector<Pair>& pairs, std::vector<Pair>& scratch) {
  if (pairs.size() > detail::max_compared_pairs) scratch.resize(pairs.size());
  if (detail::sort_pairs(pairs, scratch)) pairs.swap(scratch);
}

/// Sorts in place, by comparisons. `checkpoint` (executor.hpp) counts them, so that the caller can end a long
/// sort. Exceptions from it pass through; the order is then unspecified.
BROADSIDE_PUBLIC void sort_pairs(std::span<Pair> pairs, Checkpoint& checkpoint);

/// Receives pairs. add() writes a pair to a small buffer, and a full buffer is passed to consume().
///
/// Finder and Tracker flush the sink before they return. Only one thread at a time uses a sink: a search by
/// several threads collects the pairs and calls consume() in the thread that called find(), in the order of a
/// search by one thread. Sinks that can be cloned are an exception: see empty_clone().
class BROADSIDE_PUBLIC PairSink {
 public:
  /// The maximum of room().
  static constexpr std::size_t max_room = 512;

  virtual ~PairSink() = default;

  /// Writes the pair of two different boxes, in either order.
  void add(BoxId a, BoxId b) {
    if (used_ == buffer_.size()) flush();
    buffer_[used_++] = a < b ? Pair{a, b} : Pair{b, a};
  }

  /// Space for `count` <= max_room pairs, to be written all at once and then committed. Each pair must have
  /// first < second. The pointer is valid until the next call of any member.
  [[nodiscard]] Pair* room(std::size_t count) {
    if (buffer_.size() - used_ < count) flush();
    return buffer_.data() + used_;
  }

  /// Adds the first `count` pairs that were written to the last room().
  void commit(std::size_t count) noexcept { used_ += count; }

  /// Passes the buffer to consume(). If consume() throws, that chunk counts as passed on.
  void flush() {
    if (const std::size_t count = std::exchange(used_, 0); count > 0) consume({buffer_.data(), count});
  }

  /// Passes the buffer and then `pairs` to consume(), in full chunks and without copying. Each pair must have
  /// first < second. Throws as flush() does.
  void put(std::span<const Pair> pairs) {
    flush();
    while (!pairs.empty()) {
      const std::size_t count = pairs.size() < buffer_.size() ? pairs.size() : buffer_.size();
      consume(pairs.first(count));
      pairs = pairs.subspan(count);
    }
  }

  /// Empties the buffer without passing it on, as after an exception in the middle of a search.
  void discard() noexcept { used_ = 0; }

  /// A new sink of the same kind without pairs; null, the default, if the sink cannot be cloned. A sink that
  /// does not depend on the order of pairs, such as a counter, overrides this and merge(). A search by
  /// several threads then gives each thread its own clone and stores no pairs.
  [[nodiscard]] virtual std::unique_ptr<PairSink> empty_clone() const { return nullptr; }

  /// Adds the result of a clone of this sink, which has been flushed. Called by the thread that called
  /// find(). Throws std::logic_error if it is not overridden.
  virtual void merge(PairSink& clone);

 protected:
  PairSink() = default;
  /// A copy has the same pairs in its buffer.
  PairSink(const PairSink& other) { *this = other; }
  PairSink& operator=(const PairSink& other) {
    used_ = other.used_;
    for (std::size_t i = 0; i < used_; ++i) buffer_[i] = other.buffer_[i];
    return *this;
  }

 private:
  friend class core::FilterSink;

  virtual void consume(std::span<const Pair> pairs) = 0;

  /// This sink if it is one of the library's filters, else null. Threads share the work of a filter.
  virtual core::FilterSink* as_filter() noexcept { return nullptr; }

  std::size_t used_ = 0;
  std::array<Pair, 2 * max_room> buffer_;
};

}  // namespace broadside
