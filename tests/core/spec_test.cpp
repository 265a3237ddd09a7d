// Specs and settings: what is read, and what is refused with which words.
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/error.hpp"

#include "core/former_names.hpp"
#include "tests/support/message.hpp"

namespace broadside {
namespace {

using Values = decltype(Spec::values);

const std::vector<Tunable> tunables = {
    {.name = "cell", .summary = "edge of a cell", .default_value = "auto", .min = 0.5, .max = 2147483648.0},
    {.name = "capacity",
     .summary = "boxes a leaf",
     .default_value = "16",
     .type = Tunable::Type::integer,
     .min = 1},
    {.name = "axis",
     .summary = "swept axis",
     .default_value = "auto",
     .type = Tunable::Type::choice,
     .choices = {"x", "y"}},
    {.name = "margin", .summary = "slack", .default_value = "0"},
};

std::string refusal_of(std::string_view text) {
  return message_of<InvalidSpec>([&] { Settings(Spec(text), tunables); });
}

TEST(Spec, ReadsANameAlone) {
  const Spec spec("grid");
  EXPECT_EQ(spec.name, "grid");
  EXPECT_TRUE(spec.values.empty());
}

TEST(Spec, ReadsValuesInTheirOrder) {
  const Spec spec("grid:cell=2.5:axis=x");
  EXPECT_EQ(spec.name, "grid");
  EXPECT_EQ(spec.values, (Values{{"cell", "2.5"}, {"axis", "x"}}));
}

TEST(Spec, LeavesEqualsSignsInAValue) {
  EXPECT_EQ(Spec("file:where=a=b").values, (Values{{"where", "a=b"}}));
}

TEST(Spec, GivesBackTheTextItWasReadFrom) {
  for (const char* const text : {"grid", "grid:cell=2.5", "grid:cell=:axis=x", "a:b=c:d=e"})
    EXPECT_EQ(Spec(text).text(), text);
}

TEST(Spec, RefusesWhatIsNoSpec) {
  const auto refusal = [](std::string_view text) {
    return message_of<InvalidSpec>([&] { static_cast<void>(Spec{text}); });
  };
  EXPECT_THAT(refusal(""), names("''", "no name"));
  EXPECT_THAT(refusal(":cell=1"), names("':cell=1'", "no name"));
  EXPECT_THAT(refusal("grid:cell"), names("'grid:cell'", "'cell'", "'='"));
  EXPECT_THAT(refusal("grid:"), names("'grid:': it ends in ':'"));
  EXPECT_THAT(refusal("grid::cell=1"), names("'grid::cell=1': nothing between two ':'"));
  EXPECT_THAT(refusal("grid:=1"), names("'grid:=1'", "'=1'", "'='"));
  EXPECT_THAT(refusal("grid:cell=1:cell=1"), names("'grid:cell=1:cell=1'", "'cell'", "twice"));
}

TEST(Spec, HasOneCanonicalText) {
  using core::canonical_spec;
  for (const char* const spec :
       {"grid", "hierarchical_grid", "grid:cell=auto", "grid:update=auto", "grid:threads=1.0:cell=auto"})
    EXPECT_EQ(canonical_spec(spec), "grid") << spec;
  for (const char* const spec : {"grid:cell=2.5:update=follow", "hierarchical_grid:update=follow:cell=2.50",
                                 "grid:update=follow:cell=25e-1:threads=1"})
    EXPECT_EQ(canonical_spec(spec), canonical_spec("grid:update=follow:cell=2.5")) << spec;
  EXPECT_NE(canonical_spec("grid:cell=2.5"), canonical_spec("grid:cell=2.500001"));
  EXPECT_EQ(canonical_spec("bvh:update=reinsert"), canonical_spec("bvh:update=follow"));
}

TEST(Settings, HaveDefaultValuesWhereNoneIsGiven) {
  const Settings settings(Spec("grid"), tunables);
  EXPECT_TRUE(settings.is_auto("cell"));
  EXPECT_TRUE(settings.is_auto("axis"));
  EXPECT_EQ(settings.integer("capacity"), 16);
  EXPECT_EQ(settings.number("margin"), 0);
  EXPECT_EQ(settings.optional_number("cell"), std::nullopt);
  EXPECT_EQ(settings.optional_number("margin"), 0);
}

TEST(Settings, TakeTheValuesGiven) {
  const Settings settings(Spec("grid:cell=2.5:capacity=1e3:axis=y:margin=0.1"), tunables);
  EXPECT_FALSE(settings.is_auto("cell"));
  EXPECT_EQ(settings.number("cell"), 2.5);
  EXPECT_EQ(settings.integer("capacity"), 1000);
  EXPECT_EQ(settings.text("axis"), "y");
  EXPECT_EQ(settings.number("margin"), 0.1);
}

TEST(Settings, TakeBothEndsOfARange) {
  EXPECT_EQ(Settings(Spec("grid:cell=0.5"), tunables).number("cell"), 0.5);
  EXPECT_EQ(Settings(Spec("grid:cell=2147483648"), tunables).number("cell"), 2147483648.0);
  EXPECT_EQ(Settings(Spec("grid:capacity=9007199254740992"), tunables).integer("capacity"), 9007199254740992);
}

TEST(Settings, TakeAutoOnlyWhereItIsTheDefault) {
  EXPECT_TRUE(Settings(Spec("grid:cell=auto"), tunables).is_auto("cell"));
  EXPECT_THAT(refusal_of("grid:capacity=auto"),
              names("grid", "capacity", "'auto'", "from 1 to 9007199254740992"));
}

TEST(Settings, RefuseAnUnknownTunableAndNameTheKnownOnes) {
  EXPECT_THAT(refusal_of("grid:cells=2"), names("grid", "'cells'", "'cell'", "capacity"));
  EXPECT_THAT(message_of<InvalidSpec>([] { Settings(Spec("a:b=1"), {}); }), names("'b'", "none"));
}

TEST(Settings, RefuseANumberOutOfItsRangeAndNameTheRangeExactly) {
  for (const char* const value :
       {"0.499", "2147483649", "-1", "inf", "nan", "1e400", "0x10", "2.5m", " 2", "+2", ""})
    EXPECT_EQ(
        refusal_of(std::string("grid:cell=") + value),
        std::string("grid: cell is '") + value + "'; expected a number from 0.5 to 2147483648, or auto");
  EXPECT_THAT(refusal_of("grid:margin=-1"), names("margin is '-1'", "at least 0"));
}

TEST(Settings, NameTheLeastFloatToWhoGaveLess) {
  const Tunable above_0{.name = "cell",
                        .summary = "edge of a cell",
                        .default_value = "auto",
                        .min = std::numeric_limits<float>::min(),
                        .max = std::numeric_limits<float>::max()};
  const auto refusal = [&](const std::string& value) {
    return message_of<InvalidSpec>([&] { Settings(Spec("grid:cell=" + value), std::span(&above_0, 1)); });
  };
  EXPECT_THAT(refusal("0"), names("cell is '0'", "above 0", "auto"));
  for (const std::string value : {"1e-38", "1e39"})
    EXPECT_EQ(refusal(value),
              "grid: cell is '" + value +
                  "'; expected a number from 1.1754943508222875e-38 to 3.4028234663852886e+38, or auto");
  for (const std::string value : {"1.1754943508222875e-38", "3.4028234663852886e+38"})
    EXPECT_NO_THROW(Settings(Spec("grid:cell=" + value), std::span(&above_0, 1)));
}

TEST(Settings, RefuseAnIntegerThatIsNotWholeOrThatADoubleCannotHold) {
  for (const char* const value : {"1.5", "0", "1e300", "9007199254740993e3"})
    EXPECT_EQ(
        refusal_of(std::string("grid:capacity=") + value),
        std::string("grid: capacity is '") + value + "'; expected a whole number from 1 to 9007199254740992");
}

TEST(Settings, RefuseAChoiceThatIsNotOffered) {
  EXPECT_THAT(refusal_of("grid:axis=z"), names("axis is 'z'", "x, y", "auto"));
}

TEST(CurrentSpec, LosesWhatIsGoneFromOursAndNothingFromOthers) {
  EXPECT_EQ(core::current_spec("hierarchical_grid:span=2"), "grid");
  EXPECT_EQ(core::current_spec("bvh:update=reinsert:budget=3"), "bvh:update=follow");
  EXPECT_EQ(core::current_spec("brute_force:update=all"), "brute_force:update=rebuild");
  EXPECT_EQ(core::current_spec("paper_quadtree:update=root"), "paper_quadtree:update=root");
  EXPECT_EQ(core::current_spec("mine:margin=2:update=heap"), "mine:margin=2:update=heap");
}

TEST(Settings, RefuseToReadATunableThatDoesNotExist) {
  const Settings settings(Spec("grid"), tunables);
  const auto refusal = [&](std::string_view tunable) {
    return message_of<InvalidSpec>([&] { static_cast<void>(settings.text(tunable)); });
  };
  EXPECT_EQ(refusal("depth"), "there is no tunable 'depth'");
  EXPECT_EQ(refusal("cel"), "there is no tunable 'cel' (did you mean 'cell'?)");
}

}  // namespace
}  // namespace broadside
