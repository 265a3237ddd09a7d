// PairSink and the ready-made sinks.
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/sinks.hpp"

namespace broadside {
namespace {

TEST(PairSink, OrdersTheTwoIds) {
  std::vector<Pair> pairs;
  PairCollector sink(pairs);
  sink.add(BoxId{7}, BoxId{3});
  sink.flush();
  EXPECT_EQ(pairs, (std::vector<Pair>{{BoxId{3}, BoxId{7}}}));
}

TEST(PairSink, KeepsEveryPairAndTheirOrderAcrossChunks) {
  std::vector<Pair> pairs;
  PairCollector sink(pairs);
  for (std::uint32_t i = 0; i < 10 * PairSink::max_room; ++i) sink.add(BoxId{i}, BoxId{i + 1});
  sink.flush();
  ASSERT_EQ(pairs.size(), 10 * PairSink::max_room);
  for (std::uint32_t i = 0; i < pairs.size(); ++i) ASSERT_EQ(index(pairs[i].first), i);
}

TEST(PairSink, TakesWhatWasCommittedOfARoomAndNoMore) {
  std::vector<Pair> pairs;
  PairCollector sink(pairs);
  for (std::uint32_t i = 0; i < 5; ++i) {
    Pair* const room = sink.room(PairSink::max_room);
    for (std::uint32_t j = 0; j < PairSink::max_room; ++j) room[j] = {BoxId{i}, BoxId{i + j + 1}};
    sink.commit(i);
  }
  sink.flush();
  EXPECT_EQ(pairs.size(), 0u + 1 + 2 + 3 + 4);
}

TEST(PairHasher, TellsSetsApartButNotTheirOrders) {
  const auto hash_of = [](std::vector<Pair> pairs) {
    PairHasher hasher;
    for (const Pair pair : pairs) hasher.add(pair.first, pair.second);
    hasher.flush();
    return hasher.hash();
  };
  const Pair a{BoxId{0}, BoxId{1}};
  const Pair b{BoxId{0}, BoxId{2}};
  EXPECT_EQ(hash_of({a, b}), hash_of({b, a}));
  EXPECT_NE(hash_of({a}), hash_of({b}));
  EXPECT_NE(hash_of({a, b}), hash_of({a, b, b}));
}

TEST(PairFunction, PassesOnWhatItsFunctionThrows) {
  PairFunction sink([](std::span<const Pair>) { throw std::runtime_error("full"); });
  sink.add(BoxId{0}, BoxId{1});
  EXPECT_THROW(sink.flush(), std::runtime_error);
}

}  // namespace
}  // namespace broadside
