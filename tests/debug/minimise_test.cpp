// Failing inputs made small.
#include "broadside/debug/minimise.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace broadside {
namespace {

Box2 point(float x) { return {{x, 0}, {x, 0}}; }

std::vector<Box2> points(std::size_t count) {
  std::vector<Box2> boxes;
  for (std::size_t i = 0; i < count; ++i) boxes.push_back(point(static_cast<float>(i)));
  return boxes;
}

bool holds(std::span<const Box2> boxes, float x) { return std::ranges::find(boxes, point(x)) != boxes.end(); }

TEST(Minimise, KeepsOnlyTheBoxesThatTheFailureNeeds) {
  std::vector<Box2> boxes = points(1000);
  std::size_t calls = 0;
  minimise(boxes, [&](std::span<const Box2> some) {
    ++calls;
    return holds(some, 17) && holds(some, 600) && holds(some, 999);
  });
  EXPECT_EQ(boxes, (std::vector{point(17), point(600), point(999)}));
  EXPECT_LT(calls, 200u);
}

TEST(Minimise, StopsWhereItIsToldTo) {
  std::vector<Box2> boxes = points(1000);
  std::size_t calls = 0;
  minimise(
      boxes, [&](std::span<const Box2> some) { return ++calls, holds(some, 17); },
      [&] { return calls == 5; });
  EXPECT_EQ(calls, 5u);
  EXPECT_LT(boxes.size(), 1000u);
  EXPECT_TRUE(holds(boxes, 17));
}

TEST(Minimise, KeepsTheFramesPlacesAndChangesOfAHistoryThatTheFailureNeeds) {
  History<2> history{points(20), {}};
  for (std::size_t frame = 1; frame <= 30; ++frame) {
    Step<2> step{20 + frame, {}, {}};
    for (const std::size_t place : {frame % 20, 19 + frame}) {
      step.changed.push_back(BoxId(place));
      step.boxes.push_back(point(static_cast<float>(100 * frame + place)));
    }
    history.steps.push_back(std::move(step));
  }
  // Fails where box 3 is still where it was when one has come to 1231.
  minimise(history, [](const History<2>& some) {
    std::vector<Box2> boxes = some.boxes;
    for (const Step<2>& step : some.steps) {
      apply(step, boxes);
      if (holds(boxes, 3) && holds(boxes, 1231)) return true;
    }
    return false;
  });
  EXPECT_FALSE(holds(history.boxes, 4));
  ASSERT_LE(history.boxes.size(), 1u);
  std::size_t changes = 0;
  for (const Step<2>& step : history.steps) changes += step.changed.size();
  EXPECT_EQ(changes + history.boxes.size(), 2u);
}

}  // namespace
}  // namespace broadside
