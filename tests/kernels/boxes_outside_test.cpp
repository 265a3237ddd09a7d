// Which boxes are outside their enlarged boxes, on every instruction set.
#include "kernels/boxes_outside.hpp"

#include <cstddef>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/model.hpp"

namespace broadside::kernels {
namespace {

template <int D, typename Real>
void check_outside_at_every_place() {
  Box<D, Real> inner;
  inner.min.fill(1);
  inner.max.fill(2);
  // Every number of boxes up to a few vectors' and a rest; each box outside by each of its coordinates.
  for (std::size_t count = 0; count < 11; ++count) {
    const std::vector<Box<D, Real>> enlarged(count, inner);
    std::vector<Box<D, Real>> boxes = enlarged;
    std::vector<BoxId> outside(count);
    const auto select = [&] {
      return select_outside(std::span<const Box<D, Real>>(boxes), std::span<const Box<D, Real>>(enlarged),
                            outside.data());
    };
    EXPECT_EQ(select(), 0U) << "a box on the edge is within";
    for (std::size_t i = 0; i < count; ++i) {
      for (int axis = 0; axis < D; ++axis) {
        boxes[i].min[axis] = Real{0.5};
        ASSERT_EQ(select(), 1U);
        EXPECT_EQ(outside[0], BoxId(i));
        boxes[i] = inner;
        boxes[i].max[axis] = Real{2.5};
        ASSERT_EQ(select(), 1U);
        EXPECT_EQ(outside[0], BoxId(i));
        boxes[i] = inner;
      }
      boxes[i] = absent_box<D, Real>();
      EXPECT_EQ(select(), 0U);
      boxes[i] = inner;
    }
    for (Box<D, Real>& box : boxes) box.max[0] = 3;
    EXPECT_EQ(select(), count);
  }
}

TEST(BoxesOutside, AreSeenAtEveryPlaceAndAxis) {
  on_each_instruction_set([]<int D>() {
    check_outside_at_every_place<D, float>();
    check_outside_at_every_place<D, double>();
  });
}

}  // namespace
}  // namespace broadside::kernels
