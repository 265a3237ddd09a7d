// Frames seen in another precision or flat: each box converted, and nothing else.
#include "lab/formats/frames.hpp"

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/boxes.hpp"

namespace broadside::lab {
namespace {

template <int D, typename Real>
FrameReader<D, Real>& as(AnyFrameReader& frames) {
  return *std::get<std::unique_ptr<FrameReader<D, Real>>>(frames);
}

/// Two frames of doubles in 3D; the second one has a box more and one that is gone.
AnyFrameReader doubles() {
  const DoubleBox3 box{{0.1, 16777217, -1e300}, {0.2, 16777219, 1e300}};
  History<3, double> history{{box, box}, {}};
  history.steps.push_back({3, {BoxId{1}, BoxId{2}}, {absent_box<3, double>(), box}});
  return std::make_unique<HistoryReader<3, double>>(std::move(history));
}

TEST(Frames, AreRoundedToTheNearestFloat) {
  AnyFrameReader frames = with_precision(doubles(), Precision::float32);
  EXPECT_EQ(dimension_of(frames), 3);
  EXPECT_EQ(precision_of_frames(frames), Precision::float32);
  FrameReader<3, float>& floats = as<3, float>(frames);
  const Box3 rounded{{0.1F, 16777216, -infinity}, {0.2F, 16777220, infinity}};
  EXPECT_EQ(floats.first(), std::vector<Box3>(2, rounded));
  Step<3> step;
  ASSERT_TRUE(floats.next(step));
  EXPECT_EQ(step.size, 3u);
  EXPECT_EQ(step.changed, (std::vector<BoxId>{BoxId{1}, BoxId{2}}));
  EXPECT_EQ(step.boxes, (std::vector<Box3>{absent_box<3>(), rounded}));
  EXPECT_FALSE(floats.next(step));
}

TEST(Frames, AreSeenFlatAlongTheZAxis) {
  AnyFrameReader frames = flattened(doubles());
  EXPECT_EQ(dimension_of(frames), 2);
  EXPECT_EQ(precision_of_frames(frames), Precision::float64);
  FrameReader<2, double>& flat = as<2, double>(frames);
  const DoubleBox2 seen{{0.1, 16777217}, {0.2, 16777219}};
  EXPECT_EQ(flat.first(), std::vector<DoubleBox2>(2, seen));
  Step<2, double> step;
  ASSERT_TRUE(flat.next(step));
  EXPECT_EQ(step.boxes, (std::vector<DoubleBox2>{absent_box<2, double>(), seen}));
}

TEST(Frames, ThatAreAsAskedForStayTheSameReader) {
  AnyFrameReader frames = doubles();
  const FrameReader<3, double>* const before = &as<3, double>(frames);
  frames = with_precision(std::move(frames), Precision::float64);
  EXPECT_EQ((&as<3, double>(frames)), before);
  frames = flattened(flattened(std::move(frames)));
  EXPECT_EQ(dimension_of(frames), 2);
}

TEST(Frames, HandOnTheWarningOfTheFile) {
  struct Damaged final : FrameReader<2, double> {
    std::vector<DoubleBox2> first() override { return {}; }
    bool next(Step<2, double>&) override { return false; }
    std::string warning() const override { return "cut off"; }
  };
  AnyFrameReader frames = with_precision(std::make_unique<Damaged>(), Precision::float32);
  EXPECT_EQ((as<2, float>(frames).warning()), "cut off");
}

}  // namespace
}  // namespace broadside::lab
