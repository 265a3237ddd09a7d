// The search of a tile: rows, buckets, and what it does where boxes are uneven.
#include "algorithms/grid/tile_search.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/finder.hpp"

#include "tests/algorithms/searched.hpp"

namespace broadside::algorithm {
namespace {

template <int D>
TileCells<D> cells_of(const std::vector<Box<D>>& boxes) {
  return TileCells<D>::choose(TileStats<D>::of(std::span(boxes)), boxes.size());
}

template <int D>
std::vector<Pair> swept(const TileSearch<D>& search) {
  return sorted_pairs([&](PairSink& sink) { search.sweep(0, search.places(), nullptr, nullptr, sink); });
}

/// Cells with this many rows on each axis across the swept one, and 128 buckets.
template <int D>
TileCells<D> with_rows(TileCells<D> cells, float rows) {
  for (core::CellAxis& axis : cells.row_axes) {
    axis.per_unit *= rows / (axis.last + 1);
    axis.last = rows - 1;
  }
  cells.buckets.per_unit *= 128 / (cells.buckets.last + 1);
  cells.buckets.last = 127;
  return cells;
}

TEST(TileSearch, FindsThePairsOfTheDefinitionInAnyRows) {
  on_each_instruction_set([]<int D>() {
    Rng rng(1);
    TileSearch<D> search;  // one for all, since it keeps its memory
    for (const std::size_t count : {1, 2, 50, 700, 300}) {
      const std::vector<Box<D>> boxes = random_boxes<D>(rng, count, {.places = 200, .max_extent = 12});
      for (const float rows : {1.0F, 2.0F, 5.0F, 16.0F}) {
        ASSERT_TRUE(search.sort(boxes, with_rows(cells_of(boxes), rows), 0));
        EXPECT_EQ(swept(search), overlapping_pairs(boxes)) << count << " boxes in " << rows << " rows";
        EXPECT_GE(search.references(), count);
      }
    }
  });
}

TEST(TileSearch, CountsItsTestsBeforeItMakesThem) {
  in_each_dimension([]<int D>() {
    Rng rng(2);
    const std::vector<Box<D>> boxes = random_boxes<D>(rng, 2000, {.places = 3000, .max_extent = 90});
    TileSearch<D> search;
    const std::optional<std::uint64_t> tests = search.sort(boxes, cells_of(boxes), 0);
    ASSERT_TRUE(tests);
    PairCounter pairs;
    EXPECT_EQ(search.sweep(0, search.places(), nullptr, nullptr, pairs), *tests);
    EXPECT_LT(*tests, 100 * boxes.size());
  });
}

TEST(TileSearch, RefusesUnevenBoxesButNoLattice) {
  in_each_dimension([]<int D>() {
    Rng rng(3);
    std::vector<Box<D>> uneven(4000);
    std::vector<Box<D>> lattice(4000);
    for (std::size_t i = 0; i < uneven.size(); ++i) {
      std::size_t place = i;
      for (int axis = 0; axis < D; ++axis) {
        const float at = rng.unit();
        uneven[i].min[axis] = 1000 * at * at * at * at;
        lattice[i].min[axis] = static_cast<float>(place % (D == 2 ? 64 : 16));
        place /= D == 2 ? 64 : 16;
        uneven[i].max[axis] = uneven[i].min[axis] + 1;
        lattice[i].max[axis] = lattice[i].min[axis] + 1;
      }
    }
    TileSearch<D> search;
    EXPECT_FALSE(search.sort(uneven, cells_of(uneven), 0, 3));
    EXPECT_TRUE(search.sort(lattice, cells_of(lattice), 0, 3));
    EXPECT_TRUE(search.sort(uneven, cells_of(uneven), 0)) << "if it must";
    EXPECT_EQ(swept(search), overlapping_pairs(uneven));
  });
}

TEST(TileSearch, TellsTestsThatFindNothing) {
  in_each_dimension([]<int D>() {
    // All overlap on the swept axis, and few on the others.
    std::vector<Box<D>> boxes(2000);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      boxes[i].min.fill(static_cast<float>(i));
      boxes[i].max.fill(static_cast<float>(i));
      boxes[i].min[0] = static_cast<float>(i) / 2000;
      boxes[i].max[0] = boxes[i].min[0] + 5;
    }
    TileCells<D> cells = cells_of(boxes);
    cells.axes[0] = 0;
    for (int axis = 1; axis < D; ++axis) cells.axes[axis] = axis;
    TileSearch<D> search;
    ASSERT_TRUE(search.sort(boxes, with_rows(cells, 1), 0));
    EXPECT_TRUE(search.finds_few_pairs());
    for (Box<D>& box : boxes) box.min.fill(0);
    ASSERT_TRUE(search.sort(boxes, with_rows(cells, 1), 0));
    EXPECT_FALSE(search.finds_few_pairs());
  });
}

TEST(TileCells, StayWithinTheNumbersOfTheirKeys) {
  in_each_dimension([]<int D>() {
    Rng rng(4);
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const std::size_t count :
         {std::size_t{1}, std::size_t{7}, std::size_t{100}, std::size_t{5000}, TileCells<D>::max_boxes}) {
      for (const float extent : {0.0F, 0.5F, 30.0F, infinity}) {
        std::vector<Box<D>> boxes(count);
        for (Box<D>& box : boxes) {
          for (int axis = 0; axis < D; ++axis) {
            box.min[axis] = rng.one_in(50) ? -infinity : 1e3F * rng.unit();
            box.max[axis] = box.min[axis] + extent;
            if (!(box.min[axis] <= box.max[axis])) box.max[axis] = infinity;
          }
        }
        const TileCells<D> cells = cells_of(boxes);
        EXPECT_LE(cells.rows() * cells.buckets.count(), std::size_t{1} << 16);
        EXPECT_GE(cells.buckets.count(), TileCells<D>::min_buckets);
      }
    }
  });
}

TEST(Grid, SearchesFewBoxesOfAnyKindAsATile) {
  on_each_instruction_set([]<int D>() {
    Rng rng(5);
    for (const int places : {1, 3, 40, 1000, 100000}) {
      std::vector<Box<D>> boxes = random_boxes<D>(rng, 900, {.places = places, .max_extent = 9});
      expect_definition("grid", boxes);
      boxes[17].max.fill(1e30F);  // a box over all others
      boxes[18].min.fill(-1e30F);
      boxes[18].max.fill(-1e29F);  // and one far from all
      expect_definition("grid", boxes);
    }
  });
}

/// The pairs of a search in the order in which it writes them.
template <int D>
std::vector<Pair> in_order(Finder<D>& finder, const std::vector<Box<D>>& boxes) {
  return written_pairs([&](PairSink& sink) { finder.find(boxes, sink); });
}

TEST(Grid, FindsTheSameWhateverWasSearchedBefore) {
  in_each_dimension([]<int D>() {
    std::vector<Box<D>> boxes(2000);
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].max.fill(static_cast<float>(i + 1));
    Finder<D> fresh("grid");
    Finder<D> used("grid");
    PairCounter none;
    used.find_across(boxes, boxes.size() - 1, none);
    EXPECT_EQ(in_order(used, boxes), in_order(fresh, boxes));
    EXPECT_EQ(used.explanation(), fresh.explanation());
  });
}

TEST(TileCells, SuitHugeRangesAndInfiniteMinima) {
  in_each_dimension([]<int D>() {
    Rng rng(7);
    std::vector<Box<D>> huge(4000);
    std::vector<Box<D>> infinite(4000);
    for (std::size_t i = 0; i < huge.size(); ++i) {
      for (int axis = 0; axis < D; ++axis) {
        huge[i].min[axis] = 3e38F * (rng.unit() - 0.5F);
        huge[i].max[axis] = huge[i].min[axis] + 1e36F;
        infinite[i].min[axis] = axis == 0 ? -std::numeric_limits<float>::infinity() : 1000 * rng.unit();
        infinite[i].max[axis] = axis == 0 ? 0 : infinite[i].min[axis] + 1;
      }
    }
    TileSearch<D> search;
    for (const std::vector<Box<D>>& boxes : {huge, infinite}) {
      const auto tests = search.sort(boxes, cells_of(boxes), 0);
      ASSERT_TRUE(tests);
      EXPECT_LT(*tests, 100 * boxes.size());
    }
  });
}

TEST(TileSearch, RefusesBoxesInManyRows) {
  in_each_dimension([]<int D>() {
    Rng rng(8);
    std::vector<Box<D>> boxes = random_boxes<D>(rng, 3000, {.places = 1000, .infinite_one_in = 0});
    TileCells<D> cells = with_rows(cells_of(boxes), 16);
    TileSearch<D> search;
    EXPECT_TRUE(search.sort(boxes, cells, 0));
    for (Box<D>& box : boxes) box.max.fill(2000);
    EXPECT_FALSE(search.sort(boxes, cells, 0));
  });
}

TEST(Grid, TakesFewTestsBesideABoxFarAway) {
  in_each_dimension([]<int D>() {
    Rng rng(6);
    std::vector<Box<D>> boxes =
        random_boxes<D>(rng, 3000, {.places = 3000, .max_extent = 60, .infinite_one_in = 0});
    boxes[18].min.fill(-1e30F);
    boxes[18].max.fill(-1e29F);
    const auto statistics = expect_definition("grid", boxes);
    ASSERT_TRUE(statistics);
    boxes[18] = boxes[17];
    const auto without = expect_definition("grid", boxes);
    EXPECT_LT(statistics->tests, 2 * without->tests);
  });
}

}  // namespace
}  // namespace broadside::algorithm
