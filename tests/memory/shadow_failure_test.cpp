// ShadowTracker, where there is no memory to tell the fault that it has found.
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/debug/shadow.hpp"
#include "broadside/sinks.hpp"

#include "injection.hpp"

namespace broadside::laws {
namespace {

/// Never tells of any event.
class SilentFollower final : public Follower<2> {
 public:
  std::optional<Statistics> follow(const Change<2>&, PairSink&, PairSink&) override { return std::nullopt; }
};

/// Whether an update has told a fault; nothing if memory ran out.
std::optional<Pair> told(ShadowTracker<2>& tracker, const std::vector<Box2>& boxes, Injector& injector) {
  std::optional<Pair> pair;
  PairCounter events;
  injector.attempt([&] {
    try {
      tracker.update({boxes, {}}, events, events);
    } catch (const Divergence& divergence) {
      EXPECT_EQ(divergence.frame(), 0U);
      EXPECT_TRUE(divergence.holds());
      pair = divergence.pair();
    }
  });
  return pair;
}

TEST(ShadowFailure, TellsAFaultAsSoonAsThereIsMemory) {
  const std::vector<Box2> boxes(2, Box2{{0, 0}, {1, 1}});
  for (std::uint64_t k = 0, failures = 1; failures > 0; ++k) {
    ShadowTracker<2> shadow([] { return Tracker<2>(std::make_unique<SilentFollower>()); });
    Injector injector(k, FailureKind::once);
    std::optional<Pair> pair = told(shadow, boxes, injector);
    failures = injector.failures();
    if (!pair) pair = told(shadow, boxes, injector);
    EXPECT_EQ(pair, (Pair{BoxId{0}, BoxId{1}})) << "allocation " << k;
  }
}

}  // namespace
}  // namespace broadside::laws
