// Which pairs overlap, on every instruction set, against the definition.
#include "kernels/overlap_flags.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/model.hpp"

namespace broadside::kernels {
namespace {

template <int D, typename Real>
void check(const std::vector<Box<D, Real>>& boxes) {
  std::vector<Pair> pairs;
  for (std::uint32_t a = 0; a < boxes.size(); ++a) {
    for (std::uint32_t b = 0; b < boxes.size(); ++b) pairs.push_back({BoxId{a}, BoxId{b}});
  }
  std::vector<std::uint8_t> flags(pairs.size(), 2);
  set_overlap_flags(std::span<const Box<D, Real>>(boxes), std::span<const Pair>(pairs), flags.data());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Box<D, Real>& a = boxes[index(pairs[i].first)];
    const Box<D, Real>& b = boxes[index(pairs[i].second)];
    ASSERT_EQ(flags[i] == 1, is_present(a) && is_present(b) && overlap(a, b))
        << index(pairs[i].first) << " " << index(pairs[i].second);
    ASSERT_LE(flags[i], 1);
  }
  // Any number of pairs, since the last one of an odd number is tested by itself.
  for (std::size_t count = pairs.size() - 3; count <= pairs.size(); ++count) {
    std::vector<Pair> expected;
    for (std::size_t i = 0; i < count; ++i) {
      if (flags[i] == 0) expected.push_back(pairs[i]);
    }
    std::vector<Pair> apart(count);
    apart.resize(select_apart(std::span<const Box<D, Real>>(boxes),
                              std::span(std::as_const(pairs)).first(count), apart.data()));
    ASSERT_EQ(apart, expected);
    // Every third flag is wrong.
    std::vector<std::uint8_t> renewed(flags.begin(), flags.begin() + static_cast<std::ptrdiff_t>(count));
    std::vector<std::uint32_t> wrong;
    for (std::size_t i = 0; i < count; i += 3) {
      renewed[i] ^= 1;
      wrong.push_back(static_cast<std::uint32_t>(i));
    }
    std::vector<std::uint32_t> changed(count);
    changed.resize(renew_overlap_flags(std::span<const Box<D, Real>>(boxes),
                                       std::span(std::as_const(pairs)).first(count), renewed.data(),
                                       changed.data()));
    ASSERT_EQ(changed, wrong);
    ASSERT_TRUE(std::equal(renewed.begin(), renewed.end(), flags.begin()));
  }
}

TEST(OverlapFlags, AreThoseOfTheDefinition) {
  on_each_instruction_set([]<int D>() {
    Rng rng(7);
    std::vector<Box<D>> boxes = random_boxes<D>(rng, 60, {.places = 10, .max_extent = 4});
    boxes.push_back(absent_box<D>());
    boxes.push_back(core::nan_box<D>());
    Box<D> whole;
    whole.min.fill(-infinity);
    whole.max.fill(infinity);
    boxes.push_back(whole);
    check(boxes);
    std::vector<Box<D, double>> doubles;
    for (const Box<D>& box : boxes) {
      doubles.emplace_back();
      for (int axis = 0; axis < D; ++axis) {
        doubles.back().min[axis] = double{box.min[axis]};
        doubles.back().max[axis] = double{box.max[axis]};
      }
    }
    check(doubles);
  });
}

}  // namespace
}  // namespace broadside::kernels
