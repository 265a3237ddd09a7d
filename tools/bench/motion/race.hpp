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

/// Initial boxes and the steps that follow.
template <int D>
struct Motion {
  std::vector<Box<D>> boxes;
  std::function<lab::Step<D>()> next;
};

/// Starts the same motion from its beginning.
template <int D>
using StartMotion = std::function<Motion<D>()>;

/// How runners take turns.
struct Turns {
  std::size_t frames = 20;     ///< after the first
  std::size_t rounds = 3;      ///< repetitions of the motion; the shortest time of each frame counts
  std::size_t in_a_row = 5;    ///< consecutive frames of one runner before the next one's turn
  bool is_cold = false;        ///< whether caches are flushed before each frame, as by the rest of an engine
  double budget_seconds = 20;  ///< for a runner's frames; over budget, it runs five frames in all
};

/// A runner in a race.
struct RaceRunner {
  std::string algorithm;            ///< its spec
  std::string left_out{};           ///< reason for exclusion; empty if it took part
  double build_ms = 0;              ///< the first frame, in which everything is new
  std::vector<double> frames_ms{};  ///< each later frame
  std::string explanation{};        ///< of the last frame, for algorithms that choose

  bool ran() const { return !frames_ms.empty(); }
};

/// Result of a race.
struct RaceOutcome {
  std::vector<RaceRunner> runners;    ///< in the order of the entries
  std::vector<std::size_t> movers{};  ///< boxes that changed in each frame
  std::uint64_t events = 0;           ///< begun and ended pairs in all frames but the first

  double mean_movers() const;
};

/// Follows boxes in a race.
template <int D>
class MotionFollower {
 public:
  virtual ~MotionFollower() = default;

  /// Takes the changes, as the engine that moved the boxes would pass them. Not timed.
  virtual void take(const lab::Step<D>& step) = 0;

  /// Brings the pairs up to date. Timed.
  virtual void update() = 0;

  /// Events of the last update, with boxes numbered as in the motion. Not timed.
  virtual const lab::FrameEvents& events() = 0;

  /// Throws std::runtime_error if something is wrong that comparing events does not reveal. Not timed.
  virtual void verify() {}

  virtual std::string explanation() const { return {}; }
};

/// A participant in a race.
template <int D>
struct Competitor {
  std::string name;

  /// Names the definition of its events: competitors with the same text must report the same events.
  std::string definition;

  std::function<std::unique_ptr<MotionFollower<D>>()> make;
  const lab::Entry* entry = nullptr;  ///< its limits; null if it has none
};

/// Competitors made from tracker algorithms.
template <int D>
std::vector<Competitor<D>> trackers(std::span<const lab::Entry> entries);

/// Lets the competitors follow the motion. Only update() and its events are timed; nothing of a competitor
/// runs between two frames. Throws std::runtime_error if two disagree on the events of a frame.
template <int D>
RaceOutcome race(std::vector<Competitor<D>> competitors, const StartMotion<D>& start, const Turns& turns);

/// As above, with trackers as competitors.
template <int D>
RaceOutcome race(std::span<const lab::Entry> entries, const StartMotion<D>& start, const Turns& turns);

/// Merges another round of the same motion into `outcome`: each frame keeps its shortest time.
void merge(RaceOutcome& outcome, RaceOutcome round);

}  // namespace broadside::bench
