// The kernels of trackers: one box that moves against boxes that rest.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/toggle.cpp"
#include "kernels/toggle.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/compress.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, read_ahead>;
using Ids = hn::Rebind<std::uint32_t, Floats>;
using FloatVector = hn::Vec<Floats>;
using IdVector = hn::Vec<Ids>;

template <typename Tag>
HWY_INLINE std::uint32_t bits_of(Tag tag, hn::Mask<Tag> mask) {
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(tag, mask, bytes.data());
  std::uint16_t bits;
  std::memcpy(&bits, bytes.data(), sizeof bits);
  return bits;
}

/// A box in every lane.
template <int D>
struct Everywhere {
  HWY_INLINE explicit Everywhere(const Box<D>& box) {
    for (int axis = 0; axis < D; ++axis) {
      min[axis] = hn::Set(Floats(), box.min[axis]);
      max[axis] = hn::Set(Floats(), box.max[axis]);
    }
  }

  FloatVector min[D];
  FloatVector max[D];
};

/// Boxes that follow each other, one a lane.
template <int D>
struct Lanes {
  template <typename Arrays>
  HWY_INLINE Lanes(const Arrays& arrays, std::size_t at) {
    for (int axis = 0; axis < D; ++axis) {
      min[axis] = hn::LoadU(Floats(), arrays.min[axis] + at);
      max[axis] = hn::LoadU(Floats(), arrays.max[axis] + at);
    }
  }

  HWY_INLINE hn::Mask<Floats> overlaps(const Everywhere<D>& box) const {
    auto touching = hn::And(hn::Le(min[0], box.max[0]), hn::Le(box.min[0], max[0]));
    for (int axis = 1; axis < D; ++axis) {
      touching = hn::And(touching, hn::Le(min[axis], box.max[axis]));
      touching = hn::And(touching, hn::Le(box.min[axis], max[axis]));
    }
    return touching;
  }

  FloatVector min[D];
  FloatVector max[D];
};

template <int D>
std::size_t toggles_in_run(const Mover<D>& mover, const Run<D>& run, std::size_t begin, std::size_t end,
                           Toggle* toggles) {
  constexpr std::size_t lanes = hn::MaxLanes(Floats());
  const Everywhere<D> before(mover.before);
  const Everywhere<D> now(mover.now);
  const std::uint32_t both = mover.refiltered ? ~0U : 0U;
  std::size_t count = 0;
  for (std::size_t at = begin; at < end; at += lanes) {
    const Lanes<D> boxes(run, at);
    const std::uint32_t did = bits_of(Floats(), boxes.overlaps(before));
    const std::uint32_t does = bits_of(Floats(), boxes.overlaps(now));
    std::uint32_t toggled = (did ^ does) | (did & does & both);
    if (HWY_LIKELY(toggled == 0)) continue;
    if (end - at < lanes) toggled &= (1U << (end - at)) - 1;
    for (; toggled != 0; toggled &= toggled - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(toggled));
      const BoxId id = run.id[at + lane];
      toggles[count] = {id, (does >> lane & 1) != 0};
      count += static_cast<std::size_t>(id != mover.id);
    }
  }
  return count;
}

/// Writes the ids at the mask's lanes to `out`, without a branch.
HWY_INLINE std::size_t put(IdVector ids, hn::Mask<Ids> mask, std::uint32_t* out) {
  hn::StoreU(compress(Ids(), ids, mask), Ids(), out);
  return hn::CountTrue(Ids(), mask);
}

template <int D>
void step_in_blocks(const Mover<D>& mover, Block<D>* const* blocks, std::size_t count, StepEvents& events) {
  constexpr std::size_t lanes = hn::MaxLanes(Floats());
  const Floats floats;
  const Ids ids;
  const Everywhere<D> before(mover.before);
  const Everywhere<D> now(mover.now);
  const IdVector id = hn::Set(ids, index(mover.id));
  std::uint32_t* begun = events.begun;
  std::uint32_t* ended = events.ended;
  std::size_t hits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Block<D>& block = *blocks[i];
    for (std::size_t at = 0; at < Block<D>::places; at += lanes) {
      const Lanes<D> boxes(block, at);
      const IdVector there = hn::LoadU(ids, block.id + at);
      // The last place's id is no id.
      const auto own = hn::And(hn::Eq(there, id), hn::FirstN(ids, Block<D>::capacity - at));
      const auto did = hn::AndNot(own, hn::RebindMask(ids, boxes.overlaps(before)));
      const auto does = hn::AndNot(own, hn::RebindMask(ids, boxes.overlaps(now)));
      hits += hn::CountTrue(ids, does);
      begun += put(there, HWY_UNLIKELY(mover.refiltered) ? does : hn::AndNot(did, does), begun);
      ended += put(there, hn::AndNot(does, did), ended);
      const auto own_floats = hn::RebindMask(floats, own);
      for (int axis = 0; axis < D; ++axis) {
        hn::BlendedStore(now.min[axis], own_floats, floats, block.min[axis] + at);
        hn::BlendedStore(now.max[axis], own_floats, floats, block.max[axis] + at);
      }
    }
  }
  events.begun_count = static_cast<std::size_t>(begun - events.begun);
  events.ended_count = static_cast<std::size_t>(ended - events.ended);
  events.hits = hits;
}

}  // namespace

// What the dispatch below can name: no templates.
std::size_t toggles_in_run_2(const Mover<2>& mover, const Run<2>& run, std::size_t begin, std::size_t end,
                             Toggle* toggles) {
  return toggles_in_run(mover, run, begin, end, toggles);
}
std::size_t toggles_in_run_3(const Mover<3>& mover, const Run<3>& run, std::size_t begin, std::size_t end,
                             Toggle* toggles) {
  return toggles_in_run(mover, run, begin, end, toggles);
}
void step_in_blocks_2(const Mover<2>& mover, Block<2>* const* blocks, std::size_t count, StepEvents& events) {
  step_in_blocks(mover, blocks, count, events);
}
void step_in_blocks_3(const Mover<3>& mover, Block<3>* const* blocks, std::size_t count, StepEvents& events) {
  step_in_blocks(mover, blocks, count, events);
}

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(toggles_in_run_2);
HWY_EXPORT(toggles_in_run_3);
HWY_EXPORT(step_in_blocks_2);
HWY_EXPORT(step_in_blocks_3);

template <>
std::size_t find_toggles(const Mover<2>& mover, const Run<2>& run, std::size_t begin, std::size_t end,
                         Toggle* toggles) {
  return HWY_DYNAMIC_DISPATCH(toggles_in_run_2)(mover, run, begin, end, toggles);
}

template <>
std::size_t find_toggles(const Mover<3>& mover, const Run<3>& run, std::size_t begin, std::size_t end,
                         Toggle* toggles) {
  return HWY_DYNAMIC_DISPATCH(toggles_in_run_3)(mover, run, begin, end, toggles);
}

template <>
void take_step(const Mover<2>& mover, Block<2>* const* blocks, std::size_t count, StepEvents& events) {
  HWY_DYNAMIC_DISPATCH(step_in_blocks_2)(mover, blocks, count, events);
}

template <>
void take_step(const Mover<3>& mover, Block<3>* const* blocks, std::size_t count, StepEvents& events) {
  HWY_DYNAMIC_DISPATCH(step_in_blocks_3)(mover, blocks, count, events);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE
