// Packs of sixteen boxes that stay from frame to frame, and the boxes that moved, compared with them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "kernels/nowhere.hpp"

namespace broadside::kernels {

inline constexpr std::size_t pack_size = 16;

/// The end of a chain of packs.
inline constexpr std::uint32_t no_pack = 0xffffffffU;

/// Sixteen boxes, one a lane. A lane without a box is nowhere. A box that moves in this frame stands here as
/// the bounds of where it was and where it is.
template <int D>
struct alignas(64) Pack {
  float min[D][pack_size];
  float max[D][pack_size];
  std::uint32_t id[pack_size];
};

/// Which of a pack's lanes hold a box and which of these move in this frame, as bits; and the pack that
/// follows in its chain.
struct PackState {
  std::uint16_t used;
  std::uint16_t moved;
  std::uint32_t next;
};

/// A box that changed: where it was and where it is, nowhere if it was or is absent, and the bounds of both.
template <int D>
struct MovingBox {
  Box<D> before;
  Box<D> now;
  Box<D> both;
  std::uint32_t id;
  std::uint32_t refiltered;  ///< 1 if its filter changed as well, so that who rests may pair anew
};

/// A mover, by its place in a list, and the first of a chain of packs that it is to be compared with.
struct PackTask {
  std::uint32_t mover;
  std::uint32_t pack;
};

/// The packs, by number.
template <int D>
struct Packs {
  std::span<const Pack<D>> boxes;
  std::span<const PackState> states;
};

/// Writes every pair of a mover and a box in a pack of its tasks that may begin or end in this frame: those
/// of a box that rests which the mover touched or touches, but not both; and those of another mover with a
/// greater id whose bounds it touches. Returns the number of pairs of boxes compared, where a pack counts as
/// full.
template <int D>
std::uint64_t compare(const Packs<D>& packs, std::span<const MovingBox<D>> movers,
                      std::span<const PackTask> tasks, PairSink& pairs);

}  // namespace broadside::kernels
