// The table of a world's options, from which all bindings take names, defaults and ranges.
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/world.hpp"

#include "tests/support/message.hpp"

namespace broadside {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(WorldOptionTable, DescribesEachOption) {
  std::set<std::string> names;
  for (const Tunable& option : world_tunables()) {
    EXPECT_TRUE(names.insert(option.name).second) << option.name;
    EXPECT_THAT(option.summary, Not(IsEmpty())) << option.name;
    EXPECT_NO_THROW(static_cast<void>(world_options(Spec{"world", {{option.name, option.default_value}}})))
        << option.name;
  }
}

TEST(WorldOptionTable, HasTheDefaultsOfTheStruct) {
  const WorldOptions named = world_options("world");
  const WorldOptions plain;
  EXPECT_EQ(named.margin, plain.margin);
  EXPECT_EQ(named.relative_margin, plain.relative_margin);
  EXPECT_EQ(named.predicted_frames, plain.predicted_frames);
  EXPECT_EQ(named.events, plain.events);
  EXPECT_EQ(named.keep_pairs, plain.keep_pairs);
  EXPECT_EQ(named.bad_input, plain.bad_input);
  EXPECT_EQ(named.shadow, plain.shadow);
  EXPECT_EQ(named.max_boxes, plain.max_boxes);
  EXPECT_EQ(named.first_generation, plain.first_generation);
}

TEST(WorldOptionTable, SetsEachOption) {
  const WorldOptions options = world_options(
      "world:margin=0.5:relative_margin=0.25:predicted_frames=2:events=enlarged:keep_pairs=no:quarantine=yes:"
      "shadow=yes:max_boxes=7:first_generation=4294967295");
  EXPECT_EQ(options.margin, 0.5);
  EXPECT_EQ(options.relative_margin, 0.25);
  EXPECT_EQ(options.predicted_frames, 2);
  EXPECT_EQ(options.events, WorldEvents::enlarged);
  EXPECT_FALSE(options.keep_pairs);
  EXPECT_EQ(options.bad_input, BadInput::quarantine);
  EXPECT_TRUE(options.shadow);
  EXPECT_EQ(options.max_boxes, 7U);
  EXPECT_EQ(options.first_generation, 4294967295U);
}

TEST(WorldOptionTable, RefusesUnknownNamesAndValuesOutOfRange) {
  for (const auto& [text, part] :
       {std::pair("world:margins=1", "expected one of: margin"), std::pair("world:margin=-1", "at least 0"),
        std::pair("grid:margin=1", "expected 'world'"), std::pair("world:margin=nan", "at least 0"),
        std::pair("world:events=some", "exact, enlarged"),
        std::pair("world:first_generation=4294967296", "4294967295"),
        std::pair("world:first_generation=1.5", "a whole number")}) {
    EXPECT_THAT(message_of<InvalidSpec>([&, &spec = text] { static_cast<void>(world_options(spec)); }),
                HasSubstr(part));
  }
}

}  // namespace
}  // namespace broadside
