// Worlds of several ranks: the events of each update are what has changed between the boxes as they were and
// as they are, whichever ranks own them and wherever the cuts are.
#include "broadside/distributed_world.hpp"

#include <iterator>
#include <map>
#include <optional>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/error.hpp"

#include "tests/mpi/ranks.hpp"
#include "tests/support/model.hpp"
#include "tests/support/world_model.hpp"

namespace broadside {
namespace {

using mpi::DistributedEvents;
using mpi::DistributedWorld;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::IsEmpty;

/// The boxes of all ranks, as each rank knows them: all draw the same random numbers.
template <int D, typename Real>
class History {
 public:
  explicit History(std::uint64_t seed, const mpi::DistributedWorldOptions& options = {})
      : rng_(seed), world_(MPI_COMM_WORLD, options) {}

  Rng& rng() { return rng_; }
  DistributedWorld<D, Real>& world() { return world_; }
  std::size_t size() const { return model_.members.size(); }

  void add(const Box<D, Real>& box) {
    // Large ids, in no order.
    const std::uint64_t id = rng_.bits();
    const int owner = any_rank();
    model_.add(id, box);
    owners_[id] = owner;
    if (owner == rank()) world_.add(id, box);
  }

  void move(std::uint64_t id, const Box<D, Real>& box) {
    model_.move(id, box);
    if (owners_[id] == rank()) world_.move(id, box);
  }

  void remove(std::uint64_t id) {
    model_.remove(id);
    if (owners_[id] == rank()) world_.remove(id);
  }

  /// Until the next update its owner stays what it was.
  void hand_over(std::uint64_t id) {
    const int to = any_rank();
    if (owners_[id] == rank()) world_.hand_over(id, to);
    next_owners_[id] = to;
  }

  std::uint64_t any() {
    return std::next(model_.members.begin(), static_cast<std::ptrdiff_t>(rng_.below(size())))->first;
  }

  std::vector<std::uint64_t> ids() const {
    std::vector<std::uint64_t> ids;
    for (const auto& [id, its] : model_.members) ids.push_back(id);
    return ids;
  }

  void expect_events() {
    model_.update();
    for (const auto& [id, owner] : next_owners_) owners_[id] = owner;
    next_owners_.clear();
    const DistributedEvents events = world_.update();
    EXPECT_THAT(events.begun, ElementsAreArray(own(model_.begun)));
    EXPECT_THAT(events.ended, ElementsAreArray(own(model_.ended)));
    std::size_t owned = 0;
    for (const auto& [id, its] : model_.members) {
      owned += std::size_t{owners_[id] == rank()};
      ASSERT_EQ(world_.contains(id), owners_[id] == rank());
      if (owners_[id] == rank()) {
        ASSERT_EQ(world_.box(id), its.box);
      }
    }
    EXPECT_EQ(world_.size(), owned);
  }

 private:
  int any_rank() { return static_cast<int>(rng_.below(static_cast<std::size_t>(ranks()))); }

  std::vector<LargePair> own(std::vector<LargePair> pairs) {
    std::erase_if(pairs, [this](const LargePair& pair) { return owners_[pair.first] != rank(); });
    return pairs;
  }

  Rng rng_;
  DistributedWorld<D, Real> world_;
  WorldModel<D, Real, LargePair> model_;
  std::map<std::uint64_t, int> owners_;
  std::map<std::uint64_t, int> next_owners_;
};

template <int D, typename Real>
Box<D, Real> drawn(Rng& rng) {
  const Box<D> box = random_box<D>(rng, {.places = 40, .max_extent = 5, .infinite_one_in = 100});
  if constexpr (sizeof(Real) == sizeof(float))
    return box;
  else
    return near_double(rng, box);
}

template <int D, typename Real>
void play(std::uint64_t seed, const mpi::DistributedWorldOptions& options = {}) {
  History<D, Real> history(seed, options);
  Rng& rng = history.rng();
  for (int frame = 0; frame < 30; ++frame) {
    for (std::size_t i = rng.below(frame == 0 ? 150 : 15); i > 0; --i) history.add(drawn<D, Real>(rng));
    for (std::size_t i = rng.below(1 + history.size() / 2); i > 0; --i)
      history.move(history.any(), drawn<D, Real>(rng));
    for (std::size_t i = history.size() > 20 ? rng.below(10) : 0; i > 0; --i) history.remove(history.any());
    for (std::size_t i = history.size() > 20 ? rng.below(10) : 0; i > 0; --i)
      history.hand_over(history.any());
    history.expect_events();
  }
}

TEST(DistributedWorld, TellsWhatChanges) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    play<2, float>(seed);
    play<3, float>(seed, {.algorithm = "bvh", .threads = 2});
    play<2, double>(seed, {.sample = 10});
    play<3, double>(seed);
  }
}

bool is_to_fail = false;

/// Brute force that fails when it is told to.
class FailingSearcher final : public Searcher<2> {
 public:
  std::optional<Statistics> search(const SearchInput<2>& input, PairSink& pairs) override {
    if (is_to_fail) throw std::domain_error("told to fail");
    return finder_.find(input.boxes, pairs);
  }

 private:
  Finder<2> finder_{"brute_force"};
};

TEST(DistributedWorld, TellsAllThatChangedOnceAnUpdateHasFailedOnARank) {
  register_algorithm({.name = "failing",
                      .summary = "fails",
                      .source = "this test",
                      .in_2d = {.searcher = make_strategy<FailingSearcher>}});
  History<2, float> history(4, {.algorithm = "failing"});
  for (int frame = 0; frame < 12; ++frame) {
    for (int i = 0; i < 20; ++i) history.add(drawn<2, float>(history.rng()));
    for (int i = 0; i < 10; ++i) history.move(history.any(), drawn<2, float>(history.rng()));
    for (int i = 0; i < 5; ++i) history.remove(history.any());
    if (frame % 3 == 1) {
      // Not of rank 0 alone, nor in the same step each time: the first of a world, or after cuts.
      const int failing = frame % ranks();
      is_to_fail = rank() == failing;
      if (is_to_fail)
        EXPECT_EQ(thrown<std::domain_error>([&] { history.world().update(); }), "told to fail");
      else
        EXPECT_THAT(thrown<mpi::RankError>([&] { history.world().update(); }),
                    HasSubstr("rank " + std::to_string(failing) + ": told to fail"));
      // And again, in taking over the boxes as they were.
      EXPECT_THROW(history.world().update(), std::exception);
      is_to_fail = false;
    }
    history.expect_events();
  }
}

TEST(DistributedWorld, CutsSpaceAnewWhereTheLoadShiftsAndTellsNothingOfThat) {
  History<2, float> history(9);
  Rng& rng = history.rng();
  const std::size_t count = 300 * static_cast<std::size_t>(ranks());
  const float side = 20 * std::sqrt(static_cast<float>(ranks()));
  for (std::size_t i = 0; i < count; ++i) {
    const Box2 box{{rng.between(0, side), rng.between(0, side)}, {}};
    history.add({box.min, {box.min[0] + 1, box.min[1] + 1}});
  }
  history.expect_events();
  EXPECT_EQ(history.world().statistics().cuts, 1U);
  if (ranks() > 1) {
    EXPECT_LT(history.world().statistics().largest_over_mean_work, 1.25);
  }
  // A tenth at a time, all go into one corner.
  const std::vector<std::uint64_t> ids = history.ids();
  for (std::size_t tenth = 0; tenth < 10; ++tenth) {
    for (std::size_t i = tenth; i < ids.size(); i += 10) {
      const Box2 box{{rng.between(0, side / 4), rng.between(0, side / 4)}, {}};
      history.move(ids[i], {box.min, {box.min[0] + 1, box.min[1] + 1}});
    }
    history.expect_events();
  }
  history.expect_events();
  if (ranks() > 1) {
    EXPECT_GT(history.world().statistics().cuts, 1U);
    EXPECT_LT(history.world().statistics().largest_over_mean_work, 1.4);
    EXPECT_LT(history.world().statistics().cuts, 8U);
  }
}

TEST(DistributedWorld, SharesOutAWorldThatStartsSmall) {
  DistributedWorld<2> world(MPI_COMM_WORLD);
  if (rank() == 0) world.add(0, at(0));
  world.update();
  // Doubles in each frame, so that it grows past what the first cuts were made for, and stays.
  std::uint64_t id = 1 + static_cast<std::uint64_t>(rank());
  const auto step = static_cast<std::uint64_t>(ranks());
  for (const std::uint64_t count : {1, 2, 4, 100, 500, 1000, 0, 0}) {
    for (std::uint64_t i = 0; i < count; ++i, id += step) world.add(id, at(static_cast<float>(2 * id)));
    world.update();
  }
  EXPECT_LT(world.statistics().largest_over_mean_work, 1.25);
  EXPECT_LT(world.statistics().cuts, 6U);
}

/// A world of boxes at one place, for which space is cut once.
DistributedWorld<2> crowd() {
  DistributedWorld<2> world(MPI_COMM_WORLD);
  for (std::uint64_t i = 0; i < 300; ++i)
    world.add(i * static_cast<std::uint64_t>(ranks()) + static_cast<std::uint64_t>(rank()), at(0));
  for (int frame = 0; frame < 5; ++frame) world.update();
  EXPECT_EQ(world.statistics().cuts, 1U);
  return world;
}

TEST(DistributedWorld, CutsAgainWhereTheBoxesHaveDoubled) {
  DistributedWorld<2> world = crowd();
  for (std::uint64_t i = 300; i < 20'000; ++i) {
    const std::uint64_t id = i * static_cast<std::uint64_t>(ranks()) + static_cast<std::uint64_t>(rank());
    world.add(id, at(static_cast<float>(2 * id)));
  }
  for (int frame = 0; frame < 5; ++frame) world.update();
  EXPECT_EQ(world.statistics().cuts, ranks() == 1 ? 1U : 2U);
}

TEST(DistributedWorld, CutsAgainWhereACrowdHasSpread) {
  DistributedWorld<2> world = crowd();
  for (std::uint64_t i = 0; i < 300; ++i) {
    const std::uint64_t id = i * static_cast<std::uint64_t>(ranks()) + static_cast<std::uint64_t>(rank());
    world.move(id, at(static_cast<float>(2 * id)));
  }
  for (int frame = 0; frame < 5; ++frame) world.update();
  EXPECT_EQ(world.statistics().cuts, ranks() == 1 ? 1U : 2U);
  EXPECT_LT(world.statistics().largest_over_mean_work, 1.25);
}

TEST(DistributedWorld, DoesNotCutAgainWhatNoCutTellsApart) { crowd(); }

TEST(DistributedWorld, SendsOnlyWhatChanges) {
  DistributedWorld<2> world(MPI_COMM_WORLD);
  for (std::uint64_t i = 0; i < 500; ++i) {
    const std::uint64_t id = i * static_cast<std::uint64_t>(ranks()) + static_cast<std::uint64_t>(rank());
    world.add(id, at(static_cast<float>(2 * id)));
  }
  world.update();
  world.update();
  EXPECT_EQ(world.statistics().sent_bytes, 0U);
  // All of one rank's boxes move on the spot.
  if (rank() == 0) world.move(0, at(0.5F));
  world.update();
  EXPECT_LE(world.statistics().sent_bytes, rank() == 0 ? 2 * 24U : 0U);
}

TEST(DistributedWorld, RefusesAnIdThatIsTakenOnAllRanks) {
  DistributedWorld<2> world(MPI_COMM_WORLD);
  if (rank() == 0) world.add(7, at(0));
  world.update();
  const int adder = ranks() - 1;
  if (adder > 0) {
    if (rank() == adder) world.add(7, at(1));
    EXPECT_THAT(thrown<InvalidFrame>([&] { world.update(); }),
                HasSubstr("box 7 is added on rank " + std::to_string(adder) +
                          " and is in the world, added on rank 0"));
    EXPECT_THAT(thrown<InvalidFrame>([&] { world.update(); }), HasSubstr("box 7"));
    if (rank() == adder) world.remove(7);
  }
  // With another one that is free, all is told as if nothing had been.
  if (rank() == adder) world.add(9, at(1));
  const DistributedEvents events = world.update();
  if (rank() == 0)
    EXPECT_THAT(events.begun, ElementsAre(LargePair{7, 9}));
  else
    EXPECT_THAT(events.begun, IsEmpty());
}

/// Has rank 0 hand over box 6 to the last rank, which has added one of that id, and 30 other boxes in the
/// same update; then lets the last rank remove its own, and the update be repeated.
void expect_refused_hand_over_to_be_undone(bool are_new, bool is_handed_back) {
  if (ranks() == 1) return;
  const int last = ranks() - 1;
  constexpr std::uint64_t begin = 10;
  constexpr std::uint64_t end = 40;
  // In the part of box 6, not in that of the others.
  const auto moved = [](std::uint64_t id) { return at(-100 * static_cast<float>(id)); };
  DistributedWorld<2> world(MPI_COMM_WORLD);
  if (rank() == 0) {
    world.add(6, at(-2));
    for (std::uint64_t id = begin; id < end; ++id) world.add(id, at(0.5F));
  }
  if (!are_new) world.update();
  if (rank() == 0) {
    world.hand_over(6, last);
    for (std::uint64_t id = begin; id < end; ++id) {
      world.hand_over(id, last);
      world.move(id, moved(id));
    }
  }
  if (rank() == last) world.add(6, at(3));
  for (int attempt = 0; attempt < 2; ++attempt)
    EXPECT_THAT(thrown<InvalidFrame>([&] { world.update(); }), HasSubstr("box 6 is handed over"));
  if (rank() == 0 && is_handed_back) world.hand_over(6, 0);
  if (rank() == last) world.remove(6);
  const std::size_t ended = world.update().ended.size();
  const std::uint64_t all_ended =
      mpi::summary(MPI_COMM_WORLD, {.pairs = ended, .work = 1}).all.pairs;  // of all ranks
  EXPECT_EQ(all_ended, are_new ? 0U : 30U * 29 / 2);
  EXPECT_EQ(world.size(),
            (rank() == last ? end - begin : 0U) + (rank() == (is_handed_back ? 0 : last) ? 1U : 0U));
  EXPECT_EQ(world.contains(6), rank() == (is_handed_back ? 0 : last));
  EXPECT_EQ(world.statistics().part_pairs, 0U);
  // Each part still knows its boxes: all are moved to one place, where all overlap.
  for (std::uint64_t id = begin; id < end; ++id)
    if (rank() == last) world.move(id, at(0.5F));
  const std::uint64_t begun = world.update().begun.size();
  EXPECT_EQ(mpi::summary(MPI_COMM_WORLD, {.pairs = begun, .work = 1}).all.pairs, 30U * 29 / 2);
}

TEST(DistributedWorld, TakesABoxHandedOverOnceTheOneOfItsIdIsRemoved) {
  expect_refused_hand_over_to_be_undone(false, false);
  expect_refused_hand_over_to_be_undone(true, false);
}

TEST(DistributedWorld, TakesBoxesThatARefusedUpdateHadHandedOver) {
  expect_refused_hand_over_to_be_undone(false, true);
  expect_refused_hand_over_to_be_undone(true, true);
}

TEST(DistributedWorld, LetsAnIdBeUsedAgainAfterAnUpdate) {
  DistributedWorld<2> world(MPI_COMM_WORLD);
  if (rank() == 0) {
    world.add(1, at(0));
    world.add(2, at(0.5F));
  }
  world.update();
  if (rank() == 0) {
    world.remove(2);
    EXPECT_THAT(thrown<InvalidFrame>([&] { world.add(2, at(0)); }), HasSubstr("was removed since"));
  }
  EXPECT_EQ(world.update().ended.size(), rank() == 0 ? 1U : 0U);
  if (rank() == ranks() - 1) world.add(2, at(0.5F));
  EXPECT_EQ(world.update().begun.size(), rank() == 0 ? 1U : 0U);
}

TEST(DistributedWorld, RefusesWhatItsOwnerDoesWrong) {
  DistributedWorld<2> world(MPI_COMM_WORLD);
  const auto id = static_cast<std::uint64_t>(rank());
  EXPECT_THAT(thrown<InvalidInput>([&] { world.add(id, {{nan, 0}, {1, 1}}); }), HasSubstr("NaN"));
  EXPECT_THAT(thrown<InvalidInput>([&] { world.add(id, absent_box<2>()); }),
              HasSubstr("expected min <= max"));
  world.add(id, at(0));
  EXPECT_THAT(thrown<InvalidFrame>([&] { world.add(id, at(0)); }), HasSubstr("in the world"));
  EXPECT_THAT(thrown<InvalidHandle>([&] { world.move(id + 1000, at(0)); }), HasSubstr("not owned"));
  EXPECT_THAT(thrown<InvalidHandle>([&] { world.remove(id + 1000); }), HasSubstr("not owned"));
  EXPECT_THAT(thrown<InvalidInput>([&] { world.move(id, {{1, 0}, {0, 0}}); }), HasSubstr("min > max"));
  EXPECT_THAT(thrown<std::invalid_argument>([&] { world.hand_over(id, ranks()); }),
              HasSubstr("expected one from 0"));
  EXPECT_EQ(world.box(id), at(0));
  world.remove(id);
  EXPECT_FALSE(world.contains(id));
  EXPECT_THAT(world.update().begun, IsEmpty());
}

TEST(DistributedWorld, RefusesOptionsThatDifferOrAreWrong) {
  EXPECT_THAT(
      thrown<std::invalid_argument>([] { DistributedWorld<2> world(MPI_COMM_WORLD, {.max_imbalance = 1}); }),
      HasSubstr("max_imbalance"));
  EXPECT_THAT(thrown<InvalidSpec>([] { DistributedWorld<2> world(MPI_COMM_WORLD, {.algorithm = "none"}); }),
              HasSubstr("none"));
  if (ranks() == 1) return;
  EXPECT_THAT(thrown<InvalidSpec>([] {
                DistributedWorld<2> world(MPI_COMM_WORLD, {.algorithm = rank() == 0 ? "grid" : "bvh"});
              }),
              HasSubstr("ranks differ"));
}

}  // namespace
}  // namespace broadside
