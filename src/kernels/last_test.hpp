// The last test of pairs of boxes of doubles that kernels have found by floats.
#pragma once

#include <cstdint>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::kernels {

/// Set in the second id of a pair, until the last test, where the boxes do no more than touch as floats: in
/// double they may be apart. So ids with doubles are less than this.
inline constexpr std::uint32_t touching_bit = 0x80000000U;

/// Of the pairs [begin, end), drops those with a touching_bit whose boxes are apart in double, and takes the
/// bit off the others, which may have it in either order of their ids. The order stays. Returns the new end.
/// `boxes` are by id. At most PairSink::max_room pairs.
template <int D>
Pair* keep_overlapping(const Box<D, double>* boxes, Pair* begin, Pair* end);

/// What decides about the pairs that a kernel writes: the floats that it compares,
struct ByFloats {
  static constexpr bool marks_touching = false;
  Pair* operator()(Pair*, Pair* end) const { return end; }
};

/// or these boxes of doubles, by id.
template <int D>
struct InDouble {
  static constexpr bool marks_touching = true;
  const Box<D, double>* boxes;
  Pair* operator()(Pair* begin, Pair* end) const { return keep_overlapping(boxes, begin, end); }
};

}  // namespace broadside::kernels
