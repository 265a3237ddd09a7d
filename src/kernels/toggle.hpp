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

/// What a step changes.
struct StepEvents {
  std::uint32_t* begun;  ///< where the ids of boxes go that the mover overlaps now and did not before ...
  std::uint32_t* ended;  ///< ... or the other way round: room for the boxes of all blocks, and one block more
  std::size_t begun_count = 0;
  std::size_t ended_count = 0;
  std::uint64_t hits = 0;  ///< boxes that overlap the mover now, the mover itself not
};

/// Compares the mover with the boxes of `count` blocks, but for those of its own id: these become what it is
/// now. One that is refiltered has those that it overlapped both before and now among the begun ones.
template <int D>
void take_step(const Mover<D>& mover, Block<D>* const* blocks, std::size_t count, StepEvents& events);

}  // namespace broadside::kernels
