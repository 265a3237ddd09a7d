// Trackers over the same motion, in turns, their events compared.
#include "bench/motion/race.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "broadside/sinks.hpp"

#include "lab/measure/benchmark.hpp"
#include "lab/measure/expected_events.hpp"
#include "lab/measure/reference.hpp"
#include "lab/measure/rounds.hpp"
#include "lab/numbers.hpp"

namespace broadside::bench {
namespace {

constexpr std::size_t fewest_frames = 5;

/// What a frame's events were by the first tracker that told them.
struct Told {
  std::uint64_t hash;
  std::string by;
};

template <int D>
struct Participant {
  const lab::Entry* entry;
  Runner* runner;
  std::unique_ptr<PairTracker<D>> tracker{};  // of this round
  std::vector<Box<D>> boxes{};                // its own, as an engine's are
  double spent_ms = 0;
  bool done = false;
};

template <int D>
class Race {
 public:
  Race(std::span<const lab::Entry> entries, const Turns& turns) : turns_(turns) {
    for (const lab::Entry& entry : entries) outcome_.runners.push_back({entry.spec.text()});
    for (std::size_t i = 0; i < entries.size(); ++i)
      participants_.push_back({&entries[i], &outcome_.runners[i]});
  }

  Outcome run(const StartMotion<D>& start) {
    for (std::size_t round = 0; round < turns_.rounds; ++round) {
      Motion<D> motion = start();
      if (round == 0) let_in(motion.boxes);
      follow(motion, round);
    }
    for (Participant<D>& participant : participants_) {
      if (participant.tracker) participant.runner->explanation = participant.tracker->explanation();
    }
    return std::move(outcome_);
  }

 private:
  void let_in(std::span<const Box<D>> boxes) {
    lab::Extremes extremes;
    extremes.take<D>(boxes);
    for (Participant<D>& participant : participants_) {
      std::string& why = participant.runner->left_out;
      why = lab::unfit(*participant.entry, D, extremes);
      // Some take quadratic time to put boxes in one by one.
      const auto seconds_for = [&](std::size_t count) {
        std::vector<Box<D>> some;
        for (const std::size_t i : lab::sample_of(boxes.size(), count)) some.push_back(boxes[i]);
        make(participant);
        return update(participant, {some, {}}) / 1e3;
      };
      if (why.empty()) {
        if (const auto estimate = lab::estimate_above(turns_.budget_seconds, boxes.size(), seconds_for))
          why = "first frame " + lab::text(*estimate);
      }
      participant.done = !why.empty();
    }
  }

  void follow(Motion<D>& motion, std::size_t round) {
    for (const std::size_t place : lab::turns(participants_.size(), round)) {
      Participant<D>& participant = participants_[place];
      if (participant.done) continue;
      make(participant);
      participant.boxes = motion.boxes;
      const double milliseconds = update(participant, {participant.boxes, {}});
      compare(participant, 0);
      double& least = participant.runner->build_ms;
      least = least > 0 ? std::min(least, milliseconds) : milliseconds;
    }
    for (std::size_t frame = 0; frame < turns_.frames; frame += turns_.in_a_row) {
      std::vector<lab::Step<D>> steps;
      for (std::size_t i = frame; i < std::min(turns_.frames, frame + turns_.in_a_row); ++i)
        steps.push_back(motion.next());
      if (round == 0) {
        for (const lab::Step<D>& step : steps) outcome_.movers.push_back(step.changed.size());
      }
      for (const std::size_t place : lab::turns(participants_.size(), round * turns_.frames + frame)) {
        for (std::size_t i = 0; i < steps.size(); ++i) take(participants_[place], steps[i], frame + i);
      }
    }
  }

  void take(Participant<D>& participant, const lab::Step<D>& step, std::size_t frame) {
    if (participant.done) return;
    lab::apply(step, participant.boxes);
    const double milliseconds = update(participant, {participant.boxes, step.changed});
    compare(participant, frame + 1);
    participant.spent_ms += milliseconds;
    std::vector<double>& frames = participant.runner->frames_ms;
    if (frame < frames.size())
      frames[frame] = std::min(frames[frame], milliseconds);
    else
      frames.push_back(milliseconds);
    participant.done = frames.size() >= std::min(fewest_frames, turns_.frames) &&
                       participant.spent_ms > turns_.budget_seconds * 1e3;
  }

  static void make(Participant<D>& participant) {
    participant.tracker.reset();
    participant.tracker = make_tracker<D>(*participant.entry->algorithm, participant.entry->spec);
  }

  double update(Participant<D>& participant, const Frame<D>& frame) {
    events_.begun.clear();
    events_.ended.clear();
    PairCollector begun(events_.begun);
    PairCollector ended(events_.ended);
    const lab::Stopwatch watch;
    participant.tracker->update(frame, begun, ended);
    return watch.milliseconds();
  }

  void compare(const Participant<D>& participant, std::size_t frame) {
    lab::EventHasher hasher;
    hasher.add(events_);
    if (frame == told_.size()) {
      told_.push_back({hasher.hash(), participant.runner->algorithm});
      if (frame > 0) outcome_.events += events_.begun.size() + events_.ended.size();
    }
    if (told_[frame].hash == hasher.hash()) return;
    throw std::runtime_error(fmt::format(
        "frame {}: {} tells {} and {} as ended; expected the events that {} told", frame,
        participant.runner->algorithm, lab::counted(events_.begun.size(), "pair as begun", "pairs as begun"),
        events_.ended.size(), told_[frame].by));
  }

  const Turns& turns_;
  Outcome outcome_;
  std::vector<Participant<D>> participants_;
  std::vector<Told> told_;  // by frame, the first one too
  lab::Events events_;      // of the last update; its memory serves all
};

}  // namespace

double Outcome::mean_movers() const {
  if (movers.empty()) return 0;
  return static_cast<double>(std::accumulate(movers.begin(), movers.end(), std::size_t{0})) /
         static_cast<double>(movers.size());
}

template <int D>
Outcome race(std::span<const lab::Entry> entries, const StartMotion<D>& start, const Turns& turns) {
  return Race<D>(entries, turns).run(start);
}

void merge(Outcome& outcome, Outcome round) {
  if (outcome.runners.empty()) {
    outcome = std::move(round);
    return;
  }
  for (std::size_t i = 0; i < outcome.runners.size(); ++i) {
    Runner& runner = outcome.runners[i];
    const Runner& again = round.runners[i];
    runner.build_ms = std::min(runner.build_ms, again.build_ms);
    for (std::size_t frame = 0; frame < std::min(runner.frames_ms.size(), again.frames_ms.size()); ++frame)
      runner.frames_ms[frame] = std::min(runner.frames_ms[frame], again.frames_ms[frame]);
  }
}

template Outcome race(std::span<const lab::Entry>, const StartMotion<2>&, const Turns&);
template Outcome race(std::span<const lab::Entry>, const StartMotion<3>&, const Turns&);

}  // namespace broadside::bench
