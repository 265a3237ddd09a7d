// Trackers and worlds over the same motion, in turns, their events compared.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lab/catalogue.hpp"
#include "lab/measure/expected_events.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::bench {

/// Boxes, and their steps one after the other.
template <int D>
struct Motion {
  std::vector<Box<D>> boxes;
  std::function<lab::Step<D>()> next;
};

/// Starts the same motion from its beginning.
template <int D>
using StartMotion = std::function<Motion<D>()>;

/// How trackers take turns.
struct Turns {
  std::size_t frames = 20;     ///< after the first
  std::size_t rounds = 3;      ///< how often the motion is followed anew; the least time of a frame counts
  std::size_t in_a_row = 5;    ///< frames that a tracker takes before it is the next one's turn
  bool is_cold = false;        ///< whether caches are flushed before each frame, as by the rest of an engine
  double budget_seconds = 20;  ///< for a tracker's frames; from then on it takes five frames in all
};

/// A tracker in a race.
struct RaceRunner {
  std::string algorithm;            ///< its spec
  std::string left_out{};           ///< why it was not let in; empty if it was
  double build_ms = 0;              ///< the first frame, in which everything is new
  std::vector<double> frames_ms{};  ///< each frame after it
  std::string explanation{};        ///< of what it chose for the last frame, where it chooses

  bool ran() const { return !frames_ms.empty(); }
};

/// What a race came to.
struct RaceOutcome {
  std::vector<RaceRunner> runners;    ///< in the order of the entries
  std::vector<std::size_t> movers{};  ///< boxes that changed in each frame
  std::uint64_t events = 0;           ///< begun and ended in all frames but the first

  double mean_movers() const;
};

/// What follows boxes in a race.
template <int D>
class MotionFollower {
 public:
  virtual ~MotionFollower() = default;

  /// Hands over what changes, as the engine that moved the boxes has it. Not timed.
  virtual void take(const lab::Step<D>& step) = 0;

  /// Brings the pairs up to date. Timed.
  virtual void update() = 0;

  /// The events of the last update, by the places of the motion. Not timed.
  virtual const lab::FrameEvents& events() = 0;

  /// Throws std::runtime_error if something is wrong that the events of others cannot tell. Not timed.
  virtual void verify() {}

  virtual std::string explanation() const { return {}; }
};

/// A participant in a race.
template <int D>
struct Competitor {
  std::string name;

  /// What its events are told of: all with the same text must tell the same events.
  std::string definition;

  std::function<std::unique_ptr<MotionFollower<D>>()> make;
  const lab::Entry* entry = nullptr;  ///< its limits, where it has some
};

/// The competitors that trackers are.
template <int D>
std::vector<Competitor<D>> trackers(std::span<const lab::Entry> entries);

/// Lets the competitors follow the motion. Between two frames nothing of theirs is timed: what is timed is an
/// update() with its events. Throws std::runtime_error if two disagree on the events of a frame.
template <int D>
RaceOutcome race(std::vector<Competitor<D>> competitors, const StartMotion<D>& start, const Turns& turns);

/// The same with trackers.
template <int D>
RaceOutcome race(std::span<const lab::Entry> entries, const StartMotion<D>& start, const Turns& turns);

/// Adds a round of the same motion to what others came to: of each frame the least time remains.
void merge(RaceOutcome& outcome, RaceOutcome round);

}  // namespace broadside::bench
