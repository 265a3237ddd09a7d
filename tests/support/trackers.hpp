// Trackers for unit tests: a stub, the events of an update, a failing sink.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "broadside/follower.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "tests/support/boxes.hpp"

namespace broadside {

/// Events of an update.
struct PairEvents {
  Pairs begun;
  Pairs ended;

  friend bool operator==(const PairEvents&, const PairEvents&) = default;
};

/// For a Tracker or a ShadowTracker.
template <typename AnyTracker>
PairEvents update(AnyTracker& tracker, const Frame<2>& frame) {
  PairEvents events;
  PairCollector begun(events.begun);
  PairCollector ended(events.ended);
  tracker.update(frame, begun, ended);
  return events;
}

template <typename AnyTracker>
PairEvents update(AnyTracker& tracker, const std::vector<Box2>& boxes, const Ids& changed) {
  return update(tracker, Frame<2>{boxes, changed});
}

/// Calls a function with the change that a follower gets.
class StubFollower final : public Follower<2> {
 public:
  using Follow = std::function<void(const Change<2>&, PairSink&, PairSink&)>;

  explicit StubFollower(Follow follow) : follow_(std::move(follow)) {}

  std::optional<Statistics> follow(const Change<2>& change, PairSink& begun, PairSink& ended) override {
    follow_(change, begun, ended);
    return std::nullopt;
  }

 private:
  Follow follow_;
};

inline Tracker<2> stub_tracker(StubFollower::Follow follow) {
  return Tracker<2>(std::make_unique<StubFollower>(std::move(follow)));
}

class FailingSink final : public PairSink {
 private:
  void consume(std::span<const Pair>) override { throw std::runtime_error("full"); }
};

}  // namespace broadside
