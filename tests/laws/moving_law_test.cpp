// The law of moving boxes: pairs overlap at some time of the step, by a definition in whole numbers, where
// contacts tie, and at every scale.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/moving.hpp"

#include "law_case.hpp"
#include "pair_reference.hpp"
#include "tests/support/boxes.hpp"
#include "tests/support/drawn_boxes.hpp"
#include "tests/support/message.hpp"
#include "tests/support/model.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

/// A box of whole numbers at the beginning and at the end of the step.
template <int D>
using WholeBox = std::array<std::array<std::int64_t, 2 * D>, 2>;

template <int D>
std::vector<WholeBox<D>> drawn_boxes(Rng& rng, std::size_t count, int size, int extent) {
  std::vector<WholeBox<D>> boxes(count);
  for (WholeBox<D>& box : boxes) {
    const bool is_rigid = rng.one_in(2);
    for (int axis = 0; axis < D; ++axis) {
      const int length = rng.whole(0, extent);
      for (auto& end : box) {
        end[axis] = rng.whole(0, size);
        end[axis + D] = end[axis] + (is_rigid ? length : rng.whole(0, extent));
      }
    }
  }
  return boxes;
}

/// Whether all bounds overlap at the time p / q.
template <int D>
bool overlap_at(const WholeBox<D>& a, const WholeBox<D>& b, std::int64_t p, std::int64_t q) {
  const auto at = [p, q](const WholeBox<D>& box, int bound) {
    return box[0][bound] * (q - p) + box[1][bound] * p;
  };
  for (int axis = 0; axis < D; ++axis) {
    if (at(a, axis + D) < at(b, axis) || at(b, axis + D) < at(a, axis)) return false;
  }
  return true;
}

/// The definition: two boxes overlap at some time if they do at one at which two of their bounds meet, or at
/// the beginning or the end.
template <int D>
bool overlap_at_some_time(const WholeBox<D>& a, const WholeBox<D>& b) {
  if (overlap_at<D>(a, b, 0, 1) || overlap_at<D>(a, b, 1, 1)) return true;
  for (int axis = 0; axis < D; ++axis) {
    for (const auto& [low, high] : {std::array{axis, axis + D}, std::array{axis + D, axis}}) {
      const std::int64_t begin = a[0][low] - b[0][high];
      const std::int64_t end = a[1][low] - b[1][high];
      if ((begin < 0) == (end < 0) || begin == end) continue;
      if (overlap_at<D>(a, b, std::abs(begin), std::abs(begin - end))) return true;
    }
  }
  return false;
}

template <int D, typename Real>
Boxes<D, Real> ends_of(const std::vector<WholeBox<D>>& whole, std::size_t end, int exponent) {
  Boxes<D, Real> boxes(whole.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (int axis = 0; axis < D; ++axis) {
      const auto scaled = [&](int bound) {
        return static_cast<Real>(std::ldexp(static_cast<double>(whole[i][end][bound]), exponent));
      };
      boxes[i].min[axis] = scaled(axis);
      boxes[i].max[axis] = scaled(axis + D);
    }
  }
  return boxes;
}

class MovingLaw : public Law {
 protected:
  FindOptions options() const { return {.algorithm = spec()}; }

  template <int D, typename Real>
  void find_whole(Rng& rng, std::size_t count, int size, int extent, int exponent) {
    const std::vector<WholeBox<D>> whole = drawn_boxes<D>(rng, count, size, extent);
    const Boxes<D, Real> from = ends_of<D, Real>(whole, 0, exponent);
    const Boxes<D, Real> to = ends_of<D, Real>(whole, 1, exponent);
    const auto overlaps = [&](std::size_t i, std::size_t j) {
      return overlap_at_some_time<D>(whole[i], whole[j]);
    };
    EXPECT_EQ(sorted(find_pairs_moving(from, to, options())), reference(count, 0, overlaps));
    const std::size_t left = count / 3;
    const std::span<const Box<D, Real>> begins = from;
    const std::span<const Box<D, Real>> ends = to;
    EXPECT_EQ(sorted(find_pairs_moving(begins.first(left), ends.first(left), begins.subspan(left),
                                       ends.subspan(left), options())),
              reference(count, left, overlaps));
  }

  template <int D, typename Real>
  void find_anywhere(Rng& rng, std::size_t count) {
    Boxes<D, Real> from(count);
    Boxes<D, Real> to(count);
    for (std::size_t i = 0; i < count; ++i) {
      from[i] = rng.one_in(20) ? absent_box<D, Real>() : box_of_any_floats<D, Real>(rng);
      to[i] = rng.one_in(20) ? absent_box<D, Real>() : box_of_any_floats<D, Real>(rng);
    }
    const auto overlaps = [&](std::size_t i, std::size_t j) {
      return is_present(from[i]) && is_present(to[i]) && is_present(from[j]) && is_present(to[j]) &&
             overlap_time(from[i], to[i], from[j], to[j]).has_value();
    };
    const std::vector<Pair> pairs = sorted(find_pairs_moving(from, to, options()));
    EXPECT_EQ(pairs, reference(count, 0, overlaps));
    for (const OverlapTime& time : overlap_times(from, to, pairs)) {
      EXPECT_LE(0, time.enter);
      EXPECT_LE(time.enter, time.leave);
      EXPECT_LE(time.leave, 1);
    }
  }
};

TEST_P(MovingLaw, FindsEachPairOfWholeNumbers) {
  in_dimension([&]<int D>() {
    Rng rng(1);
    for (const int exponent : {0, -149, 100}) find_whole<D, float>(rng, reduced(120), 24, 3, exponent);
    for (const int exponent : {0, -1000, -545, 520, 1018})
      find_whole<D, double>(rng, reduced(120), 24, 3, exponent);
    find_whole<D, float>(rng, reduced(120), 1 << 23, 1 << 21, 0);
    find_whole<D, double>(rng, reduced(120), 1 << 23, 1 << 21, 0);
  });
}

TEST_P(MovingLaw, FindsEachPairOfAnyNumbers) {
  in_dimension([&]<int D>() {
    Rng rng(2);
    find_anywhere<D, float>(rng, reduced(100));
    find_anywhere<D, double>(rng, reduced(100));
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, MovingLaw, testing::ValuesIn(cases_of(algorithms())), case_name);

TEST(OverlapTime, IsWhenBothBoxesAreAtOnePlace) {
  const Box2 unit{{0, 0}, {1, 1}};
  const auto moved = [&unit](float x, float y) { return translated(unit, {x, y}); };
  EXPECT_EQ(overlap_time(unit, unit, moved(3, 0), moved(-3, 0)), (OverlapTime{1 / 3.0, 2 / 3.0}));
  EXPECT_EQ(overlap_time(unit, unit, moved(0.5f, 0), moved(8.5f, 0)), (OverlapTime{0, 1 / 16.0}));
  EXPECT_EQ(overlap_time(unit, unit, moved(1, 0), moved(2, 0)), (OverlapTime{0, 0})) << "touching at first";
  EXPECT_EQ(overlap_time(unit, unit, moved(2, 5), moved(1, 0)), (OverlapTime{1, 1})) << "touching at last";
  EXPECT_EQ(overlap_time(unit, unit, moved(1, -3), moved(1, 5)), (OverlapTime{0.25, 0.5})) << "along a face";
  EXPECT_EQ(overlap_time(unit, unit, moved(-1, 3), moved(3, -1)), (OverlapTime{0.5, 0.5})) << "a corner";
  EXPECT_EQ(overlap_time(unit, unit, moved(-1, 3), moved(3, -0.875f)), std::nullopt) << "past the corner";
  EXPECT_EQ(overlap_time(moved(0, 0), moved(9, 0), moved(0, 0), moved(9, 0)), (OverlapTime{0, 1}));
  EXPECT_EQ(overlap_time(moved(0, 0), moved(9, 0), moved(9, 3), moved(0, 3)), std::nullopt);
  // The swept boxes overlap; one is gone before the other comes.
  EXPECT_EQ(overlap_time(moved(0, 0), moved(9, 0), moved(8, 3), moved(8, -30)), std::nullopt);
}

TEST(OverlapTime, TakesABoundThatIsInfiniteAtOneTimeAsSoAllTheTime) {
  const Box2 unit{{0, 0}, {1, 1}};
  const Box2 half_space{{-infinity, -infinity}, {-5, infinity}};
  const Box2 narrow{{-7, 0}, {-5, 1}};
  EXPECT_EQ(overlap_time(half_space, half_space, unit, unit), std::nullopt);
  EXPECT_EQ(overlap_time(half_space, translated(half_space, {10, 0}), unit, unit), (OverlapTime{0.5, 1}));
  EXPECT_EQ(overlap_time(half_space, narrow, narrow, translated(narrow, {-20, 0})), (OverlapTime{0, 1}));
}

TEST(FindPairsMoving, LeavesOutWhatPassesOneAfterTheOther) {
  const std::vector<Box2> from = {{{0, 0}, {1, 1}}, {{4, 3}, {5, 4}}, {{9, 0}, {10, 1}}, absent_box<2>()};
  const std::vector<Box2> to = {{{9, 0}, {10, 1}}, {{4, -30}, {5, -29}}, {{0, 0}, {1, 1}}, {{0, 0}, {9, 9}}};
  EXPECT_EQ(find_pairs_moving(from, to), (std::vector<Pair>{{BoxId(0), BoxId(2)}}));
  EXPECT_EQ(overlap_times(from, to, std::vector<Pair>{{BoxId(0), BoxId(2)}, {BoxId(0), BoxId(3)}}),
            (std::vector<OverlapTime>{{4 / 9.0, 5 / 9.0}, {infinity, -infinity}}));
  EXPECT_EQ(find_pairs_moving(from, to, {.filters = std::vector<Filter>(4, Filter{.group = -1})}).size(), 0u);
}

TEST(FindPairsMoving, RefusesWhatItCannotTake) {
  const std::vector<Box2> one = {{{0, 0}, {1, 1}}};
  std::vector<Box2> two = {{{0, 0}, {1, 1}}, {{2, 2}, {1, 1}}};
  const auto message = [&](const auto& from, const auto& to, const FindOptions& options = {}) {
    return message_of<std::invalid_argument>(
        [&] { static_cast<void>(find_pairs_moving(from, to, options)); });
  };
  EXPECT_EQ(message(two, one), "1 boxes at the end of a step that begins with 2; expected as many");
  EXPECT_EQ(message(one, one, {.touching = false}), "touching is false for moving boxes; expected true");
  EXPECT_THAT(message(std::vector<Box2>{one[0], one[0]}, two), testing::HasSubstr("box 1"));
  std::vector<BoxId> quarantined;
  EXPECT_EQ(find_pairs_moving(two, std::vector<Box2>{one[0], one[0]}, {.quarantined = &quarantined}).size(),
            0u);
  EXPECT_EQ(quarantined, std::vector<BoxId>{BoxId(1)});
  EXPECT_THROW(static_cast<void>(overlap_times(one, one, std::vector<Pair>{{BoxId(0), BoxId(1)}})),
               InvalidFrame);
}

}  // namespace
}  // namespace broadside::laws
