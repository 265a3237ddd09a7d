// Movers compared with packs, written once for every instruction set.
//
// Most boxes rest, and most pairs neither begin nor end: sixteen boxes are compared with where the mover was
// and with where it is, and what is alike in both is left out before anything is written.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/packs.cpp"
#include "kernels/packs.hpp"

#include <algorithm>

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/pair_writer.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

using Floats = hn::CappedTag<float, pack_size>;
using Numbers = hn::Rebind<std::uint32_t, Floats>;
using FloatVector = hn::Vec<Floats>;
using NumberVector = hn::Vec<Numbers>;
using Hits = hn::Mask<Numbers>;
using Writer = PairWriter<Numbers>;
static_assert(pack_size == Writer::at_once);

constexpr std::size_t lanes = hn::MaxLanes(Floats());

/// So many tasks ahead, a pack is asked for.
constexpr std::size_t ahead = 4;

alignas(64) constexpr std::uint32_t bit_of[pack_size] = {
    1U << 0, 1U << 1, 1U << 2,  1U << 3,  1U << 4,  1U << 5,  1U << 6,  1U << 7,
    1U << 8, 1U << 9, 1U << 10, 1U << 11, 1U << 12, 1U << 13, 1U << 14, 1U << 15};

/// One box, in every lane.
template <int D>
struct Query {
  HWY_INLINE explicit Query(const Box<D>& box) {
    for (int axis = 0; axis < D; ++axis) {
      min[axis] = hn::Set(Floats(), box.min[axis]);
      max[axis] = hn::Set(Floats(), box.max[axis]);
    }
  }

  /// Which of the boxes from lane `at` on it overlaps.
  HWY_INLINE Hits touching(const Pack<D>& pack, std::size_t at) const {
    const Floats floats;
    auto hits = hn::Le(hn::Load(floats, pack.min[0] + at), max[0]);
    hits = hn::And(hits, hn::Le(min[0], hn::Load(floats, pack.max[0] + at)));
    for (int axis = 1; axis < D; ++axis) {
      hits = hn::And(hits, hn::Le(hn::Load(floats, pack.min[axis] + at), max[axis]));
      hits = hn::And(hits, hn::Le(min[axis], hn::Load(floats, pack.max[axis] + at)));
    }
    return hn::RebindMask(Numbers(), hits);
  }

  FloatVector min[D];
  FloatVector max[D];
};

template <int D>
HWY_INLINE void prefetch(const Pack<D>& pack) {
  const auto* const line = reinterpret_cast<const char*>(&pack);
  for (std::size_t at = 0; at < sizeof(pack); at += 64) hwy::Prefetch(line + at);
}

template <int D>
std::uint64_t compare_packs(const Packs<D>& packs, std::span<const MovingBox<D>> movers,
                            std::span<const PackTask> tasks, PairSink& pairs) {
  const Numbers numbers;
  Writer writer(pairs);
  std::uint64_t compared = 0;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (i + ahead < tasks.size()) {
      prefetch(packs.boxes[tasks[i + ahead].pack]);
      hwy::Prefetch(&movers[tasks[i + ahead].mover]);
    }
    const MovingBox<D>& mover = movers[tasks[i].mover];
    const Query<D> before(mover.before);
    const Query<D> now(mover.now);
    const NumberVector id = hn::Set(numbers, mover.id);
    const Hits any = hn::Eq(hn::Set(numbers, mover.refiltered), hn::Set(numbers, 1U));
    for (std::uint32_t number = tasks[i].pack; number != no_pack; number = packs.states[number].next) {
      const Pack<D>& pack = packs.boxes[number];
      const std::uint32_t moved = packs.states[number].moved;
      compared += pack_size;
      for (std::size_t at = 0; at < pack_size; at += lanes) {
        const NumberVector ids = hn::Load(numbers, pack.id + at);
        const Hits did = before.touching(pack, at);
        const Hits does = now.touching(pack, at);
        Hits hits = hn::Or(hn::Xor(did, does), hn::And(any, does));
        if (moved >> at != 0) {
          const Hits moves = hn::TestBit(hn::Set(numbers, moved), hn::Load(numbers, bit_of + at));
          const Query<D> both(mover.both);
          const Hits later = hn::And(moves, hn::And(hn::Gt(ids, id), both.touching(pack, at)));
          hits = hn::Or(hn::AndNot(moves, hits), later);
        }
        if (hn::AllFalse(numbers, hits)) continue;
        writer.room();
        writer.write_of(id, ids, hits);
      }
    }
  }
  return compared;
}

}  // namespace

// What the dispatch below can name: no templates.
std::uint64_t compare_2(const Packs<2>& packs, std::span<const MovingBox<2>> movers,
                        std::span<const PackTask> tasks, PairSink& pairs) {
  return compare_packs(packs, movers, tasks, pairs);
}
std::uint64_t compare_3(const Packs<3>& packs, std::span<const MovingBox<3>> movers,
                        std::span<const PackTask> tasks, PairSink& pairs) {
  return compare_packs(packs, movers, tasks, pairs);
}

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(compare_2);
HWY_EXPORT(compare_3);

template <>
std::uint64_t compare(const Packs<2>& packs, std::span<const MovingBox<2>> movers,
                      std::span<const PackTask> tasks, PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(compare_2)(packs, movers, tasks, pairs);
}

template <>
std::uint64_t compare(const Packs<3>& packs, std::span<const MovingBox<3>> movers,
                      std::span<const PackTask> tasks, PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(compare_3)(packs, movers, tasks, pairs);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE
