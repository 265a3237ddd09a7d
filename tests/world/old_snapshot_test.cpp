// Snapshots that earlier versions wrote.
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

#include "tests/support/text_of.hpp"

namespace broadside {
namespace {

std::vector<std::byte> fixture(const std::string& name) {
  const std::string text = project_text("tests/fixtures/" + name);
  const auto* const bytes = reinterpret_cast<const std::byte*>(text.data());
  return {bytes, bytes + text.size()};
}

TEST(OldSnapshot, OfVersion1IsReadWithItsFilters) {
  World2 world;
  world.restore(fixture("world_hierarchical_grid_v1.bws"));
  EXPECT_EQ(world.size(), 39U);
  EXPECT_EQ(world.pairs().size(), 23U);
  const Filter filter = world.filter(world.handle_of(BoxId{13}));
  EXPECT_EQ(filter.category, 1U << 3);
  EXPECT_EQ(filter.mask, ~std::uint64_t{0});
  EXPECT_EQ(world.filter(world.handle_of(BoxId{14})).mask, 3U);
  EXPECT_EQ(world.user_data(world.handle_of(BoxId{13})), 13U);
  world.update();
  EXPECT_EQ(world.pairs().size(), 23U);
}

TEST(OldSnapshot, OfVersion1IsReadWithItsMargin) {
  DoubleWorld3 world;
  world.restore(fixture("world_margin_v1.bws"));
  EXPECT_EQ(world.pairs().size(), 23U);
  world.update();
  EXPECT_EQ(world.pairs().size(), 23U);
}

TEST(OldSnapshot, OfVersion2IsReadWithItsMargin) {
  World2 world;
  world.restore(fixture("world_margin_v2.bws"));
  EXPECT_EQ(world.size(), 39U);
  EXPECT_EQ(world.pairs().size(), 23U);
  EXPECT_EQ(world.filter(world.handle_of(BoxId{30})).category, std::uint64_t{1} << 40);
  EXPECT_EQ(world.update().begun.size(), 3U) << "a box was moved after the last update";
  EXPECT_EQ(world.pairs().size(), 25U);
}

}  // namespace
}  // namespace broadside
