// The kernels of trackers: one box that moves against boxes that rest, and which overlaps begin or end by it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "kernels/run.hpp"

namespace broadside::kernels {

/// A box before and after a step. One that is absent must be NaN: see mover_of().
template <int D>
struct Mover {
  Box<D> before;
  Box<D> now;
  BoxId id;
  bool refiltered;  ///< whether pairs that overlap before and now are asked for as well
};

template <int D>
constexpr Mover<D> mover_of(const Box<D>& before, const Box<D>& now, BoxId id, bool refiltered) {
  Mover<D> mover{before, now, id, refiltered};
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  if (!is_present(before)) mover.before.min[0] = mover.before.max[0] = nan;
  if (!is_present(now)) mover.now.min[0] = mover.now.max[0] = nan;
  return mover;
}

/// A box whose overlap with a mover the step changes, and whether it overlaps it now.
struct Toggle {
  BoxId id;
  bool overlaps;
};

/// Writes the boxes of the run at the places [begin, end) whose overlap with the mover the step changes, but
/// for the mover itself, to `toggles`, which must have room for end - begin. Returns how many. A box whose
/// min[0] is NaN overlaps nothing.
template <int D>
std::size_t find_toggles(const Mover<D>& mover, const Run<D>& run, std::size_t begin, std::size_t end,
                         Toggle* toggles);

/// A few boxes as a structure of arrays, aligned to its lines. The last place has no box: its min[0] must be
/// NaN, and its other numbers are the caller's.
template <int D>
struct alignas(64) Block {
  static constexpr std::uint32_t places = 16;
  static constexpr std::uint32_t capacity = places - 1;

  float min[D][places];
  float max[D][places];
  std::uint32_t id[places];
};

/// What a step changes among the boxes of a block, a bit for each place.
struct BlockToggles {
  std::uint16_t toggled;   ///< the overlap with the mover changes
  std::uint16_t overlaps;  ///< they overlap it now
  std::uint16_t own;       ///< they have the mover's id
};

/// Sets answers[i] to what the step changes in *blocks[i], for each of `count` blocks.
template <int D>
void find_toggles(const Mover<D>& mover, const Block<D>* const* blocks, std::size_t count,
                  BlockToggles* answers);

}  // namespace broadside::kernels
