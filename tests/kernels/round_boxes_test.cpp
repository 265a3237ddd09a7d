// Rounding on every instruction set, against the rounding, the check and the hash of one box at a time.
#include "kernels/round_boxes.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/model.hpp"

namespace broadside::kernels {
namespace {

template <int D>
std::vector<Box<D, double>> exact_boxes(Rng& rng, std::size_t count) {
  std::vector<Box<D, double>> boxes(count);
  for (Box<D, double>& box : boxes) {
    const Box<D> drawn = random_box<D>(rng, {.places = 1000});
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = std::max(-1e4, double{drawn.min[axis]});
      box.max[axis] = std::min(1e4, double{drawn.max[axis]});
    }
  }
  return boxes;
}

template <int D>
RoundedBoxes expect_rounded(const std::vector<Box<D, double>>& boxes, std::size_t first_place = 0) {
  std::array<core::LinearRounding, D> fit;
  for (int axis = 0; axis < D; ++axis) fit[axis] = core::LinearRounding(axis, axis == 1 ? 1e12 : 1);
  std::vector<Box<D>> floats(boxes.size());
  const RoundedBoxes rounded = round_boxes<D>(boxes, first_place, fit, floats.data());
  std::vector<Box<D>> few(boxes.size());
  EXPECT_EQ(round_few_boxes<D>(boxes, fit, few.data()), rounded.all_present);
  if (!rounded.all_present) return rounded;
  std::vector<Box<D>> expected;
  for (const Box<D, double>& box : boxes) expected.push_back(core::rounded(box, fit));
  EXPECT_EQ(floats, expected);
  EXPECT_EQ(few, expected);
  EXPECT_EQ(rounded.is_lossless, core::is_lossless<D>(fit, boxes, expected));
  EXPECT_EQ(rounded.hash, core::hash_of<D>(boxes, first_place));
  return rounded;
}

/// Calls `body(boxes)` with numbers of boxes that end in every lane, and in more than one portion.
template <typename Body>
void on_sizes(Body body) {
  on_each_instruction_set([&]<int D>() {
    Rng rng(5);
    for (std::size_t size = 0; size < 1100 && !testing::Test::HasFailure(); size += size < 20 ? 1 : 101) {
      SCOPED_TRACE(size);
      std::vector<Box<D, double>> boxes = exact_boxes<D>(rng, size);
      body.template operator()<D>(boxes);
    }
  });
}

TEST(RoundBoxes, RoundsAndHashesAsBoxByBox) {
  on_sizes([]<int D>(std::vector<Box<D, double>>& boxes) {
    for (const std::size_t first_place : {0, 7}) {
      EXPECT_TRUE(expect_rounded<D>(boxes, first_place).all_present);
      for (Box<D, double>& box : boxes) {
        for (int axis = 0; axis < D; ++axis) {
          box.min[axis] /= 3;
          box.max[axis] = axis == 0 ? infinity : box.max[axis] + 1e-9;
        }
      }
    }
  });
}

TEST(RoundBoxes, SeesEachCoordinateThatIsLost) {
  on_sizes([]<int D>(std::vector<Box<D, double>>& boxes) {
    EXPECT_TRUE(expect_rounded<D>(boxes).is_lossless);
    for (std::size_t i = 0; i < boxes.size(); i += 1 + boxes.size() / 30) {
      for (int axis = 0; axis < D; ++axis) {
        for (double* const at : {&boxes[i].min[axis], &boxes[i].max[axis]}) {
          const double before = *at;
          *at += at == &boxes[i].min[axis] ? -1e-6 : 1e-6;
          EXPECT_FALSE(expect_rounded<D>(boxes).is_lossless) << i;
          *at = before;
        }
      }
    }
  });
}

TEST(RoundBoxes, SeesEachBoxThatIsNotPresent) {
  on_sizes([]<int D>(std::vector<Box<D, double>>& boxes) {
    for (std::size_t i = 0; i < boxes.size(); i += 1 + boxes.size() / 30) {
      const Box<D, double> before = boxes[i];
      boxes[i] = absent_box<D, double>();
      EXPECT_FALSE(expect_rounded<D>(boxes).all_present) << i;
      for (int axis = 0; axis < D; ++axis) {
        boxes[i] = before;
        boxes[i].min[axis] = std::numeric_limits<double>::quiet_NaN();
        EXPECT_FALSE(expect_rounded<D>(boxes).all_present) << i;
        boxes[i] = before;
        boxes[i].max[axis] = std::numeric_limits<double>::quiet_NaN();
        EXPECT_FALSE(expect_rounded<D>(boxes).all_present) << i;
        boxes[i].max[axis] = before.min[axis] - 1;
        EXPECT_FALSE(expect_rounded<D>(boxes).all_present) << i;
      }
      boxes[i] = before;
    }
  });
}

TEST(RoundBoxes, HashesZerosAlike) {
  on_each_instruction_set([]<int D>() {
    std::vector<Box<D, double>> boxes(40, Box<D, double>{});
    const std::uint64_t hash = expect_rounded<D>(boxes).hash;
    boxes[3].min.fill(-0.0);
    boxes[39].max.fill(-0.0);
    EXPECT_EQ(expect_rounded<D>(boxes).hash, hash);
    boxes[39].max[0] = 1;
    EXPECT_NE(expect_rounded<D>(boxes).hash, hash);
  });
}

}  // namespace
}  // namespace broadside::kernels
