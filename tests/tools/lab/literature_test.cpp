// The algorithms from the literature are in the catalogue, as a group of their own.
#include "lab/literature/literature.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/catalogue.hpp"
#include "lab/literature/interval_list.hpp"

namespace broadside::lab {
namespace {

using testing::ElementsAre;
using testing::IsSupersetOf;

TEST(Literature, IsAGroupOfTheCatalogue) {
  const Catalogue catalogue;
  std::vector<std::string> selected;
  for (const Entry& entry : catalogue.select("literature")) {
    selected.push_back(entry.spec.text());
    EXPECT_EQ(entry.algorithm->kind, AlgorithmKind::literature) << selected.back();
    EXPECT_TRUE(entry.algorithm->has_dimension(2) && entry.algorithm->has_dimension(3)) << selected.back();
  }
  EXPECT_THAT(selected, ElementsAre("terdiman_box_pruning", "segmented_sap", "serpa_kd_tree", "karras_lbvh",
                                    "pbsm_stripes", "two_layer_grid"));
}

/// Intervals [i, i + 1/2] for i < 100, and 200 from -1 to 99.2, which was there before the others: so the
/// segments, which begin with four ends, have been split under it.
literature::IntervalList intervals() {
  literature::IntervalList list(4);
  list.insert({-1, false, 200}, {99.2F, true, 200});
  for (std::uint32_t i = 0; i < 100; ++i) {
    const auto begin = static_cast<float>(i);
    list.insert({begin, false, i}, {begin + 0.5F, true, i});
  }
  return list;
}

std::vector<std::uint32_t> overlaps(const literature::IntervalList& list, float min, float max) {
  constexpr std::uint32_t other = 1000;
  std::vector<std::uint32_t> met;
  list.for_each_overlap({min, false, other}, {max, true, other},
                        [&](std::uint32_t id) { met.push_back(id); });
  return met;
}

TEST(IntervalList, FindsLongIntervalsThatBeganSegmentsAgo) {
  literature::IntervalList list = intervals();
  EXPECT_THAT(overlaps(list, 90.1F, 91.0F), IsSupersetOf({90U, 91U, 200U}));
  list.erase({-1, false, 200}, {99.2F, true, 200});
  EXPECT_THAT(overlaps(list, 90.1F, 91.0F), testing::Not(testing::Contains(200U)));
}

TEST(IntervalList, TellsEachIntervalThatAMovedOneMeetsOrLeaves) {
  literature::IntervalList list = intervals();
  std::vector<std::uint32_t> passed;
  // From [3, 3.5] to [10.25, 10.75]: past 4 to 9 with both ends, and into 10, whose end it touches not yet.
  list.move({3, false, 3}, {3.5F, true, 3}, {10.25F, false, 3}, {10.75F, true, 3},
            [&](std::uint32_t id) { passed.push_back(id); });
  EXPECT_THAT(passed, IsSupersetOf({4U, 5U, 6U, 7U, 8U, 9U, 10U}));
  EXPECT_THAT(passed, testing::Not(testing::Contains(testing::AnyOf(11U, 200U))));
  EXPECT_THAT(overlaps(list, 10, 10.5F), IsSupersetOf({3U, 10U}));
}

}  // namespace
}  // namespace broadside::lab
