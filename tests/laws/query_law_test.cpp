// The law of queries: whatever the boxes and their history, an index answers as the definitions do.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <ostream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/index.hpp"

#include "hard_inputs.hpp"
#include "lab/scenes/scene.hpp"
#include "law_case.hpp"
#include "tests/support/rng.hpp"
#include "tracker_histories.hpp"

namespace broadside {

template <typename Real>
void PrintTo(const Hit<Real>& hit, std::ostream* out) {
  *out << "box " << index(hit.box) << " at " << hit.t_enter;
}

void PrintTo(const Neighbour& neighbour, std::ostream* out) {
  *out << "box " << index(neighbour.box) << " at the square of " << std::sqrt(neighbour.distance_squared);
}

namespace laws {
namespace {

template <int Dimension, typename Coordinate>
struct QueryCase {
  static constexpr int dimension = Dimension;
  using Real = Coordinate;
};

template <typename Case>
class QueryLaw : public testing::Test {
 protected:
  static constexpr int D = Case::dimension;
  using Real = typename Case::Real;
  using Point = std::array<Real, D>;
  using Cast = BoxCast<D, Real>;
  using Boxes = std::vector<Box<D, Real>>;

  /// The box, in double with bits that a float does not have.
  Box<D, Real> real(const Box<D>& box) {
    Box<D, Real> result;
    for (int axis = 0; axis < D; ++axis) {
      result.min[axis] = box.min[axis];
      result.max[axis] = box.max[axis];
      if constexpr (std::is_same_v<Real, double>) {
        if (!std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis])) continue;
        const double wider = rng_.one_in(2) ? 0 : 0x1p-26;
        result.min[axis] -= rng_.unit() * wider * std::abs(result.min[axis]);
        result.max[axis] += rng_.unit() * wider * std::abs(result.max[axis]);
        result.min[axis] *= unit_[axis];
        result.max[axis] *= unit_[axis];
      }
    }
    return result;
  }

  Boxes real(const std::vector<Box<D>>& boxes) {
    Boxes result;
    for (const Box<D>& box : boxes) result.push_back(real(box));
    return result;
  }

  /// A coordinate where something happens: one that a box has, or close to it.
  Real coordinate(const Boxes& boxes, int axis) {
    if (boxes.empty() || rng_.one_in(8)) return rng_.between(-12, 12) * unit_[axis];
    const Box<D, Real>& box = boxes[rng_.below(boxes.size())];
    const Real at = rng_.one_in(2) ? box.min[axis] : box.max[axis];
    if (rng_.one_in(4)) return at + rng_.between(-1, 1) * unit_[axis];
    if (rng_.one_in(8)) return std::nextafter(at, Real(rng_.one_in(2) ? -1e30 : 1e30));
    return at;
  }

  Real finite(const Boxes& boxes, int axis) {
    const Real at = coordinate(boxes, axis);
    return std::isfinite(at) ? at : Real(rng_.whole(-3, 3));
  }

  Box<D, Real> any_box(const Boxes& boxes) {
    if (!boxes.empty() && rng_.one_in(3)) return boxes[rng_.below(boxes.size())];
    Box<D, Real> box;
    for (int axis = 0; axis < D; ++axis) {
      const Real a = coordinate(boxes, axis);
      const Real b = rng_.one_in(4) ? a : coordinate(boxes, axis);
      box.min[axis] = std::min(a, b);
      box.max[axis] = std::max(a, b);
    }
    return box;
  }

  /// Rays and casts that graze corners and edges, run in planes, stand still, or are very long or short.
  Cast any_cast(const Boxes& boxes) {
    constexpr bool is_float = std::is_same_v<Real, float>;
    static const std::vector<Real> lengths = {1,
                                              Real(3),
                                              Real(-0.1),
                                              Real(1e-20),
                                              Real(is_float ? 1e-40 : 1e-310),
                                              Real(is_float ? 3e38 : 1e308),
                                              Real(1e30),
                                              std::numeric_limits<Real>::denorm_min()};
    Cast cast;
    const Real length = rng_.one_in(3) ? lengths[rng_.below(lengths.size())] : 1;
    const std::size_t way = rng_.below(4);
    const int along = rng_.whole(0, D - 1);
    for (int axis = 0; axis < D; ++axis) {
      const Real from = finite(boxes, axis);
      const Real to = finite(boxes, axis);
      Real direction = 0;
      if (way == 0) direction = std::isfinite(to - from) ? to - from : 1;
      if (way == 1) direction = axis == along ? Real(rng_.one_in(2) ? 1 : -1) : Real(0);
      if (way == 2) direction = Real(rng_.whole(-3, 3));
      if (way == 3) direction = rng_.between(-1, 1) * (rng_.one_in(4) ? Real(1e-12) : Real(1));
      direction *= length;
      cast.direction[axis] = std::isfinite(direction) ? direction : 1;
      cast.box.min[axis] = cast.box.max[axis] = from;
    }
    if (rng_.one_in(2)) {
      for (int axis = 0; axis < D; ++axis) {
        cast.box.max[axis] = finite(boxes, axis);
        if (rng_.one_in(2)) cast.box.max[axis] = cast.box.min[axis] + Real(rng_.whole(0, 2));
        if (cast.box.min[axis] > cast.box.max[axis]) std::swap(cast.box.min[axis], cast.box.max[axis]);
      }
    }
    if (rng_.one_in(3)) cast.t_max = Real(rng_.whole(0, 4)) / Real(rng_.whole(1, 3));
    if (rng_.one_in(9)) cast.t_max *= 100;
    cast.entering = rng_.one_in(3);
    return cast;
  }

  /// Asks all kinds of queries and compares the answers with the definitions.
  void expect_answers(const BoxIndex<D, Real>& index, const Boxes& boxes, const std::vector<Filter>& filters,
                      std::size_t rounds) {
    Filter query_filter{.category = 2, .mask = 1};
    for (std::size_t round = 0; round < rounds; ++round) {
      const Filter* const filter = rng_.one_in(4) ? &query_filter : nullptr;
      const std::optional<BoxId> except =
          rng_.one_in(4) ? std::optional(BoxId(rng_.below(boxes.size() + 2))) : std::nullopt;
      const auto counts = [&](std::size_t i) {
        const Filter own = filters.empty() ? Filter{} : filters[i];
        return is_present(boxes[i]) && except != BoxId(i) && (filter == nullptr || accepts(*filter, own));
      };
      expect_overlapping(index, boxes, any_box(boxes), filter, except, counts);
      expect_met(index, boxes, any_cast(boxes), filter, except, counts);
      Point point;
      for (int axis = 0; axis < D; ++axis) point[axis] = coordinate(boxes, axis);
      expect_nearest(index, boxes, point, filter, except, counts);
      expect_nearest(index, boxes, any_box(boxes), filter, except, counts);
      if (this->HasFailure()) return;
    }
    expect_nearest_of_each(index, boxes, filters);
  }

  template <typename Counts>
  void expect_overlapping(const BoxIndex<D, Real>& index, const Boxes& boxes, const Box<D, Real>& box,
                          const Filter* filter, std::optional<BoxId> except, Counts counts) {
    std::vector<BoxId> expected;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (counts(i) && is_present(box) && overlap(boxes[i], box)) expected.push_back(BoxId(i));
    }
    std::vector<BoxId> found;
    EXPECT_TRUE(index.overlapping(box, [&found](BoxId id) { found.push_back(id); }, {filter, except}));
    std::ranges::sort(found);
    EXPECT_EQ(found, expected) << "overlapping a box from " << testing::PrintToString(box.min) << " to "
                               << testing::PrintToString(box.max);
  }

  template <typename Counts>
  void expect_met(const BoxIndex<D, Real>& index, const Boxes& boxes, const Cast& cast, const Filter* filter,
                  std::optional<BoxId> except, Counts counts) {
    std::vector<Hit<Real>> expected;
    std::optional<Hit<Real>> first;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const std::optional<Real> enter = counts(i) ? t_enter(cast, boxes[i]) : std::nullopt;
      if (!enter) continue;
      expected.push_back({BoxId(i), *enter});
      if (!first || *enter < first->t_enter) first = expected.back();
    }
    std::vector<Hit<Real>> found;
    EXPECT_TRUE(index.hits(cast, [&found](Hit<Real> hit) { found.push_back(hit); }, {filter, except}));
    std::ranges::sort(found, {}, &Hit<Real>::box);
    const auto shown = [&cast] {
      return "cast from " + testing::PrintToString(cast.box.min) + " to " +
             testing::PrintToString(cast.box.max) + " along " + testing::PrintToString(cast.direction) +
             " up to " + testing::PrintToString(cast.t_max) + (cast.entering ? ", entering" : "");
    };
    EXPECT_EQ(found, expected) << shown();
    EXPECT_EQ(index.first_hit(cast, {filter, except}), first) << shown();
  }

  /// The nearest boxes by the definition.
  template <typename Counts>
  std::vector<Neighbour> nearest(const Boxes& boxes, const Box<D, Real>& from, std::size_t count,
                                 double max_distance, Counts counts) {
    std::vector<Neighbour> expected;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (!is_present(from) || !counts(i)) continue;
      const double distance = distance_squared(from, boxes[i]);
      if (distance <= max_distance * max_distance) expected.push_back({BoxId(i), distance});
    }
    // Equal distances in order of ids.
    const auto by_distance = [](const Neighbour& one) { return std::pair(one.distance_squared, one.box); };
    const std::size_t size = std::min(count, expected.size());
    std::ranges::partial_sort(expected, expected.begin() + static_cast<std::ptrdiff_t>(size), {},
                              by_distance);
    expected.resize(size);
    return expected;
  }

  static Box<D, Real> box_of(const Point& point) { return {point, point}; }
  static Box<D, Real> box_of(const Box<D, Real>& box) { return box; }

  template <typename PointOrBox, typename Counts>
  void expect_nearest(const BoxIndex<D, Real>& index, const Boxes& boxes, const PointOrBox& from,
                      const Filter* filter, std::optional<BoxId> except, Counts counts) {
    const std::size_t count = rng_.one_in(10) ? boxes.size() : rng_.below(12);
    const double max_distance = any_distance(boxes, box_of(from).min);
    const auto expected = nearest(boxes, box_of(from), count, max_distance, counts);
    std::vector<Neighbour> found = {{BoxId(7), 7}};
    index.nearest(from, count, found, {filter, except, max_distance});
    EXPECT_EQ(found, expected) << "nearest to " << testing::PrintToString(box_of(from).min) << " within "
                               << max_distance;
    EXPECT_EQ(index.nearest(from, count, {filter, except, max_distance}), expected);
  }

  void expect_nearest_of_each(const BoxIndex<D, Real>& index, const Boxes& boxes,
                              const std::vector<Filter>& filters) {
    // So many that they are searched in groups, by the number of boxes.
    const bool are_many = rng_.one_in(8) && boxes.size() <= 8192;
    Boxes queries(are_many ? 256 + rng_.below(345) : rng_.below(30));
    for (Box<D, Real>& query : queries) query = any_box(boxes);  // often one of `boxes`, which may be absent
    std::vector<Filter> of_queries(!are_many && rng_.one_in(3) ? queries.size() : 0);
    for (Filter& filter : of_queries) filter.mask = rng_.one_in(2) ? 1 : 3;
    std::vector<BoxId> except(rng_.one_in(2) ? queries.size() : 0);
    for (BoxId& id : except) id = rng_.one_in(4) ? no_box : BoxId(rng_.below(boxes.size() + 1));
    if (rng_.one_in(8) && boxes.size() <= 600) {
      // The index's own boxes, each without itself, but perhaps one moved.
      queries = boxes;
      of_queries.clear();
      except.resize(boxes.size());
      for (std::size_t i = 0; i < boxes.size(); ++i) except[i] = BoxId(i);
      if (!boxes.empty() && rng_.one_in(2)) queries[rng_.below(boxes.size())] = any_box(boxes);
    }
    const std::size_t count = are_many         ? 1 + rng_.below(31)
                              : rng_.one_in(5) ? boxes.size() + 1
                                               : 1 + rng_.below(12);
    const double max_distance = rng_.one_in(2) || queries.empty()
                                    ? std::numeric_limits<double>::infinity()
                                    : double{any_distance(boxes, queries[0].min)};
    std::vector<BoxId> found(count * queries.size());
    std::vector<double> distances(found.size());
    index.nearest_of_each(queries, count, found, distances,
                          {.max_distance = max_distance,
                           .filters = of_queries,
                           .except = except,
                           .workers = {.threads = 2, .boxes_per_thread = 1}});
    for (std::size_t query = 0; query < queries.size(); ++query) {
      const auto counts = [&](std::size_t i) {
        return is_present(boxes[i]) && (except.empty() || except[query] != BoxId(i)) &&
               (of_queries.empty() || accepts(of_queries[query], filters.empty() ? Filter{} : filters[i]));
      };
      std::vector<Neighbour> expected = nearest(boxes, queries[query], count, max_distance, counts);
      expected.resize(count, {no_box, std::numeric_limits<double>::infinity()});
      std::vector<Neighbour> row;
      for (std::size_t i = query * count; i < (query + 1) * count; ++i)
        row.push_back({found[i], distances[i]});
      EXPECT_EQ(row, expected) << "query " << query << " of " << queries.size();
    }
  }

  /// A greatest distance: often none, or the very distance along an axis from the point to a box.
  Real any_distance(const Boxes& boxes, const Point& point) {
    if (rng_.one_in(2)) return std::numeric_limits<Real>::infinity();
    if (boxes.empty() || rng_.one_in(3)) return Real(rng_.whole(0, 3)) * unit_[0];
    const auto axis = static_cast<std::size_t>(rng_.whole(0, D - 1));
    const Real distance = std::abs(boxes[rng_.below(boxes.size())].min[axis] - point[axis]);
    return std::isnan(distance) ? 0 : distance;
  }

  Rng rng_{1};
  std::array<Real, 3> unit_ = {1, 1, 1};  // by axis
};

using Kinds =
    testing::Types<QueryCase<2, float>, QueryCase<3, float>, QueryCase<2, double>, QueryCase<3, double>>;

class KindNames {
 public:
  template <typename Case>
  static std::string GetName(int) {  // NOLINT(readability-identifier-naming): GoogleTest's name
    return std::to_string(Case::dimension) + (std::is_same_v<typename Case::Real, float> ? "d" : "d_double");
  }
};

TYPED_TEST_SUITE(QueryLaw, Kinds, KindNames);

TYPED_TEST(QueryLaw, HoldsForHardInputs) {
  for (const auto& [name, floats] : hard_inputs<TestFixture::D>(Algorithm{})) {
    const typename TestFixture::Boxes boxes = this->real(floats);
    BoxIndex<TestFixture::D, typename TestFixture::Real> index;
    index.update({.boxes = boxes, .changed = {}});
    this->expect_answers(index, boxes, {}, reduced(60, 1));
    ASSERT_FALSE(this->HasFailure()) << name;
  }
}

/// Beyond what floats hold, and with axes that differ by far: what a double's tree holds is scaled.
TYPED_TEST(QueryLaw, HoldsAtEveryScale) {
  if constexpr (std::is_same_v<typename TestFixture::Real, double>) {
    constexpr std::array<std::array<double, 3>, 6> units = {{{1e60, 1e60, 1e60},
                                                             {1e-60, 1e-60, 1e-60},
                                                             {1e60, 1e-60, 1},
                                                             {1e-160, 1e160, 1e-160},
                                                             {1e-300, 1e-300, 1e-300},
                                                             {1e300, 1e300, 1}}};
    for (const std::array<double, 3>& unit : units) {
      this->unit_ = unit;
      for (const auto& [name, floats] : hard_inputs<TestFixture::D>(Algorithm{})) {
        const typename TestFixture::Boxes boxes = this->real(floats);
        BoxIndex<TestFixture::D, double> index;
        index.update({.boxes = boxes, .changed = {}});
        this->expect_answers(index, boxes, {}, reduced(20, 1));
        ASSERT_FALSE(this->HasFailure()) << name << ", " << unit[0] << ", " << unit[1];
      }
    }
  }
}

TYPED_TEST(QueryLaw, HoldsForScenes) {
  constexpr int dimension = TestFixture::D;
  for (const lab::Scene& scene : lab::scenes()) {
    if (!scene.has_dimension(dimension)) continue;
    // A recording of many bodies takes longer to make than to search.
    const std::size_t count = scene.kind == lab::SceneKind::recorded ? 200 : reduced(1000);
    const auto history = lab::make_history<dimension>(scene, {scene.name, {}}, {.boxes = count});
    if (history.boxes.size() > 20'000) continue;
    const typename TestFixture::Boxes boxes = this->real(history.boxes);
    BoxIndex<dimension, typename TestFixture::Real> index;
    index.update({.boxes = boxes, .changed = {}});
    this->expect_answers(index, boxes, {}, reduced(20, 1));
    ASSERT_FALSE(this->HasFailure()) << scene.name;
  }
}

TYPED_TEST(QueryLaw, HoldsAfterHistories) {
  constexpr int dimension = TestFixture::D;
  for (const auto& [name, frames] : drawn_histories<dimension>(Algorithm{})) {
    typename TestFixture::Boxes boxes = this->real(frames[0].boxes);
    std::vector<Filter> filters(boxes.size());
    const bool has_filters = this->rng_.one_in(2);
    BoxIndex<dimension, typename TestFixture::Real> index;
    const auto update = [&](const std::vector<BoxId>& changed) {
      index.update({.boxes = boxes,
                    .changed = changed,
                    .filters = std::span(filters).first(has_filters ? filters.size() : 0)});
      this->expect_answers(index, boxes, has_filters ? filters : std::vector<Filter>{}, 2);
    };
    update({});
    for (std::size_t frame = 1; frame < frames.size(); ++frame) {
      const WholeFrame<dimension>& now = frames[frame];
      const std::vector<BoxId> changed = changed_places(frames[frame - 1], now);
      for (std::size_t place = boxes.size(); place < now.boxes.size(); ++place)
        boxes.push_back(this->real(now.boxes[place]));
      boxes.resize(now.boxes.size());
      filters.resize(now.boxes.size());
      for (const BoxId id : changed) {
        const std::size_t place = broadside::index(id);
        if (place >= boxes.size()) continue;
        boxes[place] = this->real(now.boxes[place]);
        filters[place].category = this->rng_.one_in(2) ? 1 : 2;
      }
      update(changed);
      ASSERT_FALSE(this->HasFailure()) << name;
    }
  }
}

/// Few of many boxes change in a frame, so that none of them is built anew: they jump, drift, go and come.
TYPED_TEST(QueryLaw, HoldsAfterManySmallChanges) {
  constexpr int dimension = TestFixture::D;
  for (const int way : {0, 1, 2, 3}) {
    Rng rng(5);
    const auto anywhere = [&rng, way] {
      Box<dimension, typename TestFixture::Real> box;
      for (int axis = 0; axis < dimension; ++axis) {
        box.min[axis] = way == 3 ? typename TestFixture::Real(rng.whole(0, 9)) : rng.between(0, 40);
        box.max[axis] =
            box.min[axis] + (way == 3 ? typename TestFixture::Real(rng.whole(0, 1)) : rng.between(0, 3));
      }
      return box;
    };
    typename TestFixture::Boxes boxes(reduced(1500, 1));
    std::ranges::generate(boxes, anywhere);
    BoxIndex<dimension, typename TestFixture::Real> index;
    index.update({.boxes = boxes, .changed = {}});
    for (std::size_t frame = 0; frame < reduced(150, 1); ++frame) {
      std::vector<BoxId> changed;
      // Whole regions empty and fill in the second way.
      for (std::size_t k = 0; k < boxes.size() / 10; ++k) {
        const std::size_t i = way == 1 ? (frame * 97 + k) % boxes.size() : rng.below(boxes.size());
        Box<dimension, typename TestFixture::Real>& box = boxes[i];
        changed.push_back(BoxId(i));
        if (way == 1) {
          box = is_present(box) ? absent_box<dimension, typename TestFixture::Real>() : anywhere();
        } else if (way == 2 && is_present(box)) {
          const typename TestFixture::Real step = rng.between(-2, 2);
          const int axis = rng.whole(0, dimension - 1);
          box.min[axis] += step;
          box.max[axis] += step;
        } else {
          box = anywhere();
        }
      }
      index.update({.boxes = boxes, .changed = changed});
      if (frame % 5 == 0) this->expect_answers(index, boxes, {}, 3);
      ASSERT_FALSE(this->HasFailure()) << "frame " << frame << ", way " << way;
    }
  }
}

}  // namespace
}  // namespace laws
}  // namespace broadside
