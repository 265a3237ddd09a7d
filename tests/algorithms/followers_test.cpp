// The followers of the library's algorithms by themselves: the events and the candidates that a Tracker
// relies on.
#include <algorithm>
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

#include "tests/support/model.hpp"

namespace broadside {
namespace {

using testing::IsEmpty;

/// Frames in which boxes move a little or far, come and go.
template <int D>
class ChangingBoxes {
 public:
  explicit ChangingBoxes(std::size_t count)
      : before_(count, absent_box<D>()), now_(random_boxes<D>(rng_, count)), flags_(count, 1) {
    for (std::size_t i = 0; i < count; ++i) changed_.push_back(BoxId(i));
  }

  /// The first frame, and then each that next() leads to.
  Change<D> change(bool rebuild, bool wants_candidates) const {
    return {.before = before_,
            .now = now_,
            .changed = changed_,
            .flags = flags_,
            .rebuild = rebuild,
            .wants_candidates = wants_candidates};
  }

  void next() {
    before_ = now_;
    changed_.clear();
    std::ranges::fill(flags_, 0);
    for (std::size_t i = 0; i < now_.size(); ++i) {
      if (!rng_.one_in(5)) continue;
      changed_.push_back(BoxId(i));
      flags_[i] = 1;
      if (rng_.one_in(6))
        now_[i] = absent_box<D>();
      else if (rng_.one_in(3) || !is_present(now_[i]))
        now_[i] = random_box<D>(rng_);
      else
        now_[i].max[0] += 1;
    }
    std::ranges::reverse(changed_);
  }

 private:
  Rng rng_{6};
  std::vector<Box<D>> before_;
  std::vector<Box<D>> now_;
  std::vector<BoxId> changed_;
  std::vector<std::uint8_t> flags_;
};

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

/// Calls `body(follower)` for a new one of each kind.
template <int D, typename Body>
void with_each_follower(const Body& body) {
  for (const Algorithm& algorithm : algorithms()) {
    if (algorithm.kind != AlgorithmKind::own) continue;
    EXPECT_TRUE(algorithm.gives_candidates) << algorithm.name;
    EXPECT_THAT(algorithm.in<D>().followers, testing::Not(IsEmpty())) << algorithm.name;
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
      ChangingBoxes<D> boxes(300);
      for (int frame = 0; frame < 20; ++frame) {
        const Change<D> change = boxes.change(frame == 0 || frame == 12, false);
        const auto [begun, ended] = followed(follower, change);
        EXPECT_EQ(begun,
                  pairs_of_changed(
                      change, [&](BoxId a, BoxId b) { return change.holds(a, b) && !change.held(a, b); }))
            << frame;
        EXPECT_EQ(ended,
                  pairs_of_changed(
                      change, [&](BoxId a, BoxId b) { return change.held(a, b) && !change.holds(a, b); }))
            << frame;
        boxes.next();
      }
    });
  });
}

TEST(Followers, WriteEveryPairOfAChangedBoxWhereCandidatesAreWanted) {
  in_each_dimension([]<int D>() {
    with_each_follower<D>([](Follower<D>& follower) {
      ChangingBoxes<D> boxes(300);
      for (int frame = 0; frame < 20; ++frame) {
        const Change<D> change = boxes.change(frame == 0 || frame == 12, frame % 4 != 3);
        const auto [begun, ended] = followed(follower, change);
        if (change.wants_candidates) {
          EXPECT_THAT(ended, IsEmpty()) << frame;
          const auto wanted = pairs_of_changed(
              change, [&](BoxId a, BoxId b) { return change.held(a, b) || change.holds(a, b); });
          EXPECT_TRUE(std::ranges::includes(begun, wanted)) << frame;
          const auto all = pairs_of_changed(change, [](BoxId, BoxId) { return true; });
          EXPECT_TRUE(std::ranges::includes(all, begun)) << frame;
        }
        boxes.next();
      }
    });
  });
}

}  // namespace
}  // namespace broadside
