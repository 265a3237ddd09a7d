// The last test of pairs of boxes of doubles that kernels have found by floats.
#pragma once

#include <cstdint>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::kernels {

/// Set in the second id of a pair, until the last test, where the boxes do no more than touch as floats: in
/// double they may be apart. So ids with doubles are less than this.
inline constexpr std::uint32_t touching_bit = 0x80000000U;

/// Of the pairs [begin, end), drops those with a touching_bit whose boxes are apart in double. The others
/// lose the bit, and have their lesser id first again: the bit had made the marked one the greater. The order
/// of pairs stays. Returns the new end. `boxes` are by id. At most PairSink::max_room pairs.
template <int D>
Pair* keep_overlapping(const Box<D, double>* boxes, Pair* begin, Pair* end);

/// The last test where floats decide.
struct ByFloats {
  static constexpr bool marks_touching = false;
  Pair* operator()(Pair*, Pair* end) const { return end; }
};

/// The last test where boxes of doubles decide, these, by id.
template <int D>
struct InDouble {
  static constexpr bool marks_touching = true;
  const Box<D, double>* boxes;
  Pair* operator()(Pair* begin, Pair* end) const { return keep_overlapping(boxes, begin, end); }
};

/// Calls `body` with the last test by these boxes, or by floats if they are null.
template <int D, typename Body>
auto with_last_test(const Box<D, double>* doubles, const Body& body) {
  return doubles == nullptr ? body(ByFloats{}) : body(InDouble<D>{doubles});
}

}  // namespace broadside::kernels
