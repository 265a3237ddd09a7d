// The followers of the library's algorithms by themselves: the events and the candidates that a Tracker
// relies on.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/follower.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "tests/algorithms/moved_frames.hpp"

namespace broadside {
namespace {

using testing::IsEmpty;

/// Calls `body(frame, change)` for each of 20 frames. In two of them followers discard what they kept.
template <int D, typename Body>
void in_each_frame(const Body& body) {
  algorithm::MovedFrames<D> frames(300, {});
  for (int frame = 0; frame < 20; ++frame) {
    frames.step(2 + frame % 4);
    const std::vector<Box<D>> now = frames.now();
    std::vector<BoxId> changed;
    for (const core::MovedBox<D>& box : frames.moved) changed.insert(changed.begin(), box.id);
    body(frame, Change<D>{.before = frames.boxes,
                          .now = now,
                          .changed = changed,
                          .flags = frames.moves,
                          .rebuild = frame == 0 || frame == 12});
    frames.apply();
  }
}

/// What the follower writes, each pair once and in order.
template <int D>
std::pair<std::vector<Pair>, std::vector<Pair>> followed(Follower<D>& follower, const Change<D>& change) {
  std::vector<Pair> ended;
  std::vector<Pair> begun = written_pairs([&](PairSink& begun_sink) {
    ended = written_pairs([&](PairSink& ended_sink) { follower.follow(change, begun_sink, ended_sink); });
  });
  for (std::vector<Pair>* const pairs : {&begun, &ended}) {
    std::ranges::sort(*pairs);
    pairs->erase(std::unique(pairs->begin(), pairs->end()), pairs->end());
  }
  return {begun, ended};
}

/// The pairs of a changed box and another one for which `is_wanted(a, b)`.
template <int D, typename Predicate>
std::vector<Pair> pairs_of_changed(const Change<D>& change, const Predicate& is_wanted) {
  std::vector<Pair> pairs;
  for (std::uint32_t a = 0; a < change.now.size(); ++a) {
    for (std::uint32_t b = a + 1; b < change.now.size(); ++b) {
      if ((change.flags[a] | change.flags[b]) != 0 && is_wanted(BoxId{a}, BoxId{b}))
        pairs.push_back(ordered(a, b));
    }
  }
  return pairs;
}

/// Whether a spec can choose between following and finding anew.
bool offers_update(const Algorithm& algorithm) {
  return std::ranges::any_of(algorithm.tunables,
                             [](const Tunable& tunable) { return tunable.name == "update"; });
}

/// Calls `body(follower)` for a new one of each kind. An algorithm that only searches has none.
template <int D, typename Body>
void with_each_follower(const Body& body) {
  for (const Algorithm& algorithm : algorithms()) {
    if (algorithm.kind != AlgorithmKind::own) continue;
    const bool follows = !algorithm.in<D>().followers.empty();
    EXPECT_TRUE(follows || !offers_update(algorithm)) << algorithm.name;
    EXPECT_TRUE(algorithm.gives_candidates || !follows) << algorithm.name;
    for (const FollowerChoice<D>& choice : algorithm.in<D>().followers) {
      SCOPED_TRACE(algorithm.name + ", " + choice.name + ", " + std::to_string(D) + "D");
      const std::unique_ptr<Follower<D>> follower =
          choice.make(Settings({algorithm.name, {}}, algorithm.tunables));
      body(*follower);
    }
  }
}

TEST(Followers, WriteTheEventsOfEachFrame) {
  in_each_dimension([]<int D>() {
    with_each_follower<D>([](Follower<D>& follower) {
      in_each_frame<D>([&](int frame, const Change<D>& change) {
        const auto [begun, ended] = followed(follower, change);
        EXPECT_EQ(begun,
                  pairs_of_changed(
                      change, [&](BoxId a, BoxId b) { return change.holds(a, b) && !change.held(a, b); }))
            << frame;
        EXPECT_EQ(ended,
                  pairs_of_changed(
                      change, [&](BoxId a, BoxId b) { return change.held(a, b) && !change.holds(a, b); }))
            << frame;
      });
    });
  });
}

TEST(Followers, WriteEveryPairOfAChangedBoxWhereCandidatesAreWanted) {
  in_each_dimension([]<int D>() {
    with_each_follower<D>([](Follower<D>& follower) {
      in_each_frame<D>([&](int frame, Change<D> change) {
        change.wants_candidates = frame % 4 != 3;
        const auto [begun, ended] = followed(follower, change);
        if (change.wants_candidates) {
          EXPECT_THAT(ended, IsEmpty()) << frame;
          const auto wanted = pairs_of_changed(
              change, [&](BoxId a, BoxId b) { return change.held(a, b) || change.holds(a, b); });
          EXPECT_TRUE(std::ranges::includes(begun, wanted)) << frame;
          const auto all = pairs_of_changed(change, [](BoxId, BoxId) { return true; });
          EXPECT_TRUE(std::ranges::includes(all, begun)) << frame;
        }
      });
    });
  });
}

TEST(Followers, InCellsTakeAnyNumberOfMovers) {
  in_each_dimension([]<int D>() {
    for (const std::size_t count : {std::size_t{1'000}, std::size_t{40'000}}) {
      Rng rng(7);
      std::vector<Box<D>> boxes(count);
      const int places = D == 2 ? 400 : 60;
      for (Box<D>& box : boxes)
        box = random_box<D>(rng, {.places = places, .max_extent = 3, .infinite_one_in = 0});
      Tracker<D> following(Spec("grid:update=follow"));
      Tracker<D> finding(Spec("grid:update=rebuild"));
      std::vector<BoxId> all(count);
      for (std::size_t i = 0; i < count; ++i) all[i] = BoxId(i);
      for (int frame = 0; frame < 4; ++frame) {
        const auto events_of = [&](Tracker<D>& tracker) {
          std::vector<Pair> ended;
          const std::vector<Pair> begun = written_pairs([&](PairSink& begun_sink) {
            ended = written_pairs([&](PairSink& ended_sink) {
              tracker.update({.boxes = boxes, .changed = all}, begun_sink, ended_sink);
            });
          });
          return std::pair(begun, ended);
        };
        ASSERT_EQ(events_of(following), events_of(finding)) << count << " boxes, frame " << frame;
        for (Box<D>& box : boxes) {
          const auto way = static_cast<float>(rng.below(3));
          box.min[0] += way;
          box.max[0] += way;
        }
      }
    }
  });
}

}  // namespace
}  // namespace broadside
