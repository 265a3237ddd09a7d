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

  HWY_INLINE std::uint32_t overlaps(const Everywhere<D>& box) const {
    auto touching = hn::And(hn::Le(min[0], box.max[0]), hn::Le(box.min[0], max[0]));
    for (int axis = 1; axis < D; ++axis) {
      touching = hn::And(touching, hn::Le(min[axis], box.max[axis]));
      touching = hn::And(touching, hn::Le(box.min[axis], max[axis]));
    }
    return bits_of(Floats(), touching);
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
    const std::uint32_t did = boxes.overlaps(before);
    const std::uint32_t does = boxes.overlaps(now);
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

template <int D>
void toggles_in_blocks(const Mover<D>& mover, const Block<D>* const* blocks, std::size_t count,
                       BlockToggles* answers) {
  constexpr std::size_t lanes = hn::MaxLanes(Floats());
  const Everywhere<D> before(mover.before);
  const Everywhere<D> now(mover.now);
  const IdVector id = hn::Set(Ids(), index(mover.id));
  const std::uint32_t both = mover.refiltered ? ~0U : 0U;
  for (std::size_t i = 0; i < count; ++i) {
    const Block<D>& block = *blocks[i];
    std::uint32_t did = 0;
    std::uint32_t does = 0;
    std::uint32_t own = 0;
    for (std::size_t at = 0; at < Block<D>::places; at += lanes) {
      const Lanes<D> boxes(block, at);
      did |= boxes.overlaps(before) << at;
      does |= boxes.overlaps(now) << at;
      own |= bits_of(Ids(), hn::Eq(hn::LoadU(Ids(), block.id + at), id)) << at;
    }
    const std::uint32_t toggled = ((did ^ does) | (did & does & both)) & ~own;
    answers[i] = {static_cast<std::uint16_t>(toggled), static_cast<std::uint16_t>(does),
                  static_cast<std::uint16_t>(own)};
  }
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
void toggles_in_blocks_2(const Mover<2>& mover, const Block<2>* const* blocks, std::size_t count,
                         BlockToggles* answers) {
  toggles_in_blocks(mover, blocks, count, answers);
}
void toggles_in_blocks_3(const Mover<3>& mover, const Block<3>* const* blocks, std::size_t count,
                         BlockToggles* answers) {
  toggles_in_blocks(mover, blocks, count, answers);
}

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(toggles_in_run_2);
HWY_EXPORT(toggles_in_run_3);
HWY_EXPORT(toggles_in_blocks_2);
HWY_EXPORT(toggles_in_blocks_3);

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
void find_toggles(const Mover<2>& mover, const Block<2>* const* blocks, std::size_t count,
                  BlockToggles* answers) {
  HWY_DYNAMIC_DISPATCH(toggles_in_blocks_2)(mover, blocks, count, answers);
}

template <>
void find_toggles(const Mover<3>& mover, const Block<3>* const* blocks, std::size_t count,
                  BlockToggles* answers) {
  HWY_DYNAMIC_DISPATCH(toggles_in_blocks_3)(mover, blocks, count, answers);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE
