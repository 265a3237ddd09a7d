// Which boxes stay within their enlarged ones, on every instruction set, against Margins.
#include "kernels/enlarged_boxes.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/model.hpp"

namespace broadside::kernels {
namespace {

using core::Margins;

template <int D, typename Real>
std::vector<Margins<D, Real>> all_margins() {
  return {{.margin = 1, .relative = 0, .frames = 0},
          {.margin = 0, .relative = Real{0.25}, .frames = 0},
          {.margin = 1, .relative = Real{0.25}, .frames = 0},
          {.margin = 0, .relative = Real{0.25}, .frames = 0, .has_margin = true}};
}

template <int D, typename Real>
std::vector<Box<D, Real>> converted(const std::vector<Box<D>>& boxes) {
  std::vector<Box<D, Real>> result;
  for (const Box<D>& box : boxes) {
    result.emplace_back();
    for (int axis = 0; axis < D; ++axis) {
      result.back().min[axis] = Real{box.min[axis]};
      result.back().max[axis] = Real{box.max[axis]};
    }
  }
  return result;
}

/// Boxes of every kind, points and infinite ones among them.
template <int D, typename Real>
std::vector<Box<D, Real>> boxes_of_all_kinds(Rng& rng) {
  std::vector<Box<D>> boxes = random_boxes<D>(rng, 200, {.places = 10, .max_extent = 4});
  Box<D> infinite;
  infinite.min.fill(-infinity);
  infinite.max.fill(infinity);
  boxes[20] = infinite;
  boxes[21].max[0] = infinity;
  boxes[22].min.fill(infinity);
  boxes[22].max.fill(infinity);
  boxes[23].min.fill(-0.0F);
  boxes[23].max.fill(-0.0F);
  return converted<D, Real>(boxes);
}

template <int D, typename Real>
bool is_same(const Box<D, Real>& a, const Box<D, Real>& b) {
  bool same = a == b;
  for (int axis = 0; axis < D; ++axis) {
    same &= std::signbit(a.min[axis]) == std::signbit(b.min[axis]);
    same &= std::signbit(a.max[axis]) == std::signbit(b.max[axis]);
  }
  return same;
}

template <int D, typename Real>
void check_enlarging(Rng& rng) {
  for (const Margins<D, Real>& margins : all_margins<D, Real>()) {
    const std::vector<Box<D, Real>> before = boxes_of_all_kinds<D, Real>(rng);
    std::vector<Box<D, Real>> now = before;
    std::vector<Box<D, Real>> kept;
    for (Box<D, Real>& box : now) {
      kept.push_back(margins.enlarged(box, nullptr));
      const Real step = static_cast<Real>(rng.below(7)) / 4;
      for (int axis = 0; axis < D; ++axis) {
        box.min[axis] += step;
        box.max[axis] += rng.below(9) == 0 ? 3 * step : step;
      }
    }
    kept[30] = absent_box<D, Real>();
    std::vector<Box<D, Real>> expected = kept;
    std::vector<std::uint32_t> expected_left;
    for (std::uint32_t i = 0; i < now.size(); ++i) {
      if (margins.keeps(kept[i], now[i], nullptr)) continue;
      expected[i] = margins.enlarged(now[i], nullptr);
      expected_left.push_back(i);
    }
    std::vector<std::uint32_t> left(now.size());
    left.resize(enlarge_left<D, Real>(kept, now, margins, left.data()));
    EXPECT_EQ(left, expected_left);
    for (std::size_t i = 0; i < now.size(); ++i) EXPECT_TRUE(is_same(kept[i], expected[i])) << i;
    EXPECT_GT(left.size(), 20U);
    EXPECT_LT(left.size(), 190U);
  }
}

TEST(EnlargeLeft, DoesAsMarginsDoForEachBox) {
  on_each_instruction_set([]<int D>() {
    Rng rng(3);
    check_enlarging<D, float>(rng);
    check_enlarging<D, double>(rng);
  });
}

template <int D, typename Real>
void check_counting(Rng& rng) {
  for (const Margins<D, Real>& margins : all_margins<D, Real>()) {
    std::vector<Box<D, Real>> boxes =
        converted<D, Real>(random_boxes<D>(rng, 100, {.places = 10, .max_extent = 4}));
    std::vector<Box<D, Real>> kept;
    for (const Box<D, Real>& box : boxes) kept.push_back(margins.enlarged(box, nullptr));
    const auto count = [&] { return count_kept<D, Real>(kept, boxes, 96, margins); };
    const std::size_t all = count();
    EXPECT_LE(all, 96U);
    for (std::size_t wrong = 0; wrong < 96; ++wrong) {
      const Box<D, Real> was = boxes[wrong];
      const Box<D, Real> kept_was = kept[wrong];
      for (int axis = 0; axis < D; ++axis) {
        if (!std::isfinite(was.min[axis]) || !std::isfinite(was.max[axis])) continue;
        boxes[wrong].max[axis] += 5;  // leaves
        EXPECT_LE(count(), wrong);
        boxes[wrong].max[axis] = was.min[axis] - 1;  // is inverted
        EXPECT_LE(count(), wrong);
        boxes[wrong].max[axis] = static_cast<Real>(std::nan(""));
        EXPECT_LE(count(), wrong);
        boxes[wrong] = was;
        kept[wrong].min[axis] -= 30;  // is too long
        EXPECT_LE(count(), wrong);
        kept[wrong] = kept_was;
      }
    }
    EXPECT_EQ(count(), all);
  }
}

TEST(CountKept, EndsAtTheFirstBoxThatMayNotStay) {
  on_each_instruction_set([]<int D>() {
    Rng rng(4);
    check_counting<D, float>(rng);
    check_counting<D, double>(rng);
  });
}

}  // namespace
}  // namespace broadside::kernels
