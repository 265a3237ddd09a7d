// The lines of C++ that advice prints: they compile, here, and do what they say.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/broadside.hpp"

#include "lab/advise/snippet.hpp"
#include "paper/listings/registry.hpp"
#include "tests/support/text_of.hpp"

// Each as a user pastes it, into a room of its own.
namespace broadside::find_2d {
#include "tests/tools/lab/snippets/find_2d.inc"
}
namespace broadside::find_3d {
#include "tests/tools/lab/snippets/find_3d.inc"
}
namespace broadside::find_double_2d {
#include "tests/tools/lab/snippets/find_double_2d.inc"
}
namespace broadside::track_2d {
#include "tests/tools/lab/snippets/track_2d.inc"
}
namespace broadside::track_double_3d {
#include "tests/tools/lab/snippets/track_double_3d.inc"
}
namespace broadside::track_paper {
#include "tests/tools/lab/snippets/track_paper.inc"
}

namespace broadside::find_mine {
#include "tests/tools/lab/snippets/find_mine.inc"
Algorithm mine() { return *find_algorithm("sweep_and_prune"); }
}  // namespace broadside::find_mine
namespace broadside::track_mine {
#include "tests/tools/lab/snippets/track_mine.inc"
Algorithm mine() { return *find_algorithm("sweep_and_prune"); }
}  // namespace broadside::track_mine

namespace broadside::lab {
namespace {

std::string pasted(const std::string& name) {
  return project_text("tests/tools/lab/snippets/" + name + ".inc");
}

TEST(Snippet, IsWhatIsCompiledHere) {
  constexpr Precision single = Precision::float32;
  constexpr Precision twice = Precision::float64;
  EXPECT_EQ(snippet("grid:cell=2.5", Mode::find, 2, single), pasted("find_2d"));
  EXPECT_EQ(snippet("auto", Mode::find, 3, single), pasted("find_3d"));
  EXPECT_EQ(snippet("bvh", Mode::find, 2, twice), pasted("find_double_2d"));
  EXPECT_EQ(snippet("sweep_and_prune:update=follow", Mode::track, 2, single), pasted("track_2d"));
  EXPECT_EQ(snippet("auto", Mode::track, 3, twice), pasted("track_double_3d"));
  EXPECT_EQ(snippet("paper_grid", Mode::track, 2, single), pasted("track_paper"));
  EXPECT_EQ(snippet("mine:axis=x", Mode::find, 2, single), pasted("find_mine"));
  EXPECT_EQ(snippet("mine", Mode::track, 3, twice), pasted("track_mine"));
}

TEST(Snippet, FindsThePairsOfAnArray) {
  const std::vector<Pair> expected = {{BoxId(0), BoxId(1)}};
  EXPECT_EQ(find_2d::find_overlaps({{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}, {{5, 5}, {6, 6}}}), expected);
  EXPECT_EQ(find_3d::find_overlaps({{{0, 0, 0}, {2, 2, 2}}, {{1, 1, 1}, {3, 3, 3}}, {{5, 5, 5}, {6, 6, 6}}}),
            expected);
  // Floats would not tell these apart.
  EXPECT_EQ(find_double_2d::find_overlaps({{{0, 0}, {1, 1}}, {{1, 1}, {3, 3}}, {{0, 3 + 1e-12}, {3, 4}}}),
            expected);
  EXPECT_EQ(find_mine::find_overlaps({{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}, {{5, 5}, {6, 6}}}), expected);
}

TEST(Snippet, FollowsBoxesInAWorld) {
  const Handle ball = track_2d::add({{0, 0}, {1, 1}});
  track_2d::add({{3, 0}, {4, 1}});
  EXPECT_EQ(track_2d::update().begun.size(), 0u);
  track_2d::move(ball, {{2.5F, 0}, {3.5F, 1}});
  EXPECT_EQ(track_2d::update().begun.size(), 1u);
  track_2d::remove(ball);
  EXPECT_EQ(track_2d::update().ended.size(), 1u);

  const Handle box = track_double_3d::add({{0, 0, 0}, {1, 1, 1}});
  track_double_3d::add({{1, 1, 1}, {2, 2, 2}});
  EXPECT_EQ(track_double_3d::update().begun.size(), 1u);
  track_double_3d::move(box, {{0, 0, 0}, {1, 1, 1 - 1e-12}});
  EXPECT_EQ(track_double_3d::update().ended.size(), 1u);
  track_double_3d::remove(box);
  EXPECT_EQ(track_double_3d::update().ended.size(), 0u);

  track_paper::add({{0, 0}, {1, 1}});
  track_paper::add({{1, 1}, {2, 2}});
  EXPECT_EQ(track_paper::update().begun.size(), 1u);

  track_mine::add({{0, 0, 0}, {1, 1, 1}});
  track_mine::add({{1, 1, 1}, {2, 2, 2}});
  EXPECT_EQ(track_mine::update().begun.size(), 1u);
}

}  // namespace
}  // namespace broadside::lab
