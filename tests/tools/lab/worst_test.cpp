// The families of the worst-case hunt: the same seed gives the same boxes, and few of them overlap.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/broadside.hpp"

#include "algorithms/auto/auto_thresholds.hpp"
#include "core/sample.hpp"
#include "lab/verify/verify.hpp"
#include "lab/worst/hard_input.hpp"
#include "tests/support/message.hpp"

namespace broadside::lab {
namespace {

constexpr std::size_t few_boxes = 400;

template <int D, typename Real>
void expect_sound(const HardInput& input) {
  const auto history = make_input<D, Real>(input, few_boxes, 2);
  const auto again = make_input<D, Real>(input, few_boxes, 2);
  ASSERT_EQ(history.boxes.size(), few_boxes);
  EXPECT_TRUE(history.boxes == again.boxes);
  ASSERT_EQ(history.steps.size(), again.steps.size());
  for (std::size_t i = 0; i < history.steps.size(); ++i)
    EXPECT_TRUE(history.steps[i].boxes == again.steps[i].boxes);
  std::size_t pairs = 0;
  for (const Pair pair : reference_pairs<D, Real>(history.boxes)) {
    const std::size_t left = left_count(input, few_boxes);
    if (left == 0 || (index(pair.first) < left) != (index(pair.second) < left)) ++pairs;
  }
  EXPECT_LT(pairs, 10 * few_boxes);
  // Checks each box.
  EXPECT_NO_THROW(static_cast<void>(find_pairs(history.boxes)));
}

void expect_sound(const HardInput& input) {
  SCOPED_TRACE(input.text());
  if (input.dimension == 2)
    input.in_double ? expect_sound<2, double>(input) : expect_sound<2, float>(input);
  else
    input.in_double ? expect_sound<3, double>(input) : expect_sound<3, float>(input);
}

TEST(Worst, FixedInputsAreTheSameEachTimeAndHaveFewPairs) {
  for (const HardInput& input : fixed_inputs()) expect_sound(input);
}

TEST(Worst, ReadsAnInputBackFromItsText) {
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const HardInput input = draw_input(random, 1000);
    const HardInput again = parse_input(input.text());
    EXPECT_EQ(again.text(), input.text());
    EXPECT_TRUE((make_input<3, double>(again, 50, 1).boxes == make_input<3, double>(input, 50, 1).boxes))
        << input.text();
  }
}

TEST(Worst, FoolsTheSampleOfAuto) {
  constexpr std::size_t count = 10'000;
  const HardInput input = parse_input("fooled:hidden=plates:dimension=3");
  const std::vector<Box3> boxes = make_input<3, float>(input, count, 0).boxes;
  using Limits = algorithm::AutoThresholds<3>;
  const std::uint32_t shift = core::sample_shift<3, float>(boxes, Limits::hashed_boxes);
  for (std::size_t i = 0; i < Limits::sampled_boxes; ++i) {
    const Box3& box = boxes[core::sampled_place(i + shift, count)];
    EXPECT_NEAR(box.max[0] - box.min[0], box.max[1] - box.min[1], 1e-3) << "a plate is not a cube";
    EXPECT_NEAR(box.max[0] - box.min[0], box.max[2] - box.min[2], 1e-3);
  }
}

TEST(Worst, SaysWhatIsWrongWithAnInput) {
  EXPECT_TRUE(message_of<InvalidSpec>([] {
                parse_input("plate");
              }).starts_with("unknown family 'plate' (did you mean 'plates'?); expected one of: even, "));
  EXPECT_THROW(parse_input("plates:regions=0"), InvalidSpec);
  EXPECT_THROW(parse_input("plates:real=half"), InvalidSpec);
  EXPECT_THROW(parse_input("plates:depth=3"), InvalidSpec);
}

}  // namespace
}  // namespace broadside::lab
