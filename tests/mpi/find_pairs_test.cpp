// Joins by several ranks: the pairs of a search on one, each on the rank that owns its first box; errors on
// all ranks or on none.
#include "broadside/find_pairs.hpp"

#include <algorithm>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/mpi.hpp"

#include "tests/mpi/ranks.hpp"
#include "tests/support/model.hpp"

namespace broadside {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::array shares = {Share::evenly, Share::all_to_the_last, Share::some_have_none};

/// Those of sorted pairs whose first box is this rank's.
std::vector<LargePair> own_pairs(Share share, std::size_t boxes, std::vector<Pair> pairs) {
  std::sort(pairs.begin(), pairs.end());
  std::vector<LargePair> own;
  for (const Pair pair : pairs)
    if (index(pair.first) >= begin_of(share, boxes, rank()) &&
        index(pair.first) < begin_of(share, boxes, rank() + 1))
      own.push_back({index(pair.first), index(pair.second)});
  return own;
}

template <int D, typename Real>
void expect_law(const std::vector<Box<D, Real>>& boxes, const mpi::Options& options = {}) {
  const std::vector<Pair> pairs = find_pairs(boxes);
  for (const Share share : shares)
    EXPECT_EQ(mpi::find_pairs(MPI_COMM_WORLD, own_of(share, boxes), options),
              own_pairs(share, boxes.size(), pairs));
}

template <int D, typename Real>
void expect_law_between(const std::vector<Box<D, Real>>& left, const std::vector<Box<D, Real>>& right) {
  const std::vector<Pair> pairs = find_pairs(left, right);
  for (const Share share : shares)
    EXPECT_EQ(mpi::find_pairs(MPI_COMM_WORLD, own_of(share, left), own_of(Share::evenly, right)),
              own_pairs(share, left.size(), pairs));
}

/// Boxes on a lattice with infinite sides, some of them absent; in clusters; with some that are huge.
template <int D>
std::vector<std::vector<Box<D>>> scenes() {
  Rng rng(11);
  std::vector<std::vector<Box<D>>> scenes(4);
  scenes[0] = random_boxes<D>(rng, 1500, {.places = 200, .max_extent = 4, .infinite_one_in = 400});
  for (std::size_t i = 0; i < 1500; i += 7) scenes[0][i] = absent_box<D>();
  for (int i = 0; i < 3000; ++i) {
    Box<D> box = random_box<D>(rng, {.places = 60, .max_extent = 1, .infinite_one_in = 0});
    const auto cluster = static_cast<float>(rng.whole(0, 9));
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] += cluster * cluster * 20;
      box.max[axis] += cluster * cluster * 20;
    }
    scenes[1].push_back(box);
    scenes[2].push_back(random_box<D>(rng, {.places = 900, .max_extent = 2, .infinite_one_in = 0}));
    if (i % 300 == 0) scenes[2].back().max[i % D] += 800;
  }
  Box<D> everywhere;
  everywhere.min.fill(-infinity);
  everywhere.max.fill(infinity);
  scenes[2].push_back(everywhere);
  scenes[3].assign(150, scenes[1][0]);
  return scenes;
}

template <int D>
std::vector<Box<D, double>> as_doubles(const std::vector<Box<D>>& boxes) {
  Rng rng(3);
  std::vector<Box<D, double>> doubles;
  for (const Box<D>& box : boxes)
    doubles.push_back(is_absent(box) ? absent_box<D, double>() : near_double(rng, box));
  return doubles;
}

TEST(MpiFindPairs, FindsThePairsOfOneRank) {
  in_each_dimension([]<int D>() {
    for (const std::vector<Box<D>>& boxes : scenes<D>()) {
      expect_law<D>(boxes);
      expect_law<D>(boxes, {.algorithm = "grid", .threads = 2, .sample = 64});
      expect_law<D>(as_doubles(boxes));
      expect_law<D>(boxes, {.has_large_ids = true});
    }
  });
}

TEST(MpiFindPairs, FindsThePairsBetweenTwoSets) {
  in_each_dimension([]<int D>() {
    const std::vector<std::vector<Box<D>>> sets = scenes<D>();
    expect_law_between<D>(sets[0], sets[2]);
    expect_law_between<D>(sets[1], sets[3]);
    expect_law_between<D>({}, sets[3]);
    expect_law_between<D>(as_doubles(sets[2]), as_doubles(sets[0]));
  });
}

TEST(MpiFindPairs, FindsThePairsBetweenTwoSetsByLargeIds) {
  const std::vector<std::vector<Box2>> sets = scenes<2>();
  EXPECT_EQ(mpi::find_pairs(MPI_COMM_WORLD, own_of(Share::evenly, sets[0]),
                            own_of(Share::some_have_none, sets[2]), {.has_large_ids = true}),
            own_pairs(Share::evenly, sets[0].size(), find_pairs(sets[0], sets[2])));
}

TEST(LargePair, HashesAsAPairWhere32BitsHoldIt) {
  EXPECT_EQ(hash(LargePair{3, UINT32_MAX}), hash(pair(3, UINT32_MAX)));
  constexpr std::uint64_t high = std::uint64_t{1} << 32;
  EXPECT_NE(hash(LargePair{high | 3, 9}), hash(pair(3, 9)));
  EXPECT_NE(hash(LargePair{high | 3, 9}), hash(LargePair{3, high | 9}));
}

TEST(MpiFindPairs, TakesNoBoxesAndFewBoxes) {
  expect_law<2, float>({});
  expect_law<2, float>({at(1)});
  expect_law<2, float>({at(1), at(2)});
  expect_law<3, double>({absent_box<3, double>()});
}

TEST(MpiFindPairs, TakesBoxesInStructsOfTheCallers) {
  struct Particle {
    double mass;
    Box2 bounds;
  };
  std::vector<Particle> particles;
  std::vector<Box2> boxes;
  for (const Box2& box : own_of(Share::evenly, scenes<2>()[2])) {
    particles.push_back({1, box});
    boxes.push_back(box);
  }
  const BoxView<2> view(particles.empty() ? nullptr : &particles[0].bounds, particles.size(),
                        sizeof(Particle));
  EXPECT_EQ(mpi::find_pairs(MPI_COMM_WORLD, view), mpi::find_pairs(MPI_COMM_WORLD, boxes));
}

TEST(MpiFindPairs, WorksForSomeOfTheRanks) {
  // The others call nothing.
  const bool is_odd = rank() % 2 == 1;
  MPI_Comm half = MPI_COMM_NULL;
  MPI_Comm_split(MPI_COMM_WORLD, is_odd ? 1 : 0, rank(), &half);
  if (is_odd) {
    std::uint64_t sum = mpi::find_pairs(half, std::vector<Box2>{at(0), at(1)}).size();
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, half);
    const auto boxes = static_cast<std::uint64_t>(ranks() / 2) * 2;
    EXPECT_EQ(sum, boxes * boxes / 4 + 2 * (boxes / 2) * (boxes / 2 - 1) / 2);
  }
  MPI_Comm_free(&half);
}

/// Boxes of the side 1 that crowd into a few places, or lie evenly.
template <int D>
std::vector<Box<D>> spread(std::size_t count, float side, bool is_clustered) {
  Rng rng(5);
  std::vector<Box<D>> boxes(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < D; ++axis) {
      float place = rng.between(0, side);
      // A half lies within a tenth of the way around one of five places.
      if (is_clustered && i % 2 == 0)
        place =
            side * static_cast<float>((i / 2 * 7 + static_cast<std::size_t>(axis) * 3) % 5) / 5 + place / 10;
      boxes[i].min[axis] = place;
      boxes[i].max[axis] = place + 1;
    }
  }
  return boxes;
}

TEST(MpiFindPairs, SharesTheWork) {
  in_each_dimension([]<int D>() {
    for (const bool is_clustered : {false, true}) {
      const std::vector<Box<D>> boxes = spread<D>(40'000, D == 2 ? 150.0F : 25.0F, is_clustered);
      const mpi::RankStatistics statistics =
          mpi::find_pairs(MPI_COMM_WORLD, own_of(Share::all_to_the_last, boxes), [](auto) {});
      const mpi::Summary all = mpi::summary(MPI_COMM_WORLD, statistics);
      EXPECT_LE(all.largest_over_mean_work, is_clustered ? 1.5 : 1.2) << D << "D " << is_clustered;
      EXPECT_EQ(all.all.boxes, boxes.size());
      EXPECT_EQ(all.all.pairs, all.all.part_pairs);
      EXPECT_EQ(all.all.pairs, find_pairs(boxes).size());
      EXPECT_GE(all.all.part_boxes, boxes.size());
      if (ranks() > 1) {
        EXPECT_GT(all.all.box_bytes, 0U);
      }
    }
  });
}

TEST(MpiFindPairs, RefusesABadBoxOfOneRankOnAll) {
  for (int bad = 0; bad < ranks(); ++bad) {
    std::vector<Box2> boxes = {at(0), at(1), at(2)};
    if (rank() == bad) boxes[2].min[1] = nan;
    try {
      mpi::find_pairs(MPI_COMM_WORLD, boxes);
      ADD_FAILURE() << "was taken";
    } catch (const InvalidInput& error) {
      EXPECT_EQ(error.index(), 2U);
      EXPECT_THAT(error.what(), HasSubstr("rank " + std::to_string(bad) + ": box 2 has a NaN"));
    }
    EXPECT_THAT(
        thrown<InvalidInput>([&] { mpi::find_pairs(MPI_COMM_WORLD, std::vector<Box2>{at(0)}, boxes); }),
        HasSubstr("right box 2"));
  }
  // The ranks are still together.
  expect_law<2, float>({at(1), at(2)});
}

TEST(MpiFindPairs, RefusesOptionsThatDiffer) {
  const std::vector<Box2> boxes = {at(0), at(1)};
  const auto find = [&](const mpi::Options& options) { mpi::find_pairs(MPI_COMM_WORLD, boxes, options); };
  EXPECT_THAT(thrown<InvalidSpec>([&] { find({.algorithm = "no_such"}); }), HasSubstr("no_such"));
  if (ranks() == 1) return;
  const std::string differ = "ranks differ in spec";
  EXPECT_THAT(thrown<InvalidSpec>([&] { find({.algorithm = rank() == 0 ? "grid" : "bvh"}); }),
              HasSubstr(differ));
  EXPECT_THAT(thrown<InvalidSpec>([&] { find({.threads = static_cast<std::size_t>(rank() == 0 ? 1 : 2)}); }),
              HasSubstr(differ));
  EXPECT_THAT(thrown<InvalidSpec>([&] {
                if (rank() == 0)
                  mpi::find_pairs(MPI_COMM_WORLD, std::vector<DoubleBox3>{});
                else
                  mpi::find_pairs(MPI_COMM_WORLD, boxes);
              }),
              HasSubstr(differ));
  EXPECT_THAT(thrown<InvalidSpec>([&] {
                if (rank() == 0)
                  mpi::find_pairs(MPI_COMM_WORLD, boxes, boxes);
                else
                  mpi::find_pairs(MPI_COMM_WORLD, boxes);
              }),
              HasSubstr(differ));
}

TEST(MpiFindPairs, EndsOnAllRanksWhereOneThrows) {
  const int thrower = ranks() - 1;
  const auto find = [&] {
    mpi::find_pairs(MPI_COMM_WORLD, std::vector<Box2>{at(0), at(1)}, [&](std::span<const LargePair>) {
      if (rank() == thrower) throw std::domain_error("no room");
    });
  };
  if (rank() == thrower) {
    EXPECT_EQ(thrown<std::domain_error>(find), "no room");
  } else {
    try {
      find();
      ADD_FAILURE() << "was taken";
    } catch (const mpi::RankError& error) {
      EXPECT_EQ(error.rank(), thrower);
      EXPECT_EQ(std::string(error.what()), "rank " + std::to_string(thrower) + ": no room");
    }
  }
  expect_law<2, float>({at(1), at(2)});
}

}  // namespace
}  // namespace broadside
