// The law of batches: the pairs of a loop over find_pairs(), in its order, for any number of threads.
#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/batch.hpp"

#include "hard_inputs.hpp"
#include "law_case.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

/// Worlds in one array.
template <int D, typename Real>
struct Worlds {
  Boxes<D, Real> boxes;
  std::vector<std::size_t> offsets = {0};

  void add(const Boxes<D, Real>& world) {
    boxes.insert(boxes.end(), world.begin(), world.end());
    offsets.push_back(boxes.size());
  }
};

template <int D, typename Real>
Boxes<D, Real> drawn_boxes(Rng& rng, std::size_t count) {
  Boxes<D, Real> boxes(count);
  for (Box<D, Real>& box : boxes) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = static_cast<Real>(rng.between(0, 20));
      box.max[axis] = box.min[axis] + static_cast<Real>(rng.between(0, 4)) / 3;
    }
  }
  return boxes;
}

/// Worlds without boxes, with one, with absent ones, with difficult ones, and a large one among them.
template <int D, typename Real>
Worlds<D, Real> drawn_worlds(const Algorithm& algorithm) {
  Rng rng(1);
  Worlds<D, Real> worlds;
  worlds.add({});
  worlds.add(drawn_boxes<D, Real>(rng, 1));
  for (std::size_t world = 0; world < 120; ++world) {
    worlds.add(drawn_boxes<D, Real>(rng, rng.below(120)));
    if (world % 20 == 0) worlds.add({});
    if (world == 30) worlds.add(drawn_boxes<D, Real>(rng, reduced(1500)));
  }
  for (const Input<D>& input : hard_inputs<D>(algorithm, 60)) {
    Boxes<D, Real> boxes(std::min<std::size_t>(input.boxes.size(), 300));
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      std::ranges::copy(input.boxes[i].min, boxes[i].min.begin());
      std::ranges::copy(input.boxes[i].max, boxes[i].max.begin());
    }
    worlds.add(boxes);
  }
  worlds.add({});
  return worlds;
}

/// The definition.
template <int D, typename Real>
BatchPairs by_a_loop(const Worlds<D, Real>& worlds, const FindOptions& options = {}) {
  BatchPairs all{{}, {0}};
  for (std::size_t world = 0; world + 1 < worlds.offsets.size(); ++world) {
    const std::size_t begin = worlds.offsets[world];
    const std::size_t count = worlds.offsets[world + 1] - begin;
    FindOptions of_world = options;
    if (!options.filters.empty()) of_world.filters = options.filters.subspan(begin, count);
    std::vector<BoxId> invalid;
    if (options.quarantined != nullptr) of_world.quarantined = &invalid;
    const std::vector<Pair> pairs = find_pairs(std::span(worlds.boxes).subspan(begin, count), of_world);
    for (const BoxId id : invalid) options.quarantined->push_back(BoxId(begin + index(id)));
    all.pairs.insert(all.pairs.end(), pairs.begin(), pairs.end());
    all.offsets.push_back(all.pairs.size());
  }
  return all;
}

Spec with_threads(const Spec& spec, std::size_t threads) {
  return Spec(spec.name + ":threads=" + std::to_string(threads));
}

template <int D, typename Real>
void expect_the_loops_pairs(const Worlds<D, Real>& worlds, const Spec& spec, const FindOptions& given = {}) {
  FindOptions options = given;
  options.algorithm = spec;
  std::vector<BoxId> expected_invalid;
  if (given.quarantined != nullptr) options.quarantined = &expected_invalid;
  const BatchPairs expected = by_a_loop(worlds, options);
  options.quarantined = given.quarantined;
  const BatchPairs found = find_pairs_batch(worlds.boxes, worlds.offsets, options);
  EXPECT_EQ(found.offsets, expected.offsets);
  EXPECT_EQ(found.pairs, expected.pairs);
  if (given.quarantined == nullptr) return;
  EXPECT_EQ(*given.quarantined, expected_invalid);
}

class BatchLaw : public Law {
 protected:
  /// The spec, and if the algorithm uses threads, the same with several.
  std::vector<Spec> specs() const {
    std::vector<Spec> all = {spec()};
    if (has_threads(algorithm())) {
      for (const std::size_t threads : {2, 5}) all.push_back(with_threads(spec(), threads));
    }
    return all;
  }
};

TEST_P(BatchLaw, FindsThePairsOfALoopInItsOrder) {
  in_dimension([&]<int D>() {
    for (const Spec& one : specs()) {
      expect_the_loops_pairs(drawn_worlds<D, float>(algorithm()), one);
      expect_the_loops_pairs(drawn_worlds<D, double>(algorithm()), one);
    }
  });
}

TEST_P(BatchLaw, AppliesOptionsInEachWorld) {
  in_dimension([&]<int D>() {
    const Worlds<D, float> worlds = drawn_worlds<D, float>(algorithm());
    std::vector<Filter> filters(worlds.boxes.size());
    Rng rng(2);
    for (Filter& filter : filters) filter = {.category = 1U << rng.below(3), .mask = rng.below(8)};
    IgnoredPairs ignored;
    for (std::uint32_t i = 0; i < 90; ++i) ignored.insert({BoxId{i}, BoxId(i + 1 + rng.below(9))});
    for (const Spec& one : specs()) {
      expect_the_loops_pairs(worlds, one, {.filters = filters});
      expect_the_loops_pairs(worlds, one, {.ignored = &ignored});
      expect_the_loops_pairs(worlds, one, {.touching = false});
    }
  });
}

TEST_P(BatchLaw, ListsQuarantinedBoxesByTheirPlaces) {
  in_dimension([&]<int D>() {
    Worlds<D, float> worlds = drawn_worlds<D, float>(algorithm());
    Rng rng(3);
    for (int i = 0; i < 20; ++i)
      worlds.boxes[rng.below(worlds.boxes.size())].max[0] = std::numeric_limits<float>::quiet_NaN();
    for (const Spec& one : specs()) {
      std::vector<BoxId> quarantined = {BoxId{7}};
      expect_the_loops_pairs(worlds, one, {.quarantined = &quarantined});
      EXPECT_FALSE(quarantined.empty());
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, BatchLaw, testing::ValuesIn(cases_of(algorithms())), case_name);

/// Runs every task in the calling thread, the last first.
class Backwards final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 4; }
  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    for (std::size_t i = count; i-- > 0;) task(i);
  }
};

TEST(Batch, SharesWorldsAndALargeWorldAmongAllThreads) {
  Rng rng(4);
  Worlds<3, float> worlds;
  for (int i = 0; i < 40; ++i) worlds.add(drawn_boxes<3, float>(rng, 100));
  worlds.add(drawn_boxes<3, float>(rng, reduced(40'000, 1)));
  for (int i = 0; i < 200; ++i) worlds.add(drawn_boxes<3, float>(rng, 100));
  expect_the_loops_pairs(worlds, "auto:threads=4");
  Backwards backwards;
  expect_the_loops_pairs(worlds, "auto:threads=0", {.executor = &backwards});
}

TEST(Batch, TakesStridedBoxesAndGivesTheWorldsPairs) {
  struct Body {
    int id;
    Box2 box;
  };
  const std::vector<Body> bodies = {
      {1, {{0, 0}, {1, 1}}}, {2, {{1, 1}, {2, 2}}}, {3, {{0, 0}, {9, 9}}}, {4, {{1, 1}, {2, 2}}}};
  const std::vector<std::size_t> offsets = {0, 1, 4};
  const BatchPairs found = find_pairs_batch(BoxView<2>(&bodies[0].box, bodies.size(), sizeof(Body)), offsets);
  EXPECT_TRUE(found.of(0).empty());
  EXPECT_EQ(std::vector<Pair>(found.of(1).begin(), found.of(1).end()),
            (std::vector<Pair>{{BoxId{0}, BoxId{1}}, {BoxId{0}, BoxId{2}}, {BoxId{1}, BoxId{2}}}));
}

template <typename Exception>
std::string message_of(const std::vector<Box2>& boxes, const std::vector<std::size_t>& offsets,
                       const FindOptions& options = {}) {
  try {
    static_cast<void>(find_pairs_batch(boxes, offsets, options));
  } catch (const Exception& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(Batch, RefusesOffsetsWithTheValueFound) {
  const std::vector<Box2> boxes(4, Box2{{0, 0}, {1, 1}});
  EXPECT_EQ(message_of<InvalidFrame>(boxes, {}),
            "0 offsets of worlds; expected one more than there are worlds, at least 1");
  EXPECT_EQ(message_of<InvalidFrame>(boxes, {1, 4}), "the first offset of worlds is 1; expected 0");
  EXPECT_EQ(message_of<InvalidFrame>(boxes, {0, 3, 2, 4}),
            "offset 2 of worlds is 2, after 3; expected ascending offsets");
  EXPECT_EQ(message_of<InvalidFrame>(boxes, {0, 5}),
            "the last offset of worlds is 5; expected 4, the number of boxes");
  EXPECT_EQ(message_of<InvalidFrame>(boxes, {0}),
            "the last offset of worlds is 0; expected 4, the number of boxes");
  EXPECT_EQ(find_pairs_batch(std::vector<Box2>(), std::vector<std::size_t>{0}).offsets,
            std::vector<std::size_t>{0});
}

TEST(Batch, RefusesFiltersThatDoNotFit) {
  const std::vector<Box2> boxes(4, Box2{{0, 0}, {1, 1}});
  const std::vector<Filter> filters(3);
  EXPECT_EQ(message_of<InvalidFrame>(boxes, {0, 4}, {.filters = filters}),
            "3 filters for 4 boxes; expected one for each box, or none");
  EXPECT_EQ(message_of<InvalidFrame>(boxes, {0, 4}, {.right_filters = filters}),
            "3 right filters for a search in one set; expected none");
}

TEST(Batch, NamesTheWorldOfAnInvalidBox) {
  std::vector<Box2> boxes(5, Box2{{0, 0}, {1, 1}});
  boxes[3].max[1] = -1;
  EXPECT_EQ(message_of<InvalidInput>(boxes, {0, 2, 2, 5}),
            "box 3, which is box 1 of world 2, has min (0, 0) and max (1, -1); expected numbers with min <= "
            "max on every axis, or the absent box (min = +inf, max = -inf)");
}

}  // namespace
}  // namespace broadside::laws
