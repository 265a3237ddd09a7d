// Trackers as unit tests use them: a stub, what an update reports, a sink that fails.
#pragma once

#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "tests/support/boxes.hpp"

namespace broadside {

/// What an update reports.
struct PairEvents {
  Pairs begun;
  Pairs ended;

  friend bool operator==(const PairEvents&, const PairEvents&) = default;
};

inline PairEvents update(PairTracker<2>& tracker, const Frame<2>& frame) {
  PairEvents events;
  PairCollector begun(events.begun);
  PairCollector ended(events.ended);
  tracker.update(frame, begun, ended);
  return events;
}

inline PairEvents update(PairTracker<2>& tracker, const std::vector<Box2>& boxes, const Ids& changed) {
  return update(tracker, {boxes, changed});
}

/// Calls a function with the change that an algorithm gets to see.
class StubTracker final : public PairTracker<2> {
 public:
  using Update = std::function<void(const Change<2>&, PairSink&, PairSink&)>;

  explicit StubTracker(Update update) : update_(std::move(update)) {}

 private:
  void update_valid(const Change<2>& change, PairSink& begun, PairSink& ended) override {
    update_(change, begun, ended);
  }

  Update update_;
};

class FailingSink final : public PairSink {
 private:
  void consume(std::span<const Pair>) override { throw std::runtime_error("full"); }
};

}  // namespace broadside
