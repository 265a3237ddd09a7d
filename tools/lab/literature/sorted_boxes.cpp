// The sweep over sorted boxes, written once with Highway and compiled for each SIMD target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/literature/sorted_boxes.cpp"
#include "lab/literature/sorted_boxes.hpp"

#include <bit>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace broadside::lab::literature::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Eight lanes, as in the publication, or as many as the target has.
using Floats = hn::CappedTag<float, 8>;
using Integers = hn::RebindToSigned<Floats>;
static_assert(hn::MaxLanes(Floats()) <= SortedBoxes<2>::read_ahead);

/// Writes the pairs of `box` at `place` with the boxes of `others` from `first` on that begin before it ends.
template <int D>
HWY_INLINE void scan(const SortedBoxes<D>& boxes, std::size_t place, const SortedBoxes<D>& others,
                     std::size_t first, Checkpoint& checkpoint, PairSink& pairs) {
  const std::int32_t end = boxes.end()[place];
  if (others.begin()[first] > end) return;
  constexpr Floats floats;
  constexpr Integers integers;
  const auto limit = hn::Set(integers, end + 1);  // at most infinity's, so there is a greater integer
  const auto low0 = hn::Set(floats, boxes.low(0)[place]);
  const auto high0 = hn::Set(floats, boxes.high(0)[place]);
  const auto low1 = hn::Set(floats, boxes.low(D - 2)[place]);
  const auto high1 = hn::Set(floats, boxes.high(D - 2)[place]);
  const BoxId id = boxes.ids()[place];
  for (std::size_t at = first;; at += hn::Lanes(floats)) {
    const auto begins = hn::Lt(hn::LoadU(integers, others.begin() + at), limit);
    auto hit = hn::And(hn::Le(hn::LoadU(floats, others.low(0) + at), high0),
                       hn::Le(low0, hn::LoadU(floats, others.high(0) + at)));
    if constexpr (D == 3) {
      hit = hn::And(hit, hn::And(hn::Le(hn::LoadU(floats, others.low(1) + at), high1),
                                 hn::Le(low1, hn::LoadU(floats, others.high(1) + at))));
    }
    hit = hn::And(hit, hn::RebindMask(floats, begins));
    std::array<std::uint8_t, 8> bits{};
    hn::StoreMaskBits(floats, hit, bits.data());
    for (unsigned set = bits[0]; set != 0; set &= set - 1)
      pairs.add(id, others.ids()[at + static_cast<std::size_t>(std::countr_zero(set))]);
    if (others.begin()[at + hn::Lanes(floats)] > end) return checkpoint.count(at + hn::Lanes(floats) - first);
  }
}

template <int D>
HWY_INLINE void sweep_one(const SortedBoxes<D>& boxes, Checkpoint& checkpoint, PairSink& pairs) {
  for (std::size_t i = 0; i + 1 < boxes.size(); ++i) scan(boxes, i, boxes, i + 1, checkpoint, pairs);
}

/// The pairs in which the box of `others` begins with or after the box of `boxes`; with OnlyAfter, only after
/// it.
template <int D, bool OnlyAfter>
HWY_INLINE void sweep_across(const SortedBoxes<D>& boxes, const SortedBoxes<D>& others,
                             Checkpoint& checkpoint, PairSink& pairs) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < boxes.size() && first < others.size(); ++i) {
    const std::int32_t begin = boxes.begin()[i];
    while (OnlyAfter ? others.begin()[first] <= begin : others.begin()[first] < begin) ++first;
    scan(boxes, i, others, first, checkpoint, pairs);
  }
}

template <int D>
HWY_INLINE void sweep_two(const SortedBoxes<D>& left, const SortedBoxes<D>& right, Checkpoint& checkpoint,
                          PairSink& pairs) {
  sweep_across<D, false>(left, right, checkpoint, pairs);
  sweep_across<D, true>(right, left, checkpoint, pairs);
}

void sweep_one_2(const SortedBoxes<2>& boxes, Checkpoint& checkpoint, PairSink& pairs) {
  sweep_one(boxes, checkpoint, pairs);
}
void sweep_one_3(const SortedBoxes<3>& boxes, Checkpoint& checkpoint, PairSink& pairs) {
  sweep_one(boxes, checkpoint, pairs);
}
void sweep_two_2(const SortedBoxes<2>& left, const SortedBoxes<2>& right, Checkpoint& checkpoint,
                 PairSink& pairs) {
  sweep_two(left, right, checkpoint, pairs);
}
void sweep_two_3(const SortedBoxes<3>& left, const SortedBoxes<3>& right, Checkpoint& checkpoint,
                 PairSink& pairs) {
  sweep_two(left, right, checkpoint, pairs);
}

}  // namespace
}  // namespace broadside::lab::literature::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::lab::literature {

HWY_EXPORT(sweep_one_2);
HWY_EXPORT(sweep_one_3);
HWY_EXPORT(sweep_two_2);
HWY_EXPORT(sweep_two_3);

template <>
void sweep(const SortedBoxes<2>& boxes, Checkpoint& checkpoint, PairSink& pairs) {
  HWY_DYNAMIC_DISPATCH(sweep_one_2)(boxes, checkpoint, pairs);
}

template <>
void sweep(const SortedBoxes<3>& boxes, Checkpoint& checkpoint, PairSink& pairs) {
  HWY_DYNAMIC_DISPATCH(sweep_one_3)(boxes, checkpoint, pairs);
}

template <>
void sweep(const SortedBoxes<2>& left, const SortedBoxes<2>& right, Checkpoint& checkpoint, PairSink& pairs) {
  HWY_DYNAMIC_DISPATCH(sweep_two_2)(left, right, checkpoint, pairs);
}

template <>
void sweep(const SortedBoxes<3>& left, const SortedBoxes<3>& right, Checkpoint& checkpoint, PairSink& pairs) {
  HWY_DYNAMIC_DISPATCH(sweep_two_3)(left, right, checkpoint, pairs);
}

}  // namespace broadside::lab::literature
#endif  // HWY_ONCE
