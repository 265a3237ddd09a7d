// Section VI: every way to mend a structure gives the right events, does the work that it says, and is
// searched as the listing searches.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "lab/scenes/motion.hpp"
#include "lab/verify/verify.hpp"
#include "paper/listings/coherent_follower.hpp"
#include "paper/listings/printed.hpp"

namespace broadside::paper {
namespace {

const std::vector<std::string> updates_2d = {
    "paper_grid:update=rebuild",
    "paper_grid:update=search_delete_reinsert",
    "paper_grid:update=search_once",
    "paper_grid:update=reinsert",
    "paper_grid:update=translate",
    "paper_grid:update=translate:cell=0.7",
    "paper_grid:update=reinsert:left=2:top=2:width=1:height=1:cell=0.1",
    "paper_sweep_and_prune:update=rebuild",
    "paper_sweep_and_prune:update=search_delete_reinsert",
    "paper_sweep_and_prune:update=heap",
    "paper_sweep_and_prune:update=insertion",
    "paper_sweep_and_prune:update=binary",
    "paper_quadtree:update=rebuild",
    "paper_quadtree:update=search_delete_reinsert",
    "paper_quadtree:update=search_delete_reinsert:capacity=1",
    "paper_quadtree:update=root",
    "paper_quadtree:update=relative",
    "paper_quadtree:update=siblings",
    "paper_quadtree:update=cousins",
    "paper_quadtree:update=siblings:capacity=1",
    "paper_quadtree:update=cousins:capacity=1",
};

template <int D>
void expect_lawful(const std::string& spec) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto history = lab::random_history<D>(
        {.boxes = 20 + 15 * seed, .frames = 40, .seed = seed, .infinite_boxes = seed % 2 == 0});
    Tracker<D> tracker(spec);
    const auto divergence = lab::check_tracker<D>(tracker, history, spec);
    ASSERT_FALSE(divergence) << divergence->text << ", seed " << seed;
  }
}

TEST(PaperTrackers, GiveTheEventsOfEveryHistory) {
  for (const std::string& spec : updates_2d) {
    for (const char* const detect : {":detect=flag", ":detect=compare"}) expect_lawful<2>(spec + detect);
  }
  for (const char* const update : {"search_delete_reinsert", "heap", "insertion", "binary"})
    expect_lawful<3>(std::string("paper_sweep_and_prune:detect=compare:update=") + update);
}

std::unique_ptr<CoherentFollower<2>> coherent_follower(const Spec& spec) {
  const Algorithm& algorithm = *find_algorithm(spec.name);
  std::unique_ptr<Follower<2>> follower =
      algorithm.in_2d.followers[0].make(Settings(spec, algorithm.tunables));
  return std::unique_ptr<CoherentFollower<2>>(&dynamic_cast<CoherentFollower<2>&>(*follower.release()));
}

/// Boxes, what follows them, and what moving some of them comes to.
class Followed {
 public:
  Followed(const std::string& spec, std::vector<Box2> boxes)
      : Followed(coherent_follower(Spec(spec)), std::move(boxes)) {}

  Phases move(std::size_t box, const Box2& to) {
    boxes_[box] = to;
    const BoxId changed{static_cast<std::uint32_t>(box)};
    return update({&changed, 1});
  }

  Phases shift(const std::vector<BoxId>& some, float by) {
    for (const BoxId id : some) {
      for (float* const x : {&boxes_[index(id)].min[0], &boxes_[index(id)].max[0]}) *x += by;
    }
    return update(some);
  }

  Phases add(const std::vector<Box2>& more) {
    std::vector<BoxId> added;
    for (const Box2& box : more) {
      added.push_back(BoxId(boxes_.size()));
      boxes_.push_back(box);
    }
    return update(added);
  }

  Phases rest() { return update({}); }
  std::size_t tests() const { return statistics_->tests; }
  std::size_t references() const { return statistics_->references; }

 private:
  Followed(std::unique_ptr<CoherentFollower<2>> follower, std::vector<Box2> boxes)
      : follower_(follower.get()), tracker_(std::move(follower)), boxes_(std::move(boxes)) {
    update({});
  }

  Phases update(std::span<const BoxId> changed) {
    PairCounter begun;
    PairCounter ended;
    statistics_ = tracker_.update({boxes_, changed}, begun, ended);
    return follower_->phases();
  }

  const CoherentFollower<2>* follower_;  // the tracker's
  Tracker<2> tracker_;
  std::optional<Statistics> statistics_;
  std::vector<Box2> boxes_;
};

/// Boxes of 1 x 1 whose corners stand at multiples of 2.
std::vector<Box2> rows(std::size_t columns, std::size_t count) {
  std::vector<Box2> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<float>(2 * (i % columns));
    const auto y = static_cast<float>(2 * (i / columns));
    boxes.push_back({{x, y}, {x + 1, y + 1}});
  }
  return boxes;
}

TEST(PaperTrackers, BuildAnewOnlyWhereUpdateSaysSo) {
  for (const std::string& spec : updates_2d) {
    Followed followed(spec, rows(20, 400));
    EXPECT_EQ(followed.rest().built, spec.find("update=rebuild") != std::string::npos) << spec;
  }
}

TEST(PaperTrackers, SearchLikeTheListingOnWhateverTheyHaveMended) {
  for (const std::string& spec : updates_2d) {
    std::vector<Box2> boxes = rows(20, 400);
    Followed followed(spec, boxes);
    boxes[7] = {{5.5F, 9.5F}, {6.5F, 10.5F}};
    followed.move(7, boxes[7]);
    Finder<2> finder(spec);
    PairCounter pairs;
    const auto found = finder.find(boxes, pairs);
    if (spec.find("quadtree") == std::string::npos) {
      EXPECT_EQ(followed.tests(), found->tests) << spec;
      EXPECT_EQ(followed.references(), found->references) << spec;
    } else {  // splits depend on the order in which boxes were added, and are not undone
      EXPECT_NEAR(static_cast<double>(followed.references()), static_cast<double>(found->references), 20)
          << spec;
    }
  }
}

TEST(PaperTrackers, AMoverIsSeenByItsFlagEvenAtRestAndByComparisonOnlyWhereItHasMoved) {
  const std::vector<Box2> boxes = rows(20, 400);
  for (const char* const algorithm : {"paper_grid", "paper_sweep_and_prune", "paper_quadtree"}) {
    EXPECT_EQ(Followed(std::string(algorithm) + ":detect=flag", boxes).move(3, boxes[3]).movers, 1U);
    EXPECT_EQ(Followed(std::string(algorithm) + ":detect=compare", boxes).move(3, boxes[3]).movers, 0U);
  }
}

TEST(PaperTrackers, WithAFlagAloneEachMoverIsSearchedForInTheWholeStructure) {
  for (const char* const algorithm : {"paper_grid:cell=1", "paper_sweep_and_prune", "paper_quadtree"}) {
    const auto visited = [&](const std::vector<BoxId>& some) {
      const std::string spec = std::string(algorithm) + ":update=search_delete_reinsert";
      return Followed(spec, rows(20, 400)).shift(some, 0.25F).visited;
    };
    const std::uint64_t one = visited({BoxId{399}});
    EXPECT_GT(one, 64U) << algorithm << ": as many as there are nodes, at least";
    EXPECT_NEAR(static_cast<double>(visited({BoxId{359}, BoxId{379}, BoxId{399}})),
                3 * static_cast<double>(one), 0.1 * static_cast<double>(one))
        << algorithm;
  }
}

TEST(PaperGridTracker, TouchesOnlyTheReferencesThatLeaveTheirCells) {
  std::vector<Box2> boxes = rows(20, 400);
  boxes[0] = {{0.5F, 0.5F}, {8.5F, 8.5F}};  // cells 0 to 8 on both axes, since a cell is 1 wide
  const Box2 next = {{1.5F, 0.5F}, {9.5F, 8.5F}};
  EXPECT_EQ(Followed("paper_grid:cell=1:update=translate", boxes).move(0, next).moved, 18U);
  EXPECT_EQ(Followed("paper_grid:cell=1:update=reinsert", boxes).move(0, next).moved, 162U);
  const Box2 in_the_same_cells = {{0.25F, 0.5F}, {8.75F, 8.5F}};
  for (const char* const update : {"translate", "reinsert"}) {
    const std::string spec = std::string("paper_grid:cell=1:update=") + update;
    EXPECT_EQ(Followed(spec, boxes).move(0, in_the_same_cells).moved, 0U) << update;
  }
}

/// A point in each of 16 x 16 leaves of one size; leaves are 1 wide.
std::vector<Box2> points_in_leaves() {
  std::vector<Box2> boxes;
  for (std::size_t i = 0; i < 256; ++i) {
    const auto x = static_cast<float>(i % 16) + 0.5F;
    const auto y = static_cast<float>(i / 16) + 0.5F;
    boxes.push_back({{x, y}, {x, y}});
  }
  return boxes;
}

/// Nodes and entries where the point in the leaf of this column and row goes to (x, y).
Phases go(const std::string& update, std::size_t column, std::size_t row, float x, float y) {
  const std::string spec = "paper_quadtree:capacity=1:left=0:top=0:width=16:height=16:update=" + update;
  return Followed(spec, points_in_leaves()).move(16 * row + column, {{x, y}, {x, y}});
}

TEST(PaperQuadtreeTracker, VisitsNodesAndMovesEntries) {
  EXPECT_EQ(go("root", 5, 5, 5.75F, 5.5F).visited, 1U) << "its leaf, which it does not leave";
  EXPECT_EQ(go("root", 5, 5, 5.75F, 5.5F).moved, 0U);
  const Phases from_root = go("root", 0, 0, 15.25F, 15.25F);
  EXPECT_EQ(from_root.visited, 1U + 5U) << "its leaf, and the five levels to the other one";
  EXPECT_EQ(from_root.moved, 1U + 1U + 2U + 2U)
      << "out of the one leaf, into the other, where two are looked through before they are dealt out";
}

TEST(PaperQuadtreeTracker, FindsTheNeighbourByWayOfTheLeastAncestorThatHasAChildThere) {
  // The leaf that is left, those on the way up and down, and the leaf that is entered, which is split.
  EXPECT_EQ(go("cousins", 4, 4, 5.25F, 4.5F).visited, 1U + 1U + 1U) << "a sibling, by way of the parent";
  EXPECT_EQ(go("cousins", 5, 4, 6.25F, 4.5F).visited, 1U + 3U + 1U) << "a cousin";
  EXPECT_EQ(go("cousins", 7, 4, 8.25F, 4.5F).visited, 1U + 7U + 1U) << "across the middle of the world";
  EXPECT_EQ(go("cousins", 4, 4, 5.25F, 5.25F).visited, 1U + 1U + 1U + 1U + 1U) << "two steps";
  EXPECT_EQ(go("siblings", 4, 4, 5.25F, 4.5F).visited, 1U + 1U + 1U);
  EXPECT_EQ(go("siblings", 5, 4, 6.25F, 4.5F).visited, 1U + 5U) << "none there: from the root";
  EXPECT_EQ(go("relative", 5, 4, 6.25F, 4.5F).visited, 1U + 2U + 3U)
      << "up to the node that holds both, and down";
}

TEST(PaperQuadtreeTracker, TranslatesOnlyTheReferencesThatLeaveTheirLeaves) {
  std::vector<Box2> boxes = points_in_leaves();
  boxes.push_back({{2.25F, 2.25F}, {9.25F, 9.25F}});  // 8 x 8 leaves
  const Box2 next = {{3.25F, 2.25F}, {10.25F, 9.25F}};
  const std::string spec = "paper_quadtree:capacity=2:left=0:top=0:width=16:height=16:update=";
  const Phases root = Followed(spec + "root", boxes).move(256, next);
  const Phases cousins = Followed(spec + "cousins", boxes).move(256, next);
  EXPECT_LT(cousins.moved, root.moved / 3);
}

TEST(ErratumT7, AChangeIsToBeComparedWithTheDistanceToTheBoundaryAhead) {
  EXPECT_FALSE(printed::section_vi_b_changes_cell(18, 3, 10)) << "and yet 21 is in the next cell";
  EXPECT_TRUE(printed::section_vi_b_changes_cell(12, 3, 10)) << "and yet 15 is in the same cell";
  const auto moved = [](float from, float to) {
    const std::vector<Box2> boxes = {{{0, 0}, {0, 0}}, {{from, 5}, {from, 5}}, {{100, 100}, {100, 100}}};
    return Followed("paper_grid:cell=10:update=translate", boxes).move(1, {{to, 5}, {to, 5}}).moved;
  };
  EXPECT_EQ(moved(18, 21), 2U);
  EXPECT_EQ(moved(12, 15), 0U);
  EXPECT_EQ(moved(21, 18), 2U);
  EXPECT_EQ(moved(15, 95), 2U) << "more than one cell on";
}

TEST(PaperTrackers, KeepAHeapAndSiftWhatMoved) {
  std::vector<Box2> boxes;
  for (std::size_t i = 1; i <= 1000; ++i)
    boxes.push_back({{static_cast<float>(i), 0}, {static_cast<float>(i), 1}});
  Followed followed("paper_sweep_and_prune:update=heap", boxes);
  EXPECT_EQ(followed.rest().moved, 0U) << "nothing is made anew";
  EXPECT_LE(followed.move(999, {{0, 0}, {0, 1}}).moved, 11U) << "from the last place to the first, by levels";
}

TEST(ErratumT8, AReinsertionComparesLittleAndMovesAll) {
  std::vector<Box2> boxes;
  for (std::size_t i = 1; i <= 1000; ++i)
    boxes.push_back({{static_cast<float>(i), 0}, {static_cast<float>(i), 1}});
  const Phases parts = Followed("paper_sweep_and_prune:update=binary", boxes).move(999, {{0, 0}, {0, 1}});
  EXPECT_LE(parts.visited, 20U);
  EXPECT_EQ(parts.moved, 1000U);
}

TEST(ErratumT10, TheCellsAreSearchedOnceForAllThatMoved) {
  const auto looked_at = [](const std::vector<BoxId>& some) {
    return Followed("paper_grid:cell=1:update=search_once", rows(20, 400)).shift(some, 1).visited;
  };
  EXPECT_LT(looked_at({BoxId{3}, BoxId{7}, BoxId{11}}), looked_at({BoxId{3}}) + 20);
}

TEST(ErratumT11, AStructureIsBuiltAnewWhereItIsOutgrown) {
  for (const std::string& spec : updates_2d) {
    if (spec.find("update=rebuild") != std::string::npos) continue;
    Followed followed(spec, rows(20, 40));
    EXPECT_FALSE(followed.add(rows(20, 40)).built) << spec << ", with twice as many";
    EXPECT_TRUE(followed.add(rows(20, 1)).built) << spec << ", with more than that";
  }
}

TEST(ErratumT19, AReferenceIsLookedForAmongTheOthersOfItsCell) {
  std::vector<Box2> boxes;
  for (const float x : {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 100.0F}) boxes.push_back({{x, x}, {x, x}});
  const Phases parts = Followed("paper_grid:cell=10:update=reinsert", boxes).move(4, {{55, 55}, {55, 55}});
  EXPECT_EQ(parts.visited, 5U + 1U);
}

TEST(ErratumT12, ABoxThatGrowsReachesLeavesWithoutLeavingAny) {
  for (const char* const update : {"siblings", "cousins", "relative", "root"}) {
    const std::vector<Box2> boxes = {{{10, 10}, {20, 20}}, {{80, 80}, {90, 90}}, {{60, 15}, {60, 15}}};
    const std::string spec = std::string("paper_quadtree:capacity=1:update=") + update;
    History<2> history;
    history.boxes = boxes;
    const Box2 grown = {{10, 10}, {60, 20}};
    history.steps.push_back({3, {BoxId{0}}, {grown}});
    Tracker<2> tracker(spec);
    const auto divergence = lab::check_tracker<2>(tracker, history, spec);
    EXPECT_FALSE(divergence) << divergence->text;
  }
}

}  // namespace
}  // namespace broadside::paper
