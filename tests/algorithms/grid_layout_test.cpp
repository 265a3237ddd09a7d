// The cells that the grid chooses for a search.
#include "algorithms/grid/grid_layout.hpp"

#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/model.hpp"

namespace broadside::algorithm {
namespace {

TEST(GridLayout, HasACoordinateInTheCellBetweenTwoBorders) {
  in_each_dimension([]<int D>() {
    Rng rng(5);
    std::vector<Box<D>> boxes(20'000);
    for (Box<D>& box : boxes) {
      for (int axis = 0; axis < D; ++axis) {
        box.min[axis] = rng.between(-500, 500);
        box.max[axis] = box.min[axis] + rng.unit();
      }
    }
    core::Sample<D> sample;
    sample.take(boxes);
    for (const std::optional<double> cell : {std::optional<double>(), std::optional<double>(13)}) {
      GridLayout<D> layout;
      layout.choose(sample, boxes.size(), cell);
      ASSERT_GT(layout.rows(), 2U);
      EXPECT_EQ(layout.cells(), layout.rows() * layout.row_length());
      if (cell) {
        EXPECT_NEAR(1 / layout.cell_axes()[0].per_unit, 13, 0.5);
      }
      for (const Box<D>& box : boxes) {
        const std::size_t row = layout.row_of(box);
        const float coordinate = box.min[layout.axes()[D - 1]];
        ASSERT_LT(row, layout.rows());
        ASSERT_FALSE(coordinate >= layout.row_border(row));
        ASSERT_TRUE(row == 0 || coordinate >= layout.row_border(row - 1));
        ASSERT_LE(layout.slab_begin(layout.slab_of(row)), row);
        ASSERT_LT(row, layout.slab_begin(layout.slab_of(row) + 1));
      }
    }
  });
}

}  // namespace
}  // namespace broadside::algorithm
