// The last test, in double, of pairs of boxes that kernels have found by floats.
#include "kernels/last_test.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include <hwy/cache_control.h>

namespace broadside::kernels {

template <int D>
Pair* keep_overlapping(const Box<D, double>* boxes, Pair* begin, Pair* end) {
  // Most pairs do not have the bit and are only read.
  std::array<Pair*, PairSink::max_room> touching;
  std::size_t count = 0;
  for (Pair* pair = begin; pair != end; ++pair) {
    touching[count] = pair;
    count += index(pair->second) / touching_bit;
  }
  for (std::size_t i = 0; i < count; ++i) {
    Pair& pair = *touching[i];
    const std::uint32_t a = index(pair.first);
    const std::uint32_t b = index(pair.second) & ~touching_bit;
    pair = {BoxId{std::min(a, b)}, BoxId{std::max(a, b)}};
    hwy::Prefetch(&boxes[a]);
    hwy::Prefetch(&boxes[b]);
  }
  Pair* out = count == 0 ? end : touching[0];
  for (std::size_t i = 0; i < count; ++i) {
    const Pair pair = *touching[i];
    *out = pair;
    out += overlap(boxes[index(pair.first)], boxes[index(pair.second)]) ? 1 : 0;
    Pair* const begin_certain = touching[i] + 1;
    Pair* const end_certain = i + 1 < count ? touching[i + 1] : end;
    out = out == begin_certain ? end_certain : std::copy(begin_certain, end_certain, out);
  }
  return out;
}

template Pair* keep_overlapping(const DoubleBox2*, Pair*, Pair*);
template Pair* keep_overlapping(const DoubleBox3*, Pair*, Pair*);

}  // namespace broadside::kernels
