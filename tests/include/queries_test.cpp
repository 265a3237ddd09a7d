// Queries: what they promise beyond agreeing with the definitions.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/index.hpp"

#include "algorithms/bvh/bvh_index.hpp"
#include "tests/support/boxes.hpp"
#include "tests/support/message.hpp"
#include "tests/support/scattered.hpp"

namespace broadside {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// `count` boxes in a row along axis 0, one apart: box i spans 2i to 2i + 1, and 0 to 1 on axis 1.
std::vector<Box2> row(std::size_t count) {
  std::vector<Box2> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = static_cast<float>(2 * i);
    boxes.push_back({{at, 0}, {at + 1, 1}});
  }
  return boxes;
}

BoxIndex<2> index_of(const std::vector<Box2>& boxes) {
  BoxIndex<2> index;
  index.update({.boxes = boxes, .changed = {}});
  return index;
}

std::vector<BoxId> overlapping(const BoxIndex<2>& index, const Box2& box,
                               const BoxIndex<2>::QueryOptions& options = {}) {
  std::vector<BoxId> found;
  index.overlapping(
      box, [&found](BoxId id) { found.push_back(id); }, options);
  std::ranges::sort(found);
  return found;
}

static_assert(std::is_final_v<BoxIndex<2>> && std::is_nothrow_move_constructible_v<BoxIndex<2>>);

TEST(BoxIndex, MovesWithItsBoxes) {
  BoxIndex<2> index = index_of(row(3));
  BoxIndex<2> moved(std::move(index));
  EXPECT_THAT(overlapping(moved, {{2, 0}, {9, 1}}), ElementsAre(BoxId(1), BoxId(2)));
  index = index_of(row(1));
  index.update({.boxes = row(2), .changed = {}});
  EXPECT_THAT(overlapping(index, {{2, 0}, {9, 1}}), ElementsAre(BoxId(1)));
}

TEST(RayEntry, IsWhereTheRayFirstTouches) {
  const Box2 box{{2, 0}, {4, 1}};
  EXPECT_EQ(t_enter(Ray<2>{{0, 0.5f}, {1, 0}}, box), 2);
  EXPECT_EQ(t_enter(Ray<2>{{0, 0.5f}, {4, 0}}, box), 0.5f);
  EXPECT_EQ(t_enter(Ray<2>{{6, 0.5f}, {-1, 0}}, box), 2);
  EXPECT_EQ(t_enter(Ray<2>{{3, 0.5f}, {1, 0}}, box), 0);
  EXPECT_EQ(t_enter(Ray<2>{{3, 0.5f}, {0, 0}}, box), 0);
  EXPECT_EQ(t_enter(Ray<2>{{6, 0.5f}, {1, 0}}, box), std::nullopt);
  EXPECT_EQ(t_enter(Ray<2>{{0, 2}, {1, 0}}, box), std::nullopt);
  EXPECT_EQ(t_enter(Ray<2>{{0, 0.5f}, {1, 0}, 1.5f}, box), std::nullopt);
  EXPECT_EQ(t_enter(Ray<2>{{0, 0.5f}, {1, 0}, 2}, box), 2);
}

TEST(RayEntry, CountsWhatIsGrazed) {
  const Box2 box{{1, 3}, {2, 4}};
  EXPECT_EQ(t_enter(Ray<2>{{0, 3}, {1, 0}}, box), 1) << "along a face";
  EXPECT_EQ(t_enter(Ray<2>{{0, 0}, {2, 3}}, box), 1) << "a corner";
  EXPECT_EQ(t_enter(Ray<2>{{0, 5}, {7, -7}}, box), 1 / 7.0f) << "another corner";
  EXPECT_EQ(t_enter(Ray<2>{{2, 4}, {1, 1}}, box), 0) << "from a corner outwards";
}

TEST(RayEntry, KnowsInfiniteBoxes) {
  const Box2 half_space{{5, -infinity}, {infinity, infinity}};
  EXPECT_EQ(t_enter(Ray<2>{{0, 0}, {2, 1}}, half_space), 2.5f);
  EXPECT_EQ(t_enter(Ray<2>{{0, 0}, {-1, 0}}, half_space), std::nullopt);
  EXPECT_EQ(t_enter(Ray<2>{{0, 0}, {0, 1}}, half_space), std::nullopt);
  EXPECT_EQ(t_enter(Ray<2>{{6, 0}, {0, 1}}, half_space), 0);
}

TEST(BoxCastEntry, IsWhereTheMovedBoxFirstTouches) {
  const Box2 box{{5, 0}, {6, 1}};
  EXPECT_EQ(t_enter(BoxCast<2>{{{0, 0}, {2, 1}}, {1, 0}}, box), 3);
  EXPECT_EQ(t_enter(BoxCast<2>{{{0, 1}, {2, 2}}, {1, 0}}, box), 3) << "touching at a face";
  EXPECT_EQ(t_enter(BoxCast<2>{{{0, 1.5f}, {2, 2}}, {1, 0}}, box), std::nullopt);
  EXPECT_EQ(t_enter(BoxCast<2>{{{9, 0}, {10, 1}}, {-2, 0}}, box), 1.5f);
}

TEST(BoxCastEntry, LeavesOutWhatTheCastIsInRestsOnOrLeaves) {
  const Box2 box{{2, 0}, {4, 1}};
  const auto enter = [&box](const Box2& from, const std::array<float, 2>& direction) {
    return t_enter(BoxCast<2>{.box = from, .direction = direction, .entering = true}, box);
  };
  EXPECT_EQ(enter({{0, 0}, {1, 1}}, {1, 0}), 1) << "from outside";
  EXPECT_EQ(enter({{0, 1}, {1, 2}}, {1, 0}), 1) << "grazing a face";
  EXPECT_EQ(enter({{3, 0}, {5, 1}}, {1, 0}), std::nullopt) << "from inside";
  EXPECT_EQ(enter({{3, 0}, {5, 1}}, {0, 0}), std::nullopt) << "standing still inside";
  EXPECT_EQ(enter({{2, 1}, {3, 2}}, {1, 0}), std::nullopt) << "along the top";
  EXPECT_EQ(enter({{2, 1}, {3, 2}}, {0, 1}), std::nullopt) << "up from the top";
  EXPECT_EQ(enter({{2, 1}, {3, 2}}, {1, 1}), std::nullopt);
  EXPECT_EQ(enter({{2, 1}, {3, 2}}, {1, -0x1p-140f}), 0) << "into the top";
  EXPECT_EQ(enter({{1, 1}, {2, 2}}, {1, -1}), 0) << "into a corner";
  EXPECT_EQ(enter({{1, 1}, {2, 2}}, {1, 1}), std::nullopt) << "past a corner";
  EXPECT_EQ(enter({{1, -1}, {2, std::nextafter(0.0f, -1.0f)}}, {1, 1}), 0x1p-149f) << "just before a corner";
  const Box2 wall{{2, 0}, {2, 1}};
  EXPECT_FALSE(enters(as_cast(Ray<2>{{2, 0.5f}, {1, 0}}), wall)) << "off a wall without thickness";
  EXPECT_TRUE(enters(as_cast(Ray<2>{{std::nextafter(2.0f, 0.0f), 0.5f}, {1, 0}}), wall));
}

/// The definition by the times between which a cast that nothing stops touches the box, on a grid of ties.
TEST(BoxCastEntry, IsTheBeginningOfAContactThatLasts) {
  const auto expect_ties = []<typename Real>(Real unit) {
    const auto box = [unit](int x, int y, int width, int height) {
      const auto at = [unit](int place) { return static_cast<Real>(place) * unit; };
      return Box<2, Real>{{at(x), at(y)}, {at(x + width), at(y + height)}};
    };
    for (int number = 0; number < 6 * 6 * 3 * 3 * 3 * 3 * 3; ++number) {
      int rest = number;
      const auto digit = [&rest](int base) { return std::exchange(rest, rest / base) % base; };
      const std::array<Real, 2> direction = {Real(digit(3) - 1), Real(digit(3) - 1)};
      const int side = digit(3);
      const BoxCast<2, Real> cast{
          .box = box(digit(6) - 3, digit(6) - 3, side, side), .direction = direction, .t_max = 9 * unit};
      const Box<2, Real> other = box(0, 0, digit(3), digit(3));
      Real begins = -infinity;
      Real ends = infinity;
      for (const int axis : {0, 1}) {
        const Real before = other.min[axis] - cast.box.max[axis];
        const Real after = other.max[axis] - cast.box.min[axis];
        if (direction[axis] == 0) {
          if (before > 0 || after < 0) ends = -infinity;
        } else {
          begins = std::max(begins, direction[axis] > 0 ? before : -after);
          ends = std::min(ends, direction[axis] > 0 ? after : -before);
        }
      }
      BoxCast<2, Real> entering = cast;
      entering.entering = true;
      const bool is_hit = begins <= ends && begins >= 0 && ends > 0;
      ASSERT_EQ(t_enter(entering, other), is_hit ? std::optional(begins) : std::nullopt) << number;
      ASSERT_EQ(t_enter(entering, other), is_hit ? t_enter(cast, other) : std::nullopt) << number;
    }
  };
  expect_ties(1.0f);
  expect_ties(1.0);
  expect_ties(std::numeric_limits<float>::denorm_min());
  expect_ties(std::numeric_limits<double>::denorm_min());
}

TEST(DistanceSquared, IsZeroInsideAndDefinedForInfinities) {
  const Box2 box{{0, 0}, {1, infinity}};
  EXPECT_EQ(distance_squared({0.5f, 7}, box), 0);
  EXPECT_EQ(distance_squared({4, -4}, box), 25);
  EXPECT_EQ(distance_squared({0, infinity}, box), 0);
  EXPECT_EQ(distance_squared({-infinity, 0}, box), infinity);
  EXPECT_EQ(distance_squared(Box2{{4, -6}, {5, -4}}, box), 25);
  EXPECT_EQ(distance_squared(box, Box2{{1, -3}, {5, 0}}), 0) << "touching";
  EXPECT_EQ(distance_squared(Box2{{-1, infinity}, {0, infinity}}, box), 0);
}

TEST(DistanceSquared, OfFloatsIsComputedInDouble) {
  const Box2 box{{3e38f, 1 + 0x1p-20f}, {3e38f, 2}};
  EXPECT_EQ(distance_squared({3e38f, 0}, box), (1 + 0x1p-20) * (1 + 0x1p-20));
  EXPECT_EQ(distance_squared({-3e38f, 2}, box), 4 * (double{3e38f} * double{3e38f}));
}

TEST(BoxIndex, AnswersNothingBeforeAnUpdateAndWithoutBoxes) {
  BoxIndex<2> index;
  const Box2 everything{{-infinity, -infinity}, {infinity, infinity}};
  EXPECT_THAT(overlapping(index, everything), IsEmpty());
  EXPECT_EQ(index.first_hit(Ray<2>{{0, 0}, {1, 0}}), std::nullopt);
  const std::vector<Box2> absent(40, absent_box<2>());
  index.update({.boxes = absent, .changed = {}});
  EXPECT_THAT(overlapping(index, everything), IsEmpty());
  std::vector<Neighbour> found;
  index.nearest({0, 0}, 3, found);
  EXPECT_THAT(found, IsEmpty());
}

TEST(BoxIndex, FindsNothingForAnAbsentBox) {
  const auto index = index_of({{{-infinity, -infinity}, {infinity, infinity}}});
  EXPECT_THAT(overlapping(index, absent_box<2>()), IsEmpty());
}

TEST(BoxIndex, FollowsTheFrames) {
  std::vector<Box2> boxes = row(100);
  auto index = index_of(boxes);
  const Box2 far{{1000, 0}, {1001, 1}};
  boxes[3] = far;
  boxes[4] = absent_box<2>();
  boxes.push_back(far);
  index.update({.boxes = boxes, .changed = std::vector{BoxId(3), BoxId(4)}});
  EXPECT_THAT(overlapping(index, far), ElementsAre(BoxId(3), BoxId(100)));
  EXPECT_THAT(overlapping(index, {{6, 0}, {9, 1}}), IsEmpty());
  boxes.resize(2);
  index.update({.boxes = boxes, .changed = {}});
  EXPECT_THAT(overlapping(index, {{-1e9f, 0}, {1e9f, 1}}), ElementsAre(BoxId(0), BoxId(1)));
}

TEST(BoxIndex, KeepsItsAnswersWhenAFrameIsRefused) {
  std::vector<Box2> boxes = row(50);
  auto index = index_of(boxes);
  boxes[7].min[0] = nan;
  boxes[2] = {{500, 0}, {501, 1}};
  const std::vector changed = {BoxId(2), BoxId(7)};
  EXPECT_THROW(index.update({.boxes = boxes, .changed = changed}), InvalidInput);
  EXPECT_THAT(overlapping(index, {{4, 0}, {4, 0}}), ElementsAre(BoxId(2)));
  const std::vector beyond = {BoxId(50)};
  EXPECT_THROW(index.update({.boxes = row(50), .changed = beyond}), InvalidFrame);
  const std::vector<Filter> filters(49);
  EXPECT_THROW(index.update({.boxes = row(50), .changed = {}, .filters = filters}), InvalidFrame);
}

TEST(BoxIndex, EndsASearchWhenTheVisitorSaysSo) {
  const auto index = index_of(row(2000));
  const Box2 everything{{-1, 0}, {1e6f, 1}};
  int calls = 0;
  EXPECT_FALSE(index.overlapping(everything, [&calls](BoxId) { return ++calls < 3; }));
  EXPECT_EQ(calls, 3);
  calls = 0;
  const Ray<2> along{{-1, 0.5f}, {1, 0}};
  EXPECT_FALSE(index.hits(along, [&calls](Hit<float>) { return ++calls < 30; }));
  EXPECT_EQ(calls, 30);
}

TEST(BoxIndex, HandsOnSmallChunksFirst) {
  class Sizes final : public Visitor<BoxId> {
   public:
    bool visit(std::span<const BoxId> found) override {
      sizes.push_back(found.size());
      return true;
    }
    std::vector<std::size_t> sizes;
  } visitor;
  const auto index = index_of(row(5000));
  EXPECT_TRUE(index.overlapping({{-1, 0}, {1e6f, 1}}, visitor));
  EXPECT_LE(visitor.sizes.front(), 32U);
  EXPECT_LE(visitor.sizes.size(), 60U);
  EXPECT_EQ(std::accumulate(visitor.sizes.begin(), visitor.sizes.end(), std::size_t{0}), 5000U);
}

TEST(BoxIndex, FindsOnlyWhatAcceptsTheQueryFilter) {
  const std::vector<Box2> boxes = row(6);
  std::vector<Filter> filters(6);
  filters[1].category = 4;
  filters[3].mask = 8;
  filters[4].group = -2;
  BoxIndex<2> index;
  index.update({.boxes = boxes, .changed = {}, .filters = filters});
  const Filter query_filter{.category = 1, .mask = 1, .group = -2};
  const Box2 all{{0, 0}, {100, 1}};
  EXPECT_THAT(overlapping(index, all, {&query_filter}), ElementsAre(BoxId(0), BoxId(2), BoxId(5)));
  EXPECT_EQ(index.first_hit(Ray<2>{{5.5f, 0}, {1, 0}}, {&query_filter})->box, BoxId(5));
  filters[5].category = 16;
  index.update({.boxes = boxes, .changed = std::vector{BoxId(5)}, .filters = filters});
  EXPECT_EQ(index.first_hit(Ray<2>{{5.5f, 0}, {1, 0}}, {&query_filter}), std::nullopt);
  index.update({.boxes = boxes, .changed = {}});
  EXPECT_EQ(index.first_hit(Ray<2>{{5.5f, 0}, {1, 0}}, {&query_filter})->box, BoxId(3));
}

TEST(BoxIndex, OfEqualEntriesAndDistancesTakesTheLeastIds) {
  const std::vector<Box2> boxes(300, Box2{{5, 0}, {6, 1}});
  auto index = index_of(boxes);
  EXPECT_EQ(index.first_hit(Ray<2>{{0, 0.5f}, {1, 0}}), (Hit<float>{BoxId(0), 5}));
  std::vector<Neighbour> found;
  index.nearest({3, 0}, 3, found);
  EXPECT_THAT(found, ElementsAre(Neighbour{BoxId(0), 4}, Neighbour{BoxId(1), 4}, Neighbour{BoxId(2), 4}));
}

/// The boxes of which the distance to a point is at most `max_distance`, by the definition.
template <int D, typename Real>
std::vector<Neighbour> within(const std::vector<Box<D, Real>>& boxes, const Point<D, Real>& point,
                              double max_distance) {
  std::vector<Neighbour> found;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const double squared = distance_squared(point, boxes[i]);
    if (squared <= max_distance * max_distance) found.push_back({BoxId(i), squared});
  }
  std::ranges::stable_sort(found, {}, &Neighbour::distance_squared);
  return found;
}

template <int D, typename Real>
void expect_nearest_within() {
  std::vector<Box<D, Real>> boxes;
  for (const Box<D>& box : scattered_boxes<D>(400, 10)) {
    boxes.emplace_back();
    for (std::size_t axis = 0; axis < std::size_t{D}; ++axis) {
      boxes.back().min[axis] = box.min[axis];
      boxes.back().max[axis] = box.max[axis];
    }
  }
  BoxIndex<D, Real> index;
  index.update({.boxes = boxes, .changed = {}});
  Point<D, Real> point;
  point.fill(5);
  for (const Real max_distance :
       {Real(0), Real(0.1), Real(1), boxes[7].max[0], Real(1e6), std::numeric_limits<Real>::infinity()}) {
    const auto expected = within(boxes, point, double{max_distance});
    EXPECT_EQ(index.nearest(point, 1000, {.max_distance = max_distance}), expected) << max_distance;
    if (expected.size() < 3) continue;
    const std::vector few(expected.begin(), expected.begin() + 3);
    EXPECT_EQ(index.nearest(point, 3, {.max_distance = max_distance}), few) << max_distance;
    const std::vector without_first(expected.begin() + 1, expected.end());
    EXPECT_EQ(index.nearest(point, 1000, {.except = expected[0].box, .max_distance = max_distance}),
              without_first);
  }
}

TEST(BoxIndex, FindsTheNearestWithinADistance) {
  expect_nearest_within<2, float>();
  expect_nearest_within<3, float>();
  expect_nearest_within<2, double>();
  expect_nearest_within<3, double>();
}

TEST(BoxIndex, FindsABoxThatIsExactlyAsFarAsTheGreatestDistance) {
  const float tenth = 0.1f;  // its square is rounded
  const auto index = index_of({{{tenth, 0}, {1, 1}}, {{3, 4}, {5, 5}}});
  const float less = std::nextafter(tenth, 0.0f);
  EXPECT_EQ(index.nearest({0, 0}, 9, {.max_distance = tenth}).size(), 1U);
  EXPECT_THAT(index.nearest({0, 0}, 9, {.max_distance = less}), IsEmpty());
  EXPECT_EQ(index.nearest({0, 0}, 9, {.max_distance = 5}).size(), 2U);
  EXPECT_EQ(index.nearest({0, 0}, 9, {.max_distance = std::nextafter(5.0f, 0.0f)}).size(), 1U);
  EXPECT_EQ(index.nearest({tenth, 0.5f}, 9, {.max_distance = 0}), (std::vector{Neighbour{BoxId(0), 0}}));
}

TEST(BoxIndex, FindsNearestOnlyWhatAcceptsTheFilter) {
  std::vector<Filter> filters(6);
  filters[0].category = 4;
  BoxIndex<2> index;
  index.update({.boxes = row(6), .changed = {}, .filters = filters});
  const Filter filter{.mask = 1};
  EXPECT_THAT(index.nearest({0, 0}, 9, {.filter = &filter, .except = BoxId(2), .max_distance = 6}),
              ElementsAre(Neighbour{BoxId(1), 4}, Neighbour{BoxId(3), 36}));
}

TEST(BoxIndex, FindsTheNearestToABox) {
  const auto index = index_of(row(5));
  const Box2 between{{3.25f, 3}, {3.5f, 9}};
  EXPECT_THAT(index.nearest(between, 3), ElementsAre(Neighbour{BoxId(1), 4.0625}, Neighbour{BoxId(2), 4.25},
                                                     Neighbour{BoxId(0), 9.0625}));
  EXPECT_THAT(index.nearest(Box2{{2, 0}, {6, 0}}, 3),
              ElementsAre(Neighbour{BoxId(1), 0}, Neighbour{BoxId(2), 0}, Neighbour{BoxId(3), 0}));
  EXPECT_THAT(index.nearest(absent_box<2>(), 3), IsEmpty());
  EXPECT_THROW(static_cast<void>(index.nearest(Box2{{1, 0}, {0, 0}}, 1)), InvalidQuery);
}

TEST(BoxIndex, WritesTheNearestOfEachQueryInARow) {
  const auto index = index_of(row(2));
  const std::vector<Box2> queries = {{{7, 0}, {8, 0}}, absent_box<2>(), {{0, 0}, {0, 0}}};
  std::vector<BoxId> found(9);
  std::vector<double> distances(9);
  index.nearest_of_each(queries, 3, found, distances);
  EXPECT_THAT(found,
              ElementsAre(BoxId(1), BoxId(0), no_box, no_box, no_box, no_box, BoxId(0), BoxId(1), no_box));
  EXPECT_THAT(distances, ElementsAre(16, 36, infinity, infinity, infinity, infinity, 0, 4, infinity));
  const std::vector<BoxId> except = {BoxId(1), no_box, BoxId(0)};
  index.nearest_of_each(queries, 3, found, distances, {.max_distance = 2, .except = except});
  EXPECT_THAT(found, ElementsAre(no_box, no_box, no_box, no_box, no_box, no_box, BoxId(1), no_box, no_box));
}

TEST(BoxIndex, TestsFewBoxesForEachOfManyQueriesThatAreFarFromAll) {
  std::vector<Box2> boxes;
  std::vector<Box2> queries;
  const auto point = [](float x, float y) { return Box2{{x, y}, {x, y}}; };
  for (int i = 0; i < 16'000; ++i) {
    const auto x = static_cast<float>(i % 127);
    const auto y = static_cast<float>(i / 127);
    boxes.push_back(point(x / 1024, y / 1024));
    queries.push_back(point(100 + 8 * x, 8 * y));
  }
  std::vector<BoxId> found(queries.size());
  std::vector<double> distances(queries.size());
  std::size_t checkpoints = 0;  // passed once per some million tests of a query and a box
  index_of(boxes).nearest_of_each(queries, 1, found, distances,
                                  {.workers = {.checkpoint = [&checkpoints] { ++checkpoints; }}});
  EXPECT_LT(checkpoints, 10U);
}

TEST(BoxIndex, RefusesBadQueriesOfManyAndWritesNothing) {
  const auto index = index_of(row(2));
  const std::vector<Box2> bad = {{{0, 0}, {1, 1}}, {{0, nan}, {1, 1}}};
  std::vector<BoxId> found(4, BoxId(7));
  std::vector<double> distances(4, 7);
  const auto message = [&](std::span<const Box2> queries, std::size_t count,
                           const NearestOfEachOptions& options) {
    return message_of<InvalidQuery>(
        [&] { index.nearest_of_each(queries, count, found, distances, options); });
  };
  const std::span<const Box2> two(bad);
  EXPECT_THAT(message(two, 2, {}), HasSubstr("query 1 has min (0, nan)"));
  EXPECT_THAT(message(two, 0, {}), HasSubstr("k is 0; expected at least 1"));
  EXPECT_THAT(message(two, 3, {}), HasSubstr("found has 4 places for 2 queries; expected 3 for each"));
  EXPECT_THAT(message(two, 2, {.max_distance = nan}), HasSubstr("max_distance is nan; expected at least 0"));
  EXPECT_THAT(message(two, 2, {.max_distance = -1}), HasSubstr("max_distance is -1"));
  const std::vector<Filter> filters(1);
  EXPECT_THAT(message(two, 2, {.filters = filters}), HasSubstr("filters has 1 places for 2 queries"));
  EXPECT_THAT(found, testing::Each(BoxId(7)));
  EXPECT_THAT(distances, testing::Each(7));
}

TEST(BoxIndex, HandsTheNearestToAFunctionUntilItEnds) {
  const auto index = index_of(row(100));
  std::vector<BoxId> found;
  const bool is_whole = index.nearest({0, 0}, 90, [&found](const Neighbour& one) {
    found.push_back(one.box);
    return found.size() < 3;
  });
  EXPECT_FALSE(is_whole);
  EXPECT_THAT(found, ElementsAre(BoxId(0), BoxId(1), BoxId(2)));
}

TEST(BoxIndex, TakesTheFilterAndTheBoxLeftOutInEveryQuery) {
  const auto index = index_of(row(3));
  std::vector<BoxId> found;
  const auto add = [&found](BoxId id) { found.push_back(id); };
  const auto options = BoxIndex<2>::QueryOptions{.except = BoxId(0)};
  index.overlapping({{0, 0}, {2, 1}}, add, options);
  index.containing({2.5f, 0.5f}, add, {.except = BoxId(0)});
  index.hits(
      Ray<2>{{0, 0}, {1, 0}, 3}, [&add](const Hit<float>& hit) { add(hit.box); }, options);
  found.push_back(index.first_hit(Ray<2>{{0, 0}, {1, 0}}, {.except = BoxId(0)})->box);
  EXPECT_THAT(found, testing::Each(BoxId(1)));
  EXPECT_EQ(found.size(), 4U);
}

TEST(BoxIndex, RefusesQuestionsWithoutAMeaning) {
  const auto index = index_of(row(3));
  const auto ignore = [](auto) {};
  std::vector<Neighbour> found;
  const Ray<2> good{{0, 0}, {1, 0}};
  Ray<2> bad = good;
  bad.origin[1] = infinity;
  EXPECT_THAT(message_of<InvalidQuery>([&] { static_cast<void>(index.first_hit(bad)); }),
              HasSubstr("0, inf; expected finite"));
  bad = good;
  bad.direction[0] = nan;
  EXPECT_THAT(message_of<InvalidQuery>([&] { index.hits(bad, ignore); }), HasSubstr("direction"));
  bad = good;
  bad.t_max = -1;
  EXPECT_THAT(message_of<InvalidQuery>([&] { static_cast<void>(index.first_hit(bad)); }),
              HasSubstr("t_max is -1; expected at least 0"));
  EXPECT_THROW(static_cast<void>(index.first_hit(BoxCast<2>{{{1, 1}, {0, 2}}, {1, 0}})), InvalidQuery);
  EXPECT_THROW(index.overlapping({{1, 1}, {0, 2}}, ignore), InvalidQuery);
  EXPECT_THROW(index.containing({0, nan}, ignore), InvalidQuery);
  EXPECT_THROW(index.nearest({0, nan}, 1, found), InvalidQuery);
  EXPECT_THAT(message_of<InvalidQuery>([&] {
                static_cast<void>(index.nearest({0, 0}, 1, {.max_distance = -1}));
              }),
              names("max_distance is -1", "at least 0"));
  EXPECT_THROW(static_cast<void>(index.nearest({0, 0}, 1, {.max_distance = nan})), InvalidQuery);
}

TEST(BoxIndex, LetsAVisitorsExceptionThroughAndGoesOn) {
  const auto index = index_of(row(100));
  const Box2 all{{0, 0}, {1000, 1}};
  EXPECT_THROW(index.overlapping(all, [](BoxId) { throw std::runtime_error("enough"); }), std::runtime_error);
  EXPECT_EQ(overlapping(index, all).size(), 100U);
}

TEST(BoxIndex, DoesNotGrowUnderChurn) {
  std::vector<Box2> boxes = row(2000);
  auto index = index_of(boxes);
  std::vector<BoxId> changed;
  std::size_t bytes = 0;
  for (std::size_t frame = 0; frame < 2000; ++frame) {
    changed.clear();
    for (std::size_t k = 0; k < 20; ++k) {
      const std::size_t i = (frame * 20 + k) * 37 % boxes.size();
      const auto at = static_cast<float>((frame * 7919 + k * 104729) % 4000);
      boxes[i] = (frame + k) % 3 == 0 ? absent_box<2>() : Box2{{at, 0}, {at + 1, 1}};
      changed.push_back(BoxId(i));
    }
    index.update({.boxes = boxes, .changed = changed});
    if (frame == 200) bytes = index.bytes();
  }
  EXPECT_LE(index.bytes(), bytes + bytes / 4);
}

/// How many boxes the index took for this frame.
std::uint64_t taken(BoxIndex<2>& index, const Frame<2>& frame) {
  const algorithm::DynamicBvh<2>& tree = algorithm::BvhIndex<2, float>::of(index).tree();
  const std::uint64_t before = tree.boxes_taken();
  index.update(frame);
  return tree.boxes_taken() - before;
}

TEST(BoxIndex, TakesWhatChangedWhateverTheNumberOfBoxes) {
  for (const std::size_t size : {200U, 20'000U}) {
    std::vector<Box2> boxes = row(size);
    std::vector<Filter> filters(size);
    BoxIndex<2> index;
    EXPECT_EQ(taken(index, {.boxes = boxes, .filters = filters}), size);
    EXPECT_EQ(taken(index, {.boxes = boxes, .filters = filters}), 0U);
    boxes[3] = boxes[100];
    boxes[4] = absent_box<2>();
    filters[5].mask = 1;
    const std::vector<BoxId> changed = {BoxId{3}, BoxId{4}, BoxId{5}};
    EXPECT_EQ(taken(index, {.boxes = boxes, .changed = changed, .filters = filters}), 3U);
    boxes.resize(size + 2, boxes[3]);
    filters.resize(size + 2);
    EXPECT_EQ(taken(index, {.boxes = boxes, .filters = filters}), 2U) << "new ones";
    boxes.resize(size - 3);
    filters.resize(size - 3);
    EXPECT_EQ(taken(index, {.boxes = boxes, .filters = filters}), 5U) << "those that are gone";
  }
}

/// Random boxes with sides of 10; the first corners are from 0 to `side_x` and `side_y`.
std::vector<Box2> spread(Rng& rng, std::size_t size, float side_x, float side_y) {
  std::vector<Box2> boxes(size);
  const auto place = [&](float side) { return static_cast<float>(rng.below(1 << 20)) * side / (1 << 20); };
  for (Box2& box : boxes) {
    const float x = place(side_x);
    const float y = place(side_y);
    box = {{x, y}, {x + 10, y + 10}};
  }
  return boxes;
}

TEST(BoxIndex, IsBuiltAnewOnlyWhenMovesSpoilIt) {
  constexpr std::size_t size = 4000;
  Rng rng{5};
  std::vector<BoxId> all;
  for (std::size_t i = 0; i < size; ++i) all.push_back(BoxId(i));
  std::vector<Box2> boxes = spread(rng, size, 1000, 1000);
  auto index = index_of(boxes);
  for (int frame = 0; frame < 4; ++frame) {
    for (std::size_t i = 0; i < size; ++i) {
      const float step = i % 2 == 0 ? 1 : -1;
      boxes[i] = {{boxes[i].min[0] + step, boxes[i].min[1]}, {boxes[i].max[0] + step, boxes[i].max[1]}};
    }
    EXPECT_EQ(taken(index, {.boxes = boxes, .changed = all}), size) << "moved in their leaves";
  }
  const auto endless = [](std::vector<Box2> strips) {
    for (Box2& box : strips) {
      box.min[1] = -infinity;
      box.max[1] = infinity;
    }
    return strips;
  };
  const std::vector<std::pair<std::vector<Box2>, std::vector<Box2>>> spoilt = {
      {spread(rng, size, 1000, 1000), spread(rng, size, 1000, 1000)},
      {spread(rng, size, 1000, 1000), spread(rng, size, 8, 8)},
      {endless(spread(rng, size, 1e6F, 10)), endless(spread(rng, size, 1e6F, 10))},
  };
  for (const auto& [before, after] : spoilt) {
    auto fresh = index_of(before);
    EXPECT_EQ(taken(fresh, {.boxes = after, .changed = all}), 2 * size) << "moved, and then built";
    EXPECT_EQ(taken(fresh, {.boxes = before, .changed = all}), size) << "built at once";
  }
}

template <int D, typename Real>
void expect_answers_after_moves() {
  Rng rng{D};
  std::vector<Box<D, Real>> boxes(700);
  std::vector<BoxId> all;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (int axis = 0; axis < D; ++axis) {
      boxes[i].min[axis] = static_cast<Real>(rng.below(3000)) / 7;
      boxes[i].max[axis] = boxes[i].min[axis] + static_cast<Real>(rng.below(3) * 5);
    }
    all.push_back(BoxId(i));
  }
  BoxIndex<D, Real> index;
  index.update({.boxes = boxes});
  for (int frame = 0; frame < 40; ++frame) {
    for (Box<D, Real>& box : boxes) {
      if (!is_present(box)) continue;
      for (int axis = 0; axis < D; ++axis) {
        // In places that only doubles tell apart, and in time far from where the tree was built.
        const Real step =
            static_cast<Real>(rng.below(1000)) / 977 + static_cast<Real>(frame % 10 == 9 ? 1e5 : 0);
        box.min[axis] += step;
        box.max[axis] += step;
      }
      if (rng.one_in(300)) box = absent_box<D, Real>();
    }
    index.update({.boxes = boxes, .changed = all});
    for (int query = 0; query < 8; ++query) {
      const Box<D, Real> where = boxes[rng.below(boxes.size())];
      if (!is_present(where)) continue;
      std::vector<BoxId> expected;
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (is_present(boxes[i]) && overlap(boxes[i], where)) expected.push_back(BoxId(i));
      }
      std::vector<BoxId> found;
      index.overlapping(where, [&found](BoxId id) { found.push_back(id); });
      std::ranges::sort(found);
      EXPECT_EQ(found, expected) << "frame " << frame;
    }
  }
}

TEST(BoxIndex, AnswersRightlyAfterAllBoxesMoved) {
  expect_answers_after_moves<2, float>();
  expect_answers_after_moves<3, float>();
  expect_answers_after_moves<2, double>();
  expect_answers_after_moves<3, double>();
}

TEST(BoxIndex, TakesWhatChangedAmongManyAbsentBoxes) {
  for (const std::size_t size : {2000U, 200'000U}) {
    std::vector<Box2> boxes = row(size);
    auto index = index_of(boxes);
    std::ranges::fill(boxes, absent_box<2>());
    std::vector<BoxId> changed;
    for (std::size_t i = 0; i < size; ++i) changed.push_back(BoxId(i));
    index.update({.boxes = boxes, .changed = changed});
    changed.resize(20);
    std::uint64_t all = 0;
    for (int frame = 0; frame < 400; ++frame) {
      for (const BoxId id : changed) {
        const auto at = static_cast<float>(frame % 7 * 100 + static_cast<int>(id));
        boxes[static_cast<std::size_t>(id)] = frame % 5 == 4 ? absent_box<2>() : Box2{{at, 0}, {at + 1, 1}};
      }
      all += taken(index, {.boxes = boxes, .changed = changed});
    }
    EXPECT_LE(all, 400U * changed.size() * 50) << size << " places";
  }
}

}  // namespace
}  // namespace broadside
