// Whether all boxes are present, on every instruction set, against the definition.
#include "kernels/all_present.hpp"

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/model.hpp"

namespace broadside::kernels {
namespace {

template <int D, typename Real>
void check_every_place() {
  Box<D, Real> point{};
  point.max[0] = std::numeric_limits<Real>::infinity();
  // Every number of boxes up to two vectors' and a rest, with a fault at every place and axis.
  for (std::size_t count = 0; count < 19; ++count) {
    std::vector<Box<D, Real>> boxes(count, point);
    EXPECT_TRUE(all_present(std::span<const Box<D, Real>>(boxes)));
    for (Box<D, Real>& box : boxes) {
      for (int axis = 0; axis < D; ++axis) {
        for (const Real wrong : {Real{-1}, std::numeric_limits<Real>::quiet_NaN()}) {
          box.max[axis] = wrong;
          EXPECT_FALSE(all_present(std::span<const Box<D, Real>>(boxes))) << count << " boxes, axis " << axis;
          box = point;
        }
      }
      box = absent_box<D, Real>();
      EXPECT_FALSE(all_present(std::span<const Box<D, Real>>(boxes)));
      box = point;
    }
  }
}

TEST(AllPresent, SeesAFaultAtEveryPlaceAndAxis) {
  on_each_instruction_set([]<int D>() {
    check_every_place<D, float>();
    check_every_place<D, double>();
  });
}

}  // namespace
}  // namespace broadside::kernels
