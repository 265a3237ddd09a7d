// The kernels of the bounding volume hierarchy on every instruction set, against loops over boxes.
#include "kernels/bvh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/queries.hpp"

#include "algorithms/bvh/bvh_index.hpp"
#include "algorithms/bvh/dynamic_bvh.hpp"
#include "algorithms/bvh/packed_levels.hpp"
#include "kernels/bvh_join.hpp"
#include "kernels/bvh_query.hpp"
#include "tests/support/model.hpp"

namespace broadside::kernels {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// A node of these children.
template <int D>
Block<D> node_of(const std::vector<Box<D>>& children) {
  Block<D> node;
  node.clear();
  for (std::size_t lane = 0; lane < children.size(); ++lane) node.set(lane, children[lane]);
  return node;
}

/// Calls `body(rng, children)` for nodes of one to sixteen children.
template <typename Body>
void on_nodes(Body body) {
  on_each_instruction_set([&]<int D>() {
    Rng rng(3);
    for (std::size_t round = 0; round < 20 * fan_out; ++round)
      body(rng, random_boxes<D>(rng, 1 + round % fan_out, {.places = 8}));
  });
}

TEST(BvhNode, HasTheBoundsOfItsChildren) {
  on_nodes([]<int D>(Rng&, const std::vector<Box<D>>& children) {
    Box<D> expected = absent_box<D>();
    for (const Box<D>& child : children) {
      for (int axis = 0; axis < D; ++axis) {
        expected.min[axis] = std::min(expected.min[axis], child.min[axis]);
        expected.max[axis] = std::max(expected.max[axis], child.max[axis]);
      }
    }
    EXPECT_EQ(bounds_of(node_of(children)), expected);
    EXPECT_FALSE(is_present(bounds_of(node_of<D>({}))));
  });
}

TEST(BvhNode, TakesABoxIntoTheChildThatGrowsLeastAndOfThoseTheSmallest) {
  on_nodes([]<int D>(Rng& rng, const std::vector<Box<D>>& children) {
    const Box<D> box = random_box<D>(rng, {.places = 8});
    std::pair<float, float> least{infinity, infinity};
    std::size_t expected = 0;
    for (std::size_t i = 0; i < children.size(); ++i) {
      std::pair<float, float> growth_and_size{0, 0};
      for (int axis = 0; axis < D; ++axis) {
        const auto bounded = [](float value) { return std::clamp(value, -0x1p120f, 0x1p120f); };
        const float min = bounded(children[i].min[axis]);
        const float max = bounded(children[i].max[axis]);
        growth_and_size.first += std::max(max, bounded(box.max[axis])) - max;
        growth_and_size.first += min - std::min(min, bounded(box.min[axis]));
        growth_and_size.second += max - min;
      }
      if (growth_and_size < least) {
        least = growth_and_size;
        expected = i;
      }
    }
    EXPECT_EQ(best_child(node_of(children), children.size(), box), expected);
  });
}

/// Collects the slots of the boxes that a search for near boxes finds.
struct NearCollector final : FoundBoxes {
  bool take() override {
    slots.insert(slots.end(), ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(count));
    count = 0;
    return true;
  }

  std::vector<std::uint32_t> slots;
};

TEST(BvhNear, FindsTheBoxesWithinADistance) {
  on_each_instruction_set([]<int D>() {
    Rng rng(6);
    for (int round = 0; round < 200; ++round) {
      const std::vector<Box<D>> boxes = random_boxes<D>(rng, 1 + rng.below(400));
      algorithm::DynamicBvh<D> tree;
      tree.build(boxes);
      DistanceQuery<D> query{.box = random_box<D>(rng, {.places = 20, .max_extent = 2}), .weight = {}};
      query.weight.fill(1);
      NearCollector found;
      found.t_max = rng.one_in(4) ? infinity : static_cast<float>(rng.whole(0, 40));
      find_near(tree.view(), query, found);
      found.take();
      std::vector<std::uint32_t> ids;
      for (const std::uint32_t slot : found.slots)
        ids.push_back(tree.view().nodes[slot / fan_out].id[slot % fan_out]);
      std::ranges::sort(ids);
      std::vector<std::uint32_t> expected;
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (distance_squared(query.box, boxes[i]) <= found.t_max)
          expected.push_back(static_cast<std::uint32_t>(i));
      }
      EXPECT_EQ(ids, expected);
    }
  });
}

/// The squared distance in units that differ by axis, which are powers of two.
template <int D>
float weighted_distance(Box<D> a, Box<D> b, const std::array<float, D>& weight) {
  for (int axis = 0; axis < D; ++axis) {
    for (float* const coordinate : {&a.min[axis], &a.max[axis], &b.min[axis], &b.max[axis]})
      *coordinate *= weight[axis];
  }
  return static_cast<float>(distance_squared(a, b));
}

/// Boxes of which only the lower bounds count: the upper ones are a little above them.
template <int D>
std::vector<Box<D>> nearly_points(std::vector<Box<D>> boxes) {
  for (Box<D>& box : boxes) {
    for (int axis = 0; axis < D; ++axis) box.max[axis] = box.min[axis] * (1 + 0x1p-23F);
  }
  return boxes;
}

template <int D>
Box<D> lower_bound(const Box<D>& box) {
  return {box.min, box.min};
}

TEST(BvhNear, ListsTheNearestOfEachQueryInAGroup) {
  using Bits = std::int32_t;
  on_each_instruction_set([]<int D>() {
    Rng rng(8);
    for (int round = 0; round < 120; ++round) {
      const bool are_points = rng.one_in(2);
      const std::size_t infinite_one_in = are_points ? 0 : 40;
      std::vector<Box<D>> boxes =
          random_boxes<D>(rng, 1 + rng.below(400), {.infinite_one_in = infinite_one_in});
      if (are_points) boxes = nearly_points<D>(boxes);
      algorithm::DynamicBvh<D> tree;
      tree.build(boxes);
      const bool are_own = rng.one_in(2);
      NearGroup<D> group;
      group.queries.clear();
      std::size_t queries = 1 + rng.below(fan_out);
      if (are_own) {
        group.own_leaf = tree.slot(BoxId(rng.below(boxes.size()))) / fan_out;
        group.queries = tree.view().nodes[group.own_leaf];
        queries = tree.child_count(group.own_leaf);
      } else {
        std::vector<Box<D>> drawn(queries);
        for (Box<D>& query : drawn)
          query = random_box<D>(
              rng, {.places = rng.whole(1, 20), .max_extent = 2, .infinite_one_in = infinite_one_in});
        if (are_points) drawn = nearly_points<D>(drawn);
        for (std::size_t lane = 0; lane < queries; ++lane) group.queries.set(lane, drawn[lane]);
      }
      for (float& weight : group.weight) weight = are_points || rng.one_in(2) ? 1.0F : 0.25F;
      group.are_points = are_points;
      group.error = are_points ? 0x1p-16F : 0.0F;
      const float asked = rng.one_in(2) ? infinity : static_cast<float>(rng.whole(0, 90));
      group.limit = asked;
      // Short lists are kept in other memory.
      group.start(rng.one_in(3) ? 2 : 2 + rng.below(NearGroup<D>::max_count - 1));
      find_near(tree.view(), group);

      EXPECT_LE(group.limit, asked);
      const auto rounded = [](float distance) {
        return std::bit_cast<Bits>(distance) & ~NearGroup<D>::number_mask;
      };
      bool are_full = true;  // all lists but for their last place
      float farthest = 0;    // in these
      for (std::size_t lane = 0; lane < queries; ++lane) {
        const auto distance_of = [&](const Box<D>& box) {
          const Box<D> query = group.queries.box(lane);
          return are_points ? static_cast<float>(distance_squared(lower_bound<D>(query), lower_bound<D>(box)))
                            : weighted_distance<D>(query, box, group.weight);
        };
        const std::uint32_t itself = are_own ? group.queries.id[lane] : no_slot;
        std::vector<float> nearest;
        for (std::size_t i = 0; i < boxes.size(); ++i) {
          if (i != itself) nearest.push_back(distance_of(boxes[i]));
        }
        std::ranges::sort(nearest);
        std::vector<std::uint32_t> listed;
        for (std::size_t i = 0; i < group.count; ++i) {
          const Bits key = group.keys[i][lane];
          // What is within the limit by the boxes' distance is listed.
          const bool is_reached =
              i < nearest.size() && std::sqrt(nearest[i]) <= std::sqrt(group.limit) - group.error;
          if (key == NearGroup<D>::no_key) {
            are_full &= i + 1 == group.count;
            ASSERT_FALSE(is_reached) << "lane " << lane << ", place " << i;
            continue;
          }
          const std::uint32_t slot = group.slot(key);
          listed.push_back(tree.view().nodes[slot / fan_out].id[slot % fan_out]);
          ASSERT_NE(listed.back(), itself);
          const float distance = distance_of(tree.box_at(slot));
          ASSERT_EQ(key & ~NearGroup<D>::number_mask, rounded(distance));
          if (is_reached) {
            ASSERT_EQ(rounded(distance), rounded(nearest[i])) << "lane " << lane << ", place " << i;
          }
          if (i + 1 < group.count) farthest = std::max(farthest, distance);
        }
        std::ranges::sort(listed);
        EXPECT_TRUE(std::ranges::adjacent_find(listed) == listed.end()) << "lane " << lane;
      }
      // A little beyond what the lists hold, and not far.
      if (group.limit < asked) {
        EXPECT_GT(group.limit, farthest);
      }
      if (are_full) {
        EXPECT_LE(group.limit, farthest * 1.001F + (are_points ? 0.01F : 0x1p-120F));
      } else {
        EXPECT_EQ(group.limit, asked);
      }
    }
  });
}

TEST(BvhNear, GivesUpAGroupBeforeItTestsManyBoxes) {
  on_each_instruction_set([]<int D>() {
    const auto at = [](float x) {
      Point<D> point{};
      point[0] = x;
      return Box<D>{point, point};
    };
    std::vector<Box<D>> boxes;
    for (int i = 0; i < 8000; ++i) boxes.push_back(at(static_cast<float>(i)));
    algorithm::DynamicBvh<D> tree;
    tree.build(boxes);
    const auto searched = [&](float spacing) {
      NearGroup<D> group;
      for (std::size_t lane = 0; lane < fan_out; ++lane)
        group.queries.set(lane, at(spacing * static_cast<float>(lane)));
      group.weight.fill(1);
      group.limit = infinity;
      group.start(3);
      find_near(tree.view(), group);
      return group;
    };
    const NearGroup<D> near = searched(1);
    EXPECT_GE(near.limit, 0);
    EXPECT_LT(near.tested, 100U);
    const NearGroup<D> far = searched(500);
    EXPECT_LT(far.limit, 0);
    EXPECT_LE(far.tested, NearGroup<D>::max_tested + fan_out);
  });
}

/// Collects a query's boxes, and lowers t_max to the least entry where the nearest one is looked for.
struct Collector final : FoundBoxes {
  bool take() override {
    for (std::size_t i = 0; i < count; ++i) all.emplace_back(ids[i], t_enter[i]);
    if (is_first) {
      for (const auto& [id, enter] : all) t_max = std::min(t_max, enter);
    }
    count = 0;
    return true;
  }

  bool is_first = false;
  std::vector<std::pair<std::uint32_t, float>> all;
};

TEST(BvhCast, MeetsWhatTheDefinitionSaysAndTheFirstOfThem) {
  on_each_instruction_set([]<int D>() {
    Rng rng(5);
    for (int round = 0; round < 200; ++round) {
      const std::vector<Box<D>> boxes = random_boxes<D>(rng, 1 + rng.below(400));
      algorithm::DynamicBvh<D> tree;
      tree.build(boxes);
      BoxCast<D> cast{.box = random_box<D>(rng, {.max_extent = 2, .infinite_one_in = 0}), .direction = {}};
      cast.t_max = rng.one_in(4) ? infinity : static_cast<float>(rng.whole(0, 8));
      CastQuery<D> query{.box = cast.box, .direction = {}, .inverse = {}, .course = {}, .exact = true};
      for (int axis = 0; axis < D; ++axis) {
        const auto direction = static_cast<float>(rng.whole(-5, 5));
        query.direction[axis] = cast.direction[axis] = direction;
        query.inverse[axis] = direction == 0 ? 1 : 1 / direction;
        query.course[axis] = direction == 0  ? Course::still
                             : rng.one_in(4) ? Course::unknown
                             : direction > 0 ? Course::forward
                                             : Course::backward;
      }
      std::vector<std::pair<std::uint32_t, float>> expected;
      float first = infinity;
      for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        const std::optional<float> enter = t_enter(cast, boxes[i]);
        if (!enter) continue;
        expected.emplace_back(i, *enter);
        first = std::min(first, *enter);
      }
      Collector met;
      met.t_max = cast.t_max;
      EXPECT_TRUE(find_met(tree.view(), query, met));
      met.take();
      std::ranges::sort(met.all);
      ASSERT_EQ(met.all, expected) << "round " << round;
      Collector nearest;
      nearest.is_first = true;
      nearest.t_max = cast.t_max;
      find_first_met(tree.view(), query, nearest);
      ASSERT_EQ(nearest.all.empty(), expected.empty()) << "round " << round;
      if (!expected.empty()) {
        ASSERT_EQ(nearest.t_max, first) << "round " << round;
      }
    }
  });
}

TEST(BvhCast, MeetsTheFirstOfManyThatDifferInTheLastPlaces) {
  on_each_instruction_set([]<int D>() {
    Rng rng(17);
    for (int round = 0; round < 200; ++round) {
      // A wall of boxes side by side, whose faces towards the cast differ by some steps of a float.
      std::vector<Box<D>> boxes(256);
      CastQuery<D> query{.box = {}, .direction = {}, .inverse = {}, .course = {}, .exact = true};
      query.course.fill(Course::still);
      query.inverse.fill(1);
      query.course[0] = Course::forward;
      query.direction[0] = 1;
      query.box.min[1] = -1;
      query.box.max[1] = 300;
      float first = infinity;
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        boxes[i].min[0] = 1 + 0x1p-23F * static_cast<float>(rng.below(100));
        boxes[i].max[0] = 2;
        boxes[i].min[1] = boxes[i].max[1] = static_cast<float>(i);
        first = std::min(first, boxes[i].min[0]);
      }
      algorithm::DynamicBvh<D> tree;
      tree.build(boxes);
      Collector nearest;
      nearest.is_first = true;
      nearest.t_max = infinity;
      find_first_met(tree.view(), query, nearest);
      ASSERT_EQ(nearest.t_max, first) << "round " << round;
    }
  });
}

/// Calls `body(boxes, left_count, tree)` for packed trees of 1 to 900 boxes in any order, some places
/// of which are left empty.
template <typename Body>
void on_packed_trees(Body body) {
  on_each_instruction_set([&]<int D>() {
    Rng rng(7);
    algorithm::PackedLevels<D> levels;
    for (std::size_t size = 1; size <= 900; size += 1 + size / 3) {
      for (const bool is_between : {false, true}) {
        SCOPED_TRACE(testing::Message() << size << (is_between ? " boxes of two sets" : " boxes"));
        const std::vector<Box<D>> boxes = random_boxes<D>(rng, size, {.places = 40, .max_extent = 4});
        const std::size_t left_count = is_between ? (size + 1) / 2 : 0;
        const std::size_t left_places = algorithm::whole_leaves(left_count);
        const std::size_t end = left_places + (size - left_count);
        levels.start(algorithm::whole_leaves(end));
        for (std::size_t i = 0; i < size; ++i)
          levels.put(i < left_count ? i : left_places + (i - left_count), boxes[i], BoxId(i));
        levels.leave(left_count, left_places);
        levels.leave(end, algorithm::whole_leaves(end));
        levels.set_left_size(left_places);
        core::Parallel parallel;
        levels.build(parallel);
        body(boxes, left_count, levels.tree());
      }
    }
  });
}

TEST(BvhJoin, FindsThePairsOfTheDefinitionOnce) {
  on_packed_trees(
      []<int D>(const std::vector<Box<D>>& boxes, std::size_t left_count, const PackedBvh<D>& tree) {
        std::vector<std::uint32_t> scratch(join_scratch(tree));
        const NodeRange all = {0, tree.levels[1].size};
        EXPECT_EQ(sorted_pairs([&](PairSink& sink) { join(tree, all, {}, scratch.data(), sink); }),
                  overlapping_pairs(boxes, left_count));
      });
}

TEST(BvhJoin, LeavesOutWhatIsApartInDouble) {
  Rng rng(13);
  on_packed_trees([&]<int D>(const std::vector<Box<D>>& boxes, std::size_t left_count, PackedBvh<D> tree) {
    std::vector<Box<D, double>> doubles;
    for (const Box<D>& box : boxes) doubles.push_back(near_double(rng, box));
    tree.doubles = doubles.data();
    std::vector<std::uint32_t> scratch(join_scratch(tree));
    const NodeRange all = {0, tree.levels[1].size};
    const std::vector<Pair> expected = overlapping_pairs(doubles, left_count);
    EXPECT_EQ(sorted_pairs([&](PairSink& sink) { join(tree, all, {}, scratch.data(), sink); }), expected);
    if (boxes.size() > 300) {
      EXPECT_LT(expected.size(), overlapping_pairs(boxes, left_count).size());
    }
  });
}

TEST(BvhJoin, FindsTheSamePairsInTheSameOrderInAnyRangesOfLeaves) {
  Rng rng(11);
  on_packed_trees([&]<int D>(const std::vector<Box<D>>&, std::size_t, const PackedBvh<D>& tree) {
    std::vector<std::uint32_t> scratch(join_scratch(tree));
    const std::size_t leaves = tree.levels[1].size;
    std::vector<Pair> whole;
    PairCollector whole_pairs(whole);
    const JoinWork work = join(tree, {0, leaves}, {}, scratch.data(), whole_pairs);
    whole_pairs.flush();
    std::vector<Pair> in_ranges;
    PairCollector range_pairs(in_ranges);
    std::uint64_t tests = 0;
    for (std::size_t begin = 0, end = 0; begin < leaves; begin = end) {
      end = std::min(leaves, begin + 1 + rng.below(20));
      const JoinWork part = join(tree, {begin, end}, {}, scratch.data(), range_pairs);
      EXPECT_EQ(part.next_leaf, end);
      tests += part.tests;
    }
    range_pairs.flush();
    EXPECT_EQ(in_ranges, whole);
    EXPECT_EQ(tests, work.tests);
  });
}

TEST(BvhJoin, CountsNoTestOfAPlaceWithoutABox) {
  on_packed_trees(
      []<int D>(const std::vector<Box<D>>& boxes, std::size_t left_count, const PackedBvh<D>& tree) {
        if (boxes.size() > fan_out) return;
        std::vector<std::uint32_t> scratch(join_scratch(tree));
        JoinWork work{};
        sorted_pairs([&](PairSink& sink) {
          work = join(tree, {0, tree.levels[1].size}, {}, scratch.data(), sink);
        });
        const std::size_t right_count = boxes.size() - left_count;
        if (left_count == 0)
          EXPECT_EQ(work.tests, boxes.size() * (boxes.size() - 1) / 2);  // all in one leaf
        else
          EXPECT_LE(work.tests, left_count * right_count);
      });
}

TEST(BvhJoin, SaysWhichLeavesItHasJoinedWhenItGivesUp) {
  on_packed_trees(
      []<int D>(const std::vector<Box<D>>& boxes, std::size_t left_count, const PackedBvh<D>& tree) {
        if (left_count != 0) return;
        JoinWork work{};
        std::vector<std::uint32_t> scratch(join_scratch(tree));
        const NodeRange all = {0, tree.levels[1].size};
        const std::vector<Pair> found = sorted_pairs(
            [&](PairSink& sink) { work = join(tree, all, {.tests = boxes.size()}, scratch.data(), sink); });
        std::vector<Pair> expected = overlapping_pairs(boxes);
        std::erase_if(expected, [&](Pair pair) { return index(pair.first) >= work.next_leaf * fan_out; });
        EXPECT_EQ(found, expected);
        if (boxes.size() > 200) {
          EXPECT_LT(work.next_leaf, all.end);
          EXPECT_EQ(work.unused, 0U);
        }
      });
}

}  // namespace
}  // namespace broadside::kernels
