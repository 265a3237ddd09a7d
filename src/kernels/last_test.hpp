// The last test, in double, of pairs of boxes that kernels have found by floats.
#pragma once

#include <cstdint>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::kernels {

/// Set in the second id of a pair, until the last test, if the boxes only touch as floats: in double they may
/// be apart. So the ids of boxes of doubles must be less than this.
inline constexpr std::uint32_t touching_bit = 0x80000000U;

/// Drops each pair of [begin, end) that has a touching_bit if its boxes are apart in double. The others lose
/// the bit and have their lesser id first again: the bit had made the marked id the greater one. Keeps the
/// order of pairs. Returns the new end. `boxes` are by id. At most PairSink::max_room pairs.
template <int D>
Pair* keep_overlapping(const Box<D, double>* boxes, Pair* begin, Pair* end);

/// The last test if floats decide.
struct ByFloats {
  static constexpr bool marks_touching = false;
  Pair* operator()(Pair*, Pair* end) const { return end; }
};

/// The last test if boxes of doubles decide. `boxes` are by id.
template <int D>
struct InDouble {
  static constexpr bool marks_touching = true;
  const Box<D, double>* boxes;
  Pair* operator()(Pair* begin, Pair* end) const { return keep_overlapping(boxes, begin, end); }
};

/// Calls `body` with the last test by `doubles`, or by floats if they are null.
template <int D, typename Body>
auto with_last_test(const Box<D, double>* doubles, const Body& body) {
  return doubles == nullptr ? body(ByFloats{}) : body(InDouble<D>{doubles});
}

}  // namespace broadside::kernels
