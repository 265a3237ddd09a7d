// Golden hashes of histories built from integers: the events of every tracker of our own, in their order,
// with and without filters, for any number of threads, whatever the compiler, the machine and its instruction
// set.
//
// A hash never changes unless the history does.
#include <array>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/sinks.hpp"

#include "lab/scenes/motion.hpp"
#include "lab/scenes/random.hpp"
#include "law_case.hpp"
#include "law_sinks.hpp"

namespace broadside::laws {
namespace {

struct GoldenHistory {
  int dimension;
  bool has_filters;
  std::uint64_t events;  ///< how many
  std::uint64_t hash;    ///< of those, begun before ended in each frame
};

constexpr std::array<GoldenHistory, 4> golden_histories = {{
    {2, false, 16636, 0x361cefe9e7cf4c80U},
    {2, true, 8801, 0xd3c9af90d4da6861U},
    {3, false, 18227, 0x3935ce59e5be3d55U},
    {3, true, 9346, 0x9b79efc822c8d9c4U},
}};

Filter any_filter(lab::Random& random) {
  Filter filter;
  filter.category = static_cast<std::uint32_t>(1 + random.below(7));
  filter.mask = static_cast<std::uint32_t>(random.below(8));
  filter.group = static_cast<std::int32_t>(random.below(7)) - 3;
  filter.is_static = random.below(5) == 0;
  return filter;
}

/// Boxes that come, move, jump and go, and pairs that become ignored and no longer are.
template <int D>
History<D> moving_history(bool has_filters) {
  History<D> history =
      lab::random_history<D>({.boxes = 400, .frames = 60, .seed = 5, .infinite_boxes = false});
  if (!has_filters) return history;
  lab::Random random(9);
  for (std::size_t i = 0; i < history.boxes.size(); ++i) history.filters.push_back(any_filter(random));
  for (Step<D>& step : history.steps) {
    for (std::size_t i = 0; i < step.changed.size(); ++i) step.filters.push_back(any_filter(random));
    for (int i = 0; i < 20; ++i) {
      const auto a = static_cast<std::uint32_t>(random.below(400));
      step.toggled.push_back({BoxId{a}, BoxId{a + 1 + static_cast<std::uint32_t>(random.below(20))}});
    }
  }
  return history;
}

class GoldenHistories : public Law {};

TEST_P(GoldenHistories, HaveTheSameEventsInTheSameOrder) {
  in_dimension([&]<int D>() {
    for (const GoldenHistory& golden : golden_histories) {
      if (golden.dimension != D) continue;
      const History<D> history = moving_history<D>(golden.has_filters);
      for (const std::size_t threads : {1, 2, 8}) {
        Tracker<D> tracker(algorithm(), spec());
        tracker.set_workers({.threads = threads, .executor = nullptr, .boxes_per_thread = 1});
        OrderHasher events;
        Replay<D> replay(history);
        tracker.update(replay.frame(), events, events);
        for (const Step<D>& step : history.steps) tracker.update(replay.next(step), events, events);
        EXPECT_EQ(events.count, golden.events) << D << "D, filters " << golden.has_filters;
        EXPECT_EQ(events.hash, golden.hash) << std::hex << "0x" << events.hash;
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, GoldenHistories, testing::ValuesIn(law_cases_if(is_own)), case_name);

}  // namespace
}  // namespace broadside::laws
