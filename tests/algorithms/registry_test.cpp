// The library's list of algorithms, and how a spec becomes a Finder or a Tracker.
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/error.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"
#include "broadside/world.hpp"

#include "tests/support/message.hpp"
#include "tests/support/searchers.hpp"

namespace broadside {
namespace {

Algorithm planar() {
  return {
      .name = "planar",
      .summary = "does the plane only",
      .source = "this test",
      .tunables = {{.name = "cell", .summary = "edge", .default_value = "1"}},
      .in_2d = {.searcher = [](const Settings&) { return searcher_of<2>("brute_force"); }},
  };
}

TEST(Registry, DescribesEachAlgorithmFullyAndOnce) {
  std::set<std::string> names;
  for (const Algorithm& algorithm : algorithms()) {
    EXPECT_TRUE(names.insert(algorithm.name).second) << algorithm.name << " is listed twice";
    EXPECT_TRUE(std::ranges::all_of(algorithm.name, [](unsigned char c) {
      return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '_';
    })) << algorithm.name;
    EXPECT_FALSE(algorithm.summary.empty()) << algorithm.name;
    EXPECT_FALSE(algorithm.source.empty()) << algorithm.name;
    EXPECT_TRUE(algorithm.has_dimension(2) || algorithm.has_dimension(3)) << algorithm.name;
    EXPECT_FALSE(algorithm.has_dimension(4)) << algorithm.name;
    EXPECT_NE(algorithm.kind, AlgorithmKind::peer) << algorithm.name;
  }
}

TEST(Registry, NamesThePaperAlgorithmsAfterThePaper) {
  for (const Algorithm& algorithm : algorithms())
    EXPECT_EQ(algorithm.kind == AlgorithmKind::paper, algorithm.name.starts_with("paper_")) << algorithm.name;
}

TEST(Registry, HasTunablesWithAllowedDefaultValues) {
  for (const Algorithm& algorithm : algorithms()) {
    std::set<std::string> names;
    for (const Tunable& tunable : algorithm.tunables) {
      EXPECT_TRUE(names.insert(tunable.name).second) << algorithm.name << " has " << tunable.name << " twice";
      EXPECT_FALSE(tunable.summary.empty()) << algorithm.name << ": " << tunable.name;
      Tunable without_default = tunable;
      without_default.default_value = "auto";
      const Spec spec{algorithm.name, {{tunable.name, tunable.default_value}}};
      EXPECT_NO_THROW(Settings(spec, std::span(&without_default, 1))) << spec.text();
    }
  }
}

TEST(Registry, FindsAnAlgorithmByItsName) {
  const Algorithm* const found = find_algorithm("brute_force");
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->name, "brute_force");
  EXPECT_EQ(find_algorithm("brute"), nullptr);
  EXPECT_EQ(find_algorithm(""), nullptr);
}

TEST(Registry, HasTheDefaultAlgorithm) { EXPECT_NE(find_algorithm(default_algorithm), nullptr); }

void expect_planar_by_its_name_everywhere() {
  const std::span<const Algorithm> before = algorithms();
  const Algorithm* const first = &before.front();
  const std::string name = "planar";
  const Algorithm algorithm = planar();
  register_algorithm(algorithm);
  EXPECT_EQ(&before.front(), first);
  EXPECT_FALSE(before.front().name.empty()) << "what was given out before stays valid";
  EXPECT_EQ(algorithms().size(), before.size() + 1);
  EXPECT_EQ(algorithms().back().name, name);

  const std::vector<Box2> boxes = {{{0, 0}, {1, 1}}, {{1, 1}, {2, 2}}};
  EXPECT_EQ(find_pairs(boxes, {.algorithm = name + ":cell=3"}).size(), 1U);
  World2 world(name);
  for (const Box2& box : boxes) world.add(box);
  EXPECT_EQ(world.update().begun.size(), 1U);
  EXPECT_THAT(message_of<InvalidSpec>([&] { register_algorithm(algorithm); }),
              names("'" + name + "'", "taken"));
}

TEST(Registry, MakesARegisteredAlgorithmByItsNameEverywhere) {
  // In a process of its own: an algorithm stays registered, and other tests go through all of them.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto register_and_exit = [] {
    expect_planar_by_its_name_everywhere();
    std::exit(testing::Test::HasFailure() ? 1 : 0);
  };
  EXPECT_EXIT(register_and_exit(), testing::ExitedWithCode(0), "");
}

TEST(Registry, RefusesToRegisterWhatIsNoName) {
  for (const char* const name : {"", "Grid", "my-grid", "grid:cell"}) {
    Algorithm algorithm = planar();
    algorithm.name = name;
    EXPECT_THAT(message_of<InvalidSpec>([&] { register_algorithm(algorithm); }),
                names("'" + algorithm.name + "'"));
  }
}

TEST(Registry, RefusesAnUnknownNameAndNamesTheKnownOnes) {
  for (const std::string& message : {message_of<InvalidSpec>([] { Finder<2>("gird:cell=2"); }),
                                     message_of<InvalidSpec>([] { Tracker<3>("gird"); })}) {
    EXPECT_THAT(message, names("'gird'", "did you mean 'grid'"));
    for (const Algorithm& algorithm : algorithms()) EXPECT_THAT(message, names(algorithm.name));
  }
}

TEST(Registry, RefusesADimensionThatTheAlgorithmDoesNotDo) {
  const Algorithm algorithm = planar();
  EXPECT_NO_THROW(Finder<2>(algorithm, {"planar", {}}));
  const auto expected = names("planar", "3D", "expected 2D");
  EXPECT_THAT(message_of<InvalidSpec>([&] { Finder<3>(algorithm, {"planar", {}}); }), expected);
  EXPECT_THAT(message_of<InvalidSpec>([&] { Tracker<3>(algorithm, {"planar", {}}); }), expected);
}

TEST(Registry, RefusesAValueThatIsWrong) {
  const Algorithm algorithm = planar();
  EXPECT_THAT(message_of<InvalidSpec>([&] { Finder<2>(algorithm, Spec("planar:cell=-1")); }),
              names("cell is '-1'", "at least 0"));
  EXPECT_THAT(message_of<InvalidSpec>([&] { Tracker<2>(algorithm, Spec("planar:size=1")); }),
              names("'size'", "cell"));
}

TEST(Registry, TakesNamesOfEarlierVersions) {
  ASSERT_NE(find_algorithm("hierarchical_grid"), nullptr);
  EXPECT_EQ(find_algorithm("hierarchical_grid")->name, "grid");
  EXPECT_NO_THROW(Tracker<2>("bvh:update=reinsert"));
  EXPECT_THROW(Tracker<2>("grid:update=reinsert"), InvalidSpec);
}

TEST(MakeStrategy, GivesTheSettingsToAConstructorThatTakesThem) {
  struct OfSettings {
    explicit OfSettings(const Settings& settings) : cell(settings.number("cell")) {}
    double cell;
  };
  struct WithoutSettings {
    int made = 7;
  };
  const Settings settings("planar:cell=3", planar().tunables);
  EXPECT_EQ(make_strategy<OfSettings>(settings)->cell, 3);
  EXPECT_EQ(make_strategy<WithoutSettings>(settings)->made, 7);
}

TEST(AlgorithmKind, HasANameForEachKind) {
  EXPECT_EQ(name(AlgorithmKind::own), "own");
  EXPECT_EQ(name(AlgorithmKind::paper), "paper");
  EXPECT_EQ(name(AlgorithmKind::literature), "literature");
  EXPECT_EQ(name(AlgorithmKind::peer), "peer");
}

}  // namespace
}  // namespace broadside
