// Parts of space: every place in one, every box in all that it touches, every pair in one.
#include "broadside/partition.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/sinks.hpp"

#include "tests/support/model.hpp"

namespace broadside {
namespace {

using testing::ElementsAreArray;

/// Boxes as they come: on a lattice with infinite sides, in clusters, with a few that are huge, all at one
/// place.
template <int D>
std::vector<std::vector<Box<D>>> inputs() {
  Rng rng(7);
  std::vector<std::vector<Box<D>>> inputs(4);
  inputs[0] = random_boxes<D>(rng, 300);
  inputs[0].push_back(absent_box<D>());
  Box<D> far;
  far.min.fill(infinity);
  far.max.fill(infinity);
  inputs[0].push_back(far);
  for (int i = 0; i < 300; ++i) {
    Box<D> box = random_box<D>(rng, {.places = 8, .max_extent = 2, .infinite_one_in = 0});
    const float place = static_cast<float>(rng.whole(0, 5) * 100);
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] += place;
      box.max[axis] += place;
    }
    inputs[1].push_back(box);
    inputs[2].push_back(random_box<D>(rng, {.places = 500, .max_extent = 1, .infinite_one_in = 0}));
    if (i % 30 == 0) inputs[2].back().max[i % D] += 400;
    inputs[3].push_back(inputs[1][0]);
  }
  return inputs;
}

template <int D>
void expect_pairs_in_one_part_each(const std::vector<Box<D>>& boxes, const Partition<D>& partition) {
  std::multiset<Pair> pairs;
  for (std::size_t part = 0; part < partition.size(); ++part) {
    std::vector<Box<D>> touching;
    std::vector<BoxId> places;
    std::vector<std::uint8_t> begins_before;
    for (std::size_t place = 0; place < boxes.size(); ++place) {
      bool is_visited = false;
      if (is_present(boxes[place]))
        partition.for_each_part(boxes[place], [&](std::size_t visited) { is_visited |= visited == part; });
      ASSERT_EQ(is_visited, is_present(boxes[place]) && partition.region(part).touches(boxes[place]));
      if (!is_visited) continue;
      touching.push_back(boxes[place]);
      places.push_back(BoxId(place));
      begins_before.push_back(static_cast<std::uint8_t>(partition.region(part).begins_before(boxes[place])));
    }
    std::vector<Pair> found;
    PairCollector collector(found);
    PartPairs own(begins_before, begins_before, collector);
    for (const Pair pair : overlapping_pairs(touching)) own.add(pair.first, pair.second);
    own.flush();
    collector.flush();
    for (const Pair pair : found) {
      const Box<D>& first = touching[index(pair.first)];
      const Box<D>& second = touching[index(pair.second)];
      Point<D> minimum;
      for (int axis = 0; axis < D; ++axis) minimum[axis] = std::max(first.min[axis], second.min[axis]);
      EXPECT_EQ(partition.owner(minimum), part);
      pairs.insert({places[index(pair.first)], places[index(pair.second)]});
    }
  }
  EXPECT_THAT(pairs, ElementsAreArray(overlapping_pairs(boxes)));
}

TEST(Partition, PutsEachPairIntoOnePart) {
  in_each_dimension([]<int D>() {
    for (const std::vector<Box<D>>& boxes : inputs<D>()) {
      for (const std::size_t parts : {1, 2, 3, 7, 16})
        expect_pairs_in_one_part_each<D>(boxes, Partition<D>(boxes, parts, 100'000));
    }
  });
}

TEST(Partition, StaysInTheSpaceThatItCuts) {
  in_each_dimension([]<int D>() {
    const std::vector<Box<D>> boxes = inputs<D>()[2];
    const Partition<D> whole(boxes, 4);
    for (std::size_t part = 0; part < whole.size(); ++part) {
      const Partition<D> inner(boxes, 3, 0, whole.region(part));
      EXPECT_GT(inner.size(), 1U);
      for (std::size_t place = 0; place < inner.size(); ++place)
        for (int axis = 0; axis < D; ++axis) {
          EXPECT_GE(inner.region(place).low[axis], whole.region(part).low[axis]);
          EXPECT_LE(inner.region(place).high[axis], whole.region(part).high[axis]);
        }
    }
  });
}

TEST(Partition, HasPartsOfAboutEqualCost) {
  Rng rng(3);
  std::vector<Box2> boxes;
  for (int i = 0; i < 20'000; ++i) {
    // Half of them crowd into a hundredth of the space.
    const float side = i % 2 == 0 ? 1000.0F : 100.0F;
    const Box2 box{{rng.between(0, side), rng.between(0, side)}, {}};
    boxes.push_back({box.min, {box.min[0] + 1, box.min[1] + 1}});
  }
  const Partition<2> partition(boxes, 12);
  std::vector<std::size_t> touching(partition.size());
  for (const Box2& box : boxes) partition.for_each_part(box, [&](std::size_t part) { ++touching[part]; });
  EXPECT_EQ(partition.size(), 12U);
  EXPECT_LT(std::ranges::max(touching), 20'000 / 12 * 6 / 5);
}

TEST(Partition, CountsThePairsOfACrowd) {
  // As many boxes on either side; on one each overlaps all others there.
  std::vector<Box2> boxes;
  for (int i = 0; i < 500; ++i) {
    const auto x = static_cast<float>(i);
    boxes.push_back({{x, 0}, {x, 0}});
    boxes.push_back({{-1000 + x / 1000, 0}, {-999, 0}});
  }
  const auto boxes_below = [&](const Partition<2>& partition) {
    const float cut = partition.cuts()[0].at;
    return std::ranges::count_if(boxes, [cut](const Box2& box) { return box.min[0] < cut; });
  };
  EXPECT_NEAR(static_cast<double>(boxes_below(Partition<2>(boxes, 2))), 500, 10);
  EXPECT_LT(boxes_below(Partition<2>(boxes, 2, boxes.size())), 450);
}

TEST(Partition, HasFewerPartsWhereCutsTellNothingApart) {
  const std::vector<Box2> boxes(100, at(0));
  EXPECT_EQ(Partition<2>(boxes, 8).size(), 1U);
  EXPECT_EQ(Partition<2>({}, 8).size(), 1U);
}

TEST(Partition, IsTheSameFromItsCuts) {
  const std::vector<Box3> boxes = inputs<3>()[1];
  const Partition<3> partition(boxes, 9);
  const Partition<3> same({partition.cuts().begin(), partition.cuts().end()});
  ASSERT_EQ(same.size(), partition.size());
  for (std::size_t part = 0; part < same.size(); ++part) EXPECT_EQ(same.region(part), partition.region(part));
}

TEST(Partition, RefusesCutsThatAreNoTree) {
  using Cut = Partition<2>::Cut;
  const auto refuses = [](std::vector<Cut> cuts) {
    EXPECT_THROW(Partition<2>(std::move(cuts)), std::invalid_argument);
  };
  refuses({});
  refuses({{.axis = 0, .below = 0, .above = 1, .at = 0}, {}});                // itself
  refuses({{.axis = 0, .below = 1, .above = 9, .at = 0}, {}});                // out of the list
  refuses({{.axis = 2, .below = 1, .above = 2, .at = 0}, {}, {.below = 1}});  // no such axis
  refuses({{.axis = 0, .below = 1, .above = 2, .at = nan}, {}, {.below = 1}});
  refuses({{}, {}});  // one that nothing leads to
  EXPECT_THROW(Partition<2>({}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace broadside
