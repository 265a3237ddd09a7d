// World under bad input: refused, or taken in as absent until it is mended.
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

namespace broadside {
namespace {

template <typename Real>
class WorldQuarantine : public testing::Test {
 protected:
  using Boxes = std::vector<Box<2, Real>>;

  static constexpr Real infinity = std::numeric_limits<Real>::infinity();
  static constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();

  static Box<2, Real> at(Real x) { return {{x, 0}, {x + 1, 1}}; }
  static Box<2, Real> whole() { return {{-infinity, -infinity}, {infinity, infinity}}; }

  static Boxes wrong_boxes() {
    return {{{nan, 0}, {1, 1}},
            {{0, 0}, {1, nan}},
            {{0, 1}, {1, 0}},
            {{nan, nan}, {nan, nan}},
            {{0, -nan}, {1, 1}}};
  }

  static std::vector<World<2, Real>> worlds() {
    std::vector<World<2, Real>> all;
    for (const char* const algorithm : {"auto", "brute_force", "grid"}) {
      for (const double margin : {0.0, 0.25}) {
        WorldOptions options;
        options.algorithm = algorithm;
        options.margin = margin;
        options.bad_input = BadInput::quarantine;
        all.emplace_back(options);
      }
    }
    return all;
  }
};

using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(WorldQuarantine, Reals);

TYPED_TEST(WorldQuarantine, KeepsTheHandleOfAnInvalidBoxAndPairsItWithNothing) {
  for (World<2, TypeParam>& world : this->worlds()) {
    for (const Box<2, TypeParam>& wrong : this->wrong_boxes()) {
      const Handle a = world.add(this->whole());
      const Handle b = world.add(wrong);
      EXPECT_TRUE(world.contains(b));
      EXPECT_EQ(world.quarantined(), std::vector{b});
      EXPECT_TRUE(is_absent(world.box(b)));
      EXPECT_TRUE(world.update().begun.empty());
      world.move(b, this->at(3));
      EXPECT_TRUE(world.quarantined().empty());
      EXPECT_EQ(world.update().begun.size(), 1u);
      world.move(b, wrong);
      EXPECT_EQ(world.update().ended.size(), 1u);
      EXPECT_TRUE(world.pairs().empty());
      EXPECT_EQ(world.quarantined(), std::vector{b});
      world.shift_origin({5, 5});
      EXPECT_TRUE(world.update().begun.empty());
      EXPECT_EQ(world.quarantined(), std::vector{b});
      world.remove(b);
      world.remove(a);
      EXPECT_TRUE(world.quarantined().empty());
      EXPECT_TRUE(world.update().ended.empty());
      world.update();
    }
  }
}

TYPED_TEST(WorldQuarantine, TakesInvalidBoxesAmongMany) {
  for (World<2, TypeParam>& world : this->worlds()) {
    typename TestFixture::Boxes boxes = this->wrong_boxes();
    boxes.push_back(this->at(0));
    boxes.push_back(this->at(0.5));
    std::vector<Handle> handles(boxes.size());
    world.add(boxes, handles);
    EXPECT_EQ(world.update().begun.size(), 1u);
    EXPECT_EQ(world.quarantined().size(), boxes.size() - 2);
    std::swap(boxes.front(), boxes.back());
    world.move(handles, boxes);
    const Events events = world.update();
    EXPECT_EQ(events.begun.size(), 1u);
    EXPECT_EQ(events.ended.size(), 1u);
    EXPECT_EQ(world.quarantined().back(), handles.back());
  }
}

TYPED_TEST(WorldQuarantine, StillRefusesAbsentBoxesAndWithoutItInvalidOnes) {
  World<2, TypeParam> standard;
  for (const Box<2, TypeParam>& wrong : this->wrong_boxes()) EXPECT_THROW(standard.add(wrong), InvalidInput);
  const Handle handle = standard.add(this->at(0));
  EXPECT_THROW(standard.move(handle, this->wrong_boxes()[0]), InvalidInput);
  EXPECT_EQ(standard.box(handle), this->at(0));
  EXPECT_EQ(standard.size(), 1u);
  for (World<2, TypeParam>& world : this->worlds())
    EXPECT_THROW(world.add((absent_box<2, TypeParam>())), InvalidInput);
}

}  // namespace
}  // namespace broadside
