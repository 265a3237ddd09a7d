// PairWriter: writes the pairs that are hits. load_ids(): loads ids. For files that Highway compiles for each
// instruction set.
//
// Both access memory as bytes, which C++ allows for any object.
//
// Included once per SIMD target, hence no #pragma once.
#if defined(BROADSIDE_KERNELS_PAIR_WRITER) == defined(HWY_TARGET_TOGGLE)
#ifdef BROADSIDE_KERNELS_PAIR_WRITER
#undef BROADSIDE_KERNELS_PAIR_WRITER
#else
#define BROADSIDE_KERNELS_PAIR_WRITER
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "broadside/pair.hpp"

#include "kernels/compress.hpp"
#include "kernels/last_test.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The ids from `ids` on, one per lane.
template <typename Ids>
HWY_INLINE hn::Vec<Ids> load_ids(Ids tag, const BoxId* ids) {
#if HWY_TARGET == HWY_SCALAR
  return hn::Set(tag, index(*ids));
#else
  const hn::Repartition<std::uint8_t, Ids> bytes;
  return hn::BitCast(tag, hn::LoadU(bytes, reinterpret_cast<const std::uint8_t*>(ids)));
#endif
}

/// The ids, with a touching_bit in the lanes of `touching`.
template <typename Ids>
HWY_INLINE hn::Vec<Ids> marked(Ids tag, hn::Vec<Ids> ids, hn::Mask<Ids> touching) {
  return hn::Or(ids, hn::IfThenElseZero(touching, hn::Set(tag, touching_bit)));
}

/// Writes pairs to a sink. Takes room from the sink in large pieces, not for each hit. `Ids` is the tag of
/// vectors of ids. If `LastTest` is InDouble, the second ids of pairs that only touch are marked.
template <typename Ids, typename LastTest = ByFloats>
class PairWriter {
  using IdVector = hn::Vec<Ids>;
  using Hits = hn::Mask<Ids>;

 public:
  /// How many pairs there must be room for before a vector of pairs is written.
  static constexpr std::size_t at_once = 16;

  explicit PairWriter(PairSink& sink, LastTest last_test = {})
      : last_test_(last_test), sink_(&sink), begin_(sink.room(PairSink::max_room)), out_(begin_) {}

  ~PairWriter() { sink_->commit(static_cast<std::size_t>(last_test_(begin_, out_) - begin_)); }

  PairWriter(const PairWriter&) = delete;
  PairWriter& operator=(const PairWriter&) = delete;

  /// How many pairs were written, including any that the last test drops, since the number of lanes
  /// determines when that test runs.
  std::uint64_t written() const { return handed_on_ + static_cast<std::uint64_t>(out_ - begin_); }

  /// How many times `at_once` pairs may be written before room() is called again: at least `min` times.
  HWY_INLINE std::size_t room(std::size_t min = 1) {
    if (HWY_UNLIKELY(left() < min)) {
      Pair* const begin = begin_;
      handed_on_ += static_cast<std::uint64_t>(out_ - begin);
      Pair* const end = last_test_(begin, out_);
      begin_ = out_ = end;  // if the sink throws, this much is committed already
      begin_ = out_ = next_room(*sink_, static_cast<std::size_t>(end - begin));
    }
    return left();
  }

  /// Writes the pairs of `a` and `b`, lane by lane, that are hits. Takes the room of one vector.
  HWY_INLINE void write(IdVector a, IdVector b, Hits hits) {
    const Ids tag;
    if (is_none(hits)) return;
    store(compress(tag, a, hits), compress(tag, b, hits), count_true(tag, hits));
  }

  /// Writes the pairs of `query`, which is the same in every lane, with the `ids` that are hits.
  HWY_INLINE void write_of(IdVector query, IdVector ids, Hits hits) {
    const Ids tag;
    if (is_none(hits)) return;
    store(query, compress(tag, ids, hits), count_true(tag, hits));
  }

 private:
  /// Whether to skip a vector because it has no hits. On WebAssembly, writing one takes longer than a
  /// mispredicted branch: skipping halves the time of a sweep of 10,000 boxes.
  static HWY_INLINE bool is_none(Hits hits) { return HWY_TARGET == HWY_WASM && all_false(Ids(), hits); }

  static HWY_NOINLINE Pair* next_room(PairSink& sink, std::size_t written) {
    sink.commit(written);
    return sink.room(PairSink::max_room);
  }

  std::size_t left() const {
    return (PairSink::max_room - static_cast<std::size_t>(out_ - begin_)) / at_once;
  }

  HWY_INLINE void store(IdVector a, IdVector b, std::size_t count) {
    const IdVector first = hn::Min(a, b);
    const IdVector second = hn::Max(a, b);
#if HWY_TARGET == HWY_SCALAR
    *out_ = {BoxId{hn::GetLane(first)}, BoxId{hn::GetLane(second)}};
#else
    // A pair is its first id in the low half of 64 bits and its second one in the high half.
    const hn::Half<Ids> half;
    const hn::RepartitionToWide<Ids> wide;
    const hn::Repartition<std::uint8_t, Ids> bytes;
    const auto write_half = [&](auto firsts, auto seconds, Pair* to) HWY_ATTR {
      const auto pairs = hn::Or(hn::PromoteTo(wide, firsts), hn::ShiftLeft<32>(hn::PromoteTo(wide, seconds)));
      hn::StoreU(hn::BitCast(bytes, pairs), bytes, reinterpret_cast<std::uint8_t*>(to));
    };
    write_half(hn::LowerHalf(half, first), hn::LowerHalf(half, second), out_);
    // With many lanes, few are hits.
    if (hn::MaxLanes(Ids()) < 16 || HWY_UNLIKELY(count > hn::Lanes(wide)))
      write_half(hn::UpperHalf(half, first), hn::UpperHalf(half, second), out_ + hn::Lanes(wide));
#endif
    out_ += count;
  }

  LastTest last_test_;
  PairSink* sink_;
  Pair* begin_;
  Pair* out_;
  std::uint64_t handed_on_ = 0;
};

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
