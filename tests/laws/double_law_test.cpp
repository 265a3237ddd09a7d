// The law for boxes of doubles: the pairs of brute force in double, through every algorithm.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"
#include "broadside/world.hpp"

#include "hard_inputs.hpp"
#include "law_case.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

template <int D>
std::vector<Pair> reference(const DoubleBoxes<D>& boxes) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size(); ++j) {
      if (is_present(boxes[i]) && is_present(boxes[j]) && overlap(boxes[i], boxes[j]))
        pairs.push_back({BoxId(i), BoxId(j)});
    }
  }
  return pairs;
}

template <int D>
struct DoubleInput {
  std::string name;
  DoubleBoxes<D> boxes;
};

/// Boxes of about `extent` whose centres lie within `range` of one of `sites`, on every axis.
template <int D>
DoubleBoxes<D> boxes_at(Rng& rng, std::size_t count, const std::vector<double>& sites, double range,
                        double extent) {
  DoubleBoxes<D> boxes(count);
  for (Box<D, double>& box : boxes) {
    const double site = sites[rng.below(sites.size())];
    for (int axis = 0; axis < D; ++axis) {
      // 24 random bits and, far below them, others: more than a float holds.
      const double centre = site + range * (rng.unit() + rng.unit() * 0x1p-24);
      box.min[axis] = centre - extent * (rng.unit() + rng.unit() * 0x1p-24);
      box.max[axis] = centre + extent * (rng.unit() + rng.unit() * 0x1p-24);
    }
  }
  return boxes;
}

/// A row of boxes at each of `sites`, several at each place, that touch their neighbours, or overlap or miss
/// them by the last bit of a double: as floats they all touch.
template <int D>
DoubleBoxes<D> lattice(Rng& rng, std::size_t count, const std::vector<double>& sites) {
  const auto nearly = [&rng](double at) {
    return std::array{std::nextafter(at, -1e10), at, std::nextafter(at, 1e10)}[rng.below(3)];
  };
  DoubleBoxes<D> boxes(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double site = sites[i % sites.size()];
    for (int axis = 0; axis < D; ++axis) {
      const auto step = static_cast<double>(axis == 0 ? i / sites.size() / 24 : rng.below(3));
      boxes[i].min[axis] = nearly(site + step * 0.1);
      boxes[i].max[axis] = nearly(site + (step + 1) * 0.1);
    }
  }
  return boxes;
}

/// The boxes with each axis in a unit of its own.
template <int D>
DoubleBoxes<D> scaled(DoubleBoxes<D> boxes, const std::array<double, 3>& units) {
  for (Box<D, double>& box : boxes) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] *= units[axis];
      box.max[axis] *= units[axis];
    }
  }
  return boxes;
}

/// Boxes for which one scale does not serve, since floats about one origin hold only some of them.
template <int D>
void add_scales(Rng& rng, std::size_t count, std::vector<DoubleInput<D>>& inputs) {
  constexpr double largest = std::numeric_limits<double>::max();
  constexpr double smallest = std::numeric_limits<double>::denorm_min();
  const double side = std::pow(static_cast<double>(count), 1.0 / D);
  const auto near = [&] { return boxes_at<D>(rng, count, {0}, side, 0.6); };
  inputs.push_back({"axes of different units", scaled<D>(near(), {1e60, 1e-60, 1})});
  inputs.push_back({"up to the greatest double", scaled<D>(near(), std::array{largest, largest, largest})});
  DoubleBoxes<D> denormals = near();
  for (Box<D, double>& box : denormals) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = std::floor(8 * box.min[axis]) * smallest;
      box.max[axis] = std::floor(8 * box.max[axis]) * smallest;
    }
  }
  inputs.push_back({"denormals", denormals});
  DoubleBoxes<D> powers(count);
  for (Box<D, double>& box : powers) {
    for (int axis = 0; axis < D; ++axis) {
      const double at = std::pow(10, 60 * rng.unit() - 30);
      box.min[axis] = rng.one_in(2) ? at : -at;
      box.max[axis] = box.min[axis] + (rng.one_in(2) ? at : 1e-3 * at) * rng.unit();
    }
  }
  inputs.push_back({"sixty orders of magnitude", powers});
  DoubleBoxes<D> together = scaled<D>(near(), {1e60, 1e60, 1e60});
  for (const double unit : {1e-60, 1.0}) {
    const DoubleBoxes<D> others = scaled<D>(near(), {unit, unit, unit});
    together.insert(together.end(), others.begin(), others.end());
  }
  inputs.push_back({"units of 1e60, 1e-60 and 1 together", together});
  DoubleBoxes<D> nested = boxes_at<D>(rng, count, {0}, 1e-12 * side, 0.6e-12);
  for (Box<D, double>& box : nested) {
    for (int axis = 0; axis < D; ++axis) {
      const double site = rng.whole(0, 3) + 1e-4 * rng.whole(0, 3) + 1e-8 * rng.whole(0, 3);
      box.min[axis] += site;
      box.max[axis] += site;
    }
  }
  inputs.push_back({"clusters within clusters", nested});
}

template <int D>
std::vector<DoubleInput<D>> double_inputs(const Algorithm& algorithm) {
  Rng rng(21);
  const std::size_t count = reduced(1500);
  const double side = std::pow(static_cast<double>(count), 1.0 / D);
  std::vector<DoubleInput<D>> inputs = {
      {"none", {}},
      {"one", boxes_at<D>(rng, 1, {0}, 1, 1)},
      {"near the origin", boxes_at<D>(rng, count, {0}, side, 0.6)},
      {"a millimetre, at 5,000,000 m", boxes_at<D>(rng, count, {5e6}, side * 1e-3, 0.6e-3)},
      {"a millimetre, at sites 100 km apart",
       boxes_at<D>(rng, count, {500'000, 600'000, 5'000'000}, side * 1e-3, 0.6e-3)},
      {"below a float's range", boxes_at<D>(rng, count, {0, 1e-300}, side * 1e-300, 0.6e-300)},
      {"beyond a float's range", boxes_at<D>(rng, count, {-1e300, 1e300}, side * 1e299, 0.6e299)},
      {"all at one point", boxes_at<D>(rng, 300, {1e9}, 1e-3, 1)},
      {"points far apart", boxes_at<D>(rng, count, {0, 1e6, 1e12}, 1, 0)},
  };
  // Integers above 2^24 that touch: the last unit decides.
  DoubleBoxes<D> integers(count);
  for (Box<D, double>& box : integers) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = 1'000'000'000.0 + rng.whole(0, static_cast<int>(side) * 4);
      box.max[axis] = box.min[axis] + rng.whole(0, 3);
    }
  }
  inputs.push_back({"integers above 2^24", integers});
  // The same, but for the last bits of some.
  DoubleBoxes<D> short_above = integers;
  DoubleBoxes<D> short_below = integers;
  for (std::size_t i = 0; i < count; i += 3) {
    if (integers[i].min[0] == integers[i].max[0]) continue;
    short_above[i].max[0] = std::nextafter(integers[i].max[0], 0);
    short_below[i].min[0] = std::nextafter(integers[i].min[0], 2e9);
  }
  inputs.push_back({"integers and maxima just below", short_above});
  inputs.push_back({"integers and minima just above", short_below});
  inputs.push_back({"touching to the last bit", lattice<D>(rng, 600, {4.0e6 / 3})});
  // So far from each other that they are split, and that in the middle of the second.
  inputs.push_back({"touching at the border of regions", lattice<D>(rng, 1200, {-1e9, 4.0e6 / 3, 1e9})});
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    DoubleBoxes<D> boxes = boxes_at<D>(rng, 400, {1e6}, side, 1);
    for (std::size_t i = 0; i < boxes.size(); i += 13) boxes[i] = absent_box<D, double>();
    for (std::size_t i = 0; i < boxes.size(); i += 40)
      boxes[i].min.fill(-infinity), boxes[i].max.fill(infinity);
    boxes[5].min.fill(infinity), boxes[5].max.fill(infinity);
    boxes[6].min[0] = -infinity;
    boxes[7].max.fill(std::numeric_limits<double>::max());
    inputs.push_back({"infinite and absent boxes together", boxes});
  }
  add_scales<D>(rng, count / 2, inputs);
  std::erase_if(inputs, [&](const DoubleInput<D>& input) {
    return std::ranges::any_of(input.boxes,
                               [&](const Box<D, double>& box) { return is_beyond(algorithm, box); });
  });
  return inputs;
}

class DoubleLaw : public Law {};

TEST_P(DoubleLaw, FindsThePairsOfBruteForceInDouble) {
  in_dimension([&]<int D>() {
    Finder<D, double> finder(algorithm(), spec());
    for (const DoubleInput<D>& input : double_inputs<D>(algorithm())) {
      std::vector<Pair> pairs;
      PairCollector collector(pairs);
      finder.find(input.boxes, collector);
      std::ranges::sort(pairs);
      EXPECT_EQ(pairs, reference<D>(input.boxes)) << input.name;
    }
  });
}

TEST_P(DoubleLaw, FindsThePairsBetweenTwoSetsOfDoubles) {
  in_dimension([&]<int D>() {
    Finder<D, double> finder(algorithm(), spec());
    for (const DoubleInput<D>& input : double_inputs<D>(algorithm())) {
      const std::size_t half = input.boxes.size() / 2;
      const std::span<const Box<D, double>> boxes = input.boxes;
      std::vector<Pair> pairs;
      PairCollector collector(pairs);
      finder.find_between(boxes.first(half), boxes.subspan(half), collector);
      std::ranges::sort(pairs);
      std::vector<Pair> expected;
      for (const Pair pair : reference<D>(input.boxes)) {
        if (index(pair.first) < half && index(pair.second) >= half)
          expected.push_back({pair.first, BoxId(index(pair.second) - half)});
      }
      EXPECT_EQ(pairs, expected) << input.name;
    }
  });
}

/// Lets the tracker take a frame, and applies its events to the pairs that it told of before.
template <int D>
void take_frame(Tracker<D, double>& tracker, const DoubleBoxes<D>& boxes, std::span<const BoxId> changed,
                std::vector<Pair>& current) {
  std::vector<Pair> begun;
  std::vector<Pair> ended;
  PairCollector begun_pairs(begun);
  PairCollector ended_pairs(ended);
  tracker.update({boxes, changed}, begun_pairs, ended_pairs);
  std::vector<Pair> kept;
  std::ranges::set_difference(current, ended, std::back_inserter(kept));
  current.clear();
  std::ranges::merge(kept, begun, std::back_inserter(current));
}

TEST_P(DoubleLaw, TracksMovesSmallerThanAFloatCanTell) {
  in_dimension([&]<int D>() {
    Rng rng(22);
    DoubleBoxes<D> boxes = boxes_at<D>(rng, 200, {5e6}, 0.02, 1e-3);
    Tracker<D, double> tracker(algorithm(), spec());
    std::vector<Pair> current;
    for (int frame = 0; frame < 10; ++frame) {
      std::vector<BoxId> changed;
      for (std::size_t i = frame == 0 ? boxes.size() : 0; i < boxes.size(); i += 3) {
        changed.push_back(BoxId(i));
        for (int axis = 0; axis < D; ++axis) {
          const double step = 1e-4 * (rng.unit() - 0.5);
          boxes[i].min[axis] += step;
          boxes[i].max[axis] += step;
        }
      }
      take_frame<D>(tracker, boxes, changed, current);
      EXPECT_EQ(current, reference<D>(boxes)) << "frame " << frame;
    }
  });
}

/// Tracks boxes that rest, creep, jump, come, go, leave for other scales and grow beyond all bounds, some in
/// each frame.
template <int D>
void track_restless_boxes(const Algorithm& algorithm, const Spec& spec, double where, double unit) {
  Rng rng(24);
  DoubleBoxes<D> boxes = scaled<D>(boxes_at<D>(rng, 300, {where}, 0.05, 1e-3), {unit, unit, unit});
  const DoubleBoxes<D> first = boxes;
  Tracker<D, double> tracker(algorithm, spec);
  std::vector<Pair> current;
  for (int frame = 0; frame < 30; ++frame) {
    std::vector<BoxId> changed;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (frame > 0 && rng.unit() > 0.1) continue;
      changed.push_back(BoxId(i));
      const double kind = rng.unit();
      const double step = unit * (kind < 0.6 ? 1e-4 : 1e-2) * (rng.unit() - 0.5);
      if (!is_present(boxes[i])) boxes[i] = first[i];
      const double farther = kind > 0.9 && kind < 0.92 && algorithm.limits.infinite_boxes ? 1e30 : 1;
      for (int axis = 0; axis < D; ++axis) {
        boxes[i].min[axis] = farther * (boxes[i].min[axis] + step);
        boxes[i].max[axis] = farther * (boxes[i].max[axis] + step);
      }
      if (kind > 0.95) boxes[i] = absent_box<D, double>();
      if (kind < 0.02 && algorithm.limits.infinite_boxes)
        boxes[i].max.fill(std::numeric_limits<double>::infinity());
    }
    take_frame<D>(tracker, boxes, changed, current);
    ASSERT_EQ(current, reference<D>(boxes))
        << spec.text() << ", frame " << frame << ", at " << where << ", in " << unit;
  }
}

TEST_P(DoubleLaw, TracksBoxesThatRestCreepJumpComeAndGo) {
  in_dimension([&]<int D>() {
    for (const double unit : {1.0, 1e60, 1e-60, 1e-300}) {
      for (const double where : {0.0, 5e6}) {
        track_restless_boxes<D>(algorithm(), spec(), where, unit);
        if (algorithm().name == "auto")
          track_restless_boxes<D>(algorithm(), Spec("auto:update=follow"), where, unit);
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, DoubleLaw, testing::ValuesIn(law_cases_without_peers()), case_name);

TEST(Doubles, TakeFewTestsWhereFloatsAboutOneOriginAllTouch) {
  // Boxes of a millimetre at sites 100 km apart: as floats about one origin they would be 8 mm wide or
  // more.
  Rng rng(23);
  const std::size_t count = 20'000;
  const DoubleBoxes<2> boxes = boxes_at<2>(rng, count, {500'000, 600'000}, 0.1, 0.5e-3);
  Finder<2, double> finder("grid");
  PairCounter counter;
  const auto statistics = finder.find(boxes, counter);
  EXPECT_GT(counter.count(), 0u);
  ASSERT_TRUE(statistics.has_value());
  EXPECT_LT(statistics->tests, 20 * count);
}

TEST(Doubles, AreToldApartWhereFloatsAreEqual) {
  const std::vector<DoubleBox2> boxes = {{{0, 0}, {16777216, 1}}, {{16777217, 0}, {16777218, 1}}};
  EXPECT_TRUE(find_pairs(boxes).empty());
  const std::vector<Box2> floats = {{{0, 0}, {16777216.F, 1}}, {{16777217.F, 0}, {16777218.F, 1}}};
  EXPECT_EQ(find_pairs(floats).size(), 1u);
}

TEST(Doubles, AreRefusedAsFloatsAre) {
  const std::vector<DoubleBox2> boxes = {{{0, 0}, {1, 1}}, {{0, std::nan("")}, {1, 1}}};
  EXPECT_THROW(static_cast<void>(find_pairs(boxes)), InvalidInput);
}

TEST(Doubles, LiveInAWorld) {
  DoubleWorld2 world;
  const Handle a = world.add({{5e6, 0}, {5e6 + 1e-3, 1}});
  const Handle b = world.add({{5e6 + 1.5e-3, 0}, {5e6 + 2e-3, 1}});
  EXPECT_TRUE(world.update().begun.empty());
  world.move(b, {{5e6 + 1e-3, 0}, {5e6 + 2e-3, 1}});
  const Events events = world.update();
  ASSERT_EQ(events.begun.size(), 1u);
  EXPECT_EQ(events.begun[0], (HandlePair{a, b}));
}

}  // namespace
}  // namespace broadside::laws
