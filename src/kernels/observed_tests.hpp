// Records the pairs of boxes that searches compare, one by one, in a build with BROADSIDE_OBSERVE, which the
// playground and a test make. Other builds call nothing here, so nothing of it is compiled.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadside/pair.hpp"

namespace broadside::kernels {

/// Whether this build records its tests.
#ifdef BROADSIDE_OBSERVE
inline constexpr bool is_observing = true;
#else
inline constexpr bool is_observing = false;
#endif

/// Every pair that a search has counted as a test since the list was cleared, in order and as often as it was
/// compared: as many as Statistics::tests. Ids are places in the array that find() was given; in a search
/// between two sets, places in the left array followed by the right one. There is one list, so an observed
/// search must have one worker. Trackers that follow boxes record nothing.
inline std::vector<Pair>& observed_tests() {
  static std::vector<Pair> tests;
  return tests;
}

/// Records one test of two boxes, in either order.
inline void observe_test(BoxId a, BoxId b) { observed_tests().push_back({std::min(a, b), std::max(a, b)}); }

/// Records the tests of `box` with the boxes of `others` at the set bits.
inline void observe_tests(BoxId box, const BoxId* others, std::uint32_t bits) {
  for (; bits != 0; bits &= bits - 1) observe_test(box, others[std::countr_zero(bits)]);
}

/// Records the test of each box with the other one at the same place, for the set bits.
inline void observe_tests(const BoxId* boxes, const BoxId* others, std::uint32_t bits) {
  for (; bits != 0; bits &= bits - 1)
    observe_test(boxes[std::countr_zero(bits)], others[std::countr_zero(bits)]);
}

/// Replaces the ids of the tests from `begin` on: place i becomes ids[i].
template <typename Ids>
void rename_observed_tests(std::size_t begin, const Ids& ids) {
  for (std::size_t i = begin; i < observed_tests().size(); ++i) {
    Pair& test = observed_tests()[i];
    const BoxId a = ids[index(test.first)];
    const BoxId b = ids[index(test.second)];
    test = {std::min(a, b), std::max(a, b)};
  }
}

}  // namespace broadside::kernels
