// Trackers and worlds over the same motion, in turns, their events compared.
#include "bench/motion/race.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "broadside/sinks.hpp"

#include "lab/measure/benchmark.hpp"
#include "lab/measure/reference.hpp"
#include "lab/measure/rounds.hpp"
#include "lab/numbers.hpp"

namespace broadside::bench {
namespace {

constexpr std::size_t fewest_frames = 5;

template <int D>
class TrackerFollower final : public MotionFollower<D> {
 public:
  explicit TrackerFollower(const lab::Entry& entry) : tracker_(*entry.algorithm, entry.spec) {}

  void take(const lab::Step<D>& step) override {
    lab::apply(step, boxes_);
    changed_ = step.changed;
    events_.begun.clear();
    events_.ended.clear();
  }

  void update() override {
    PairCollector begun(events_.begun);
    PairCollector ended(events_.ended);
    tracker_.update({boxes_, changed_}, begun, ended);
  }

  const lab::FrameEvents& events() override { return events_; }
  std::string explanation() const override { return tracker_.explanation(); }

 private:
  Tracker<D> tracker_;
  std::vector<Box<D>> boxes_;  // a copy of its own, as an engine has
  std::vector<BoxId> changed_;
  lab::FrameEvents events_;
};

/// A step that adds all of these boxes.
template <int D>
lab::Step<D> first_step(std::span<const Box<D>> boxes) {
  lab::Step<D> step{boxes.size(), {}, {boxes.begin(), boxes.end()}};
  for (std::size_t i = 0; i < boxes.size(); ++i) step.changed.push_back(BoxId(i));
  return step;
}

/// Hash of a frame's events, and the first runner that reported them.
struct ReportedEvents {
  std::uint64_t hash;
  std::string by;
};

template <int D>
struct Racer {
  Competitor<D> competitor;
  RaceRunner* runner;
  std::unique_ptr<MotionFollower<D>> follower{};  // of this round
  double spent_ms = 0;
  bool done = false;
};

template <int D>
class Race {
 public:
  Race(std::vector<Competitor<D>> competitors, const Turns& turns) : turns_(turns) {
    for (const Competitor<D>& competitor : competitors) outcome_.runners.push_back({competitor.name});
    for (std::size_t i = 0; i < competitors.size(); ++i)
      participants_.push_back({std::move(competitors[i]), &outcome_.runners[i]});
  }

  RaceOutcome run(const StartMotion<D>& start) {
    for (std::size_t round = 0; round < turns_.rounds; ++round) {
      Motion<D> motion = start();
      if (round == 0) let_in(motion.boxes);
      follow(motion, round);
      // Only the first runner is verified, and reports what that found.
      if (round > 0) continue;
      for (Racer<D>& participant : participants_) {
        if (participant.follower) participant.runner->explanation = participant.follower->explanation();
      }
    }
    return std::move(outcome_);
  }

 private:
  void let_in(std::span<const Box<D>> boxes) {
    lab::Extremes extremes;
    extremes.take<D>(boxes);
    for (Racer<D>& participant : participants_) {
      std::string& why = participant.runner->left_out;
      if (participant.competitor.entry != nullptr)
        why = lab::unfit(*participant.competitor.entry, D, extremes);
      // Some libraries take quadratic time to insert boxes one by one.
      const auto seconds_for = [&](std::size_t count) {
        std::vector<Box<D>> some;
        for (const std::size_t i : lab::sample_of(boxes.size(), count)) some.push_back(boxes[i]);
        make(participant);
        return update(participant, first_step<D>(some)) / 1e3;
      };
      if (why.empty()) {
        if (const auto estimate = lab::estimate_above(turns_.budget_seconds, boxes.size(), seconds_for))
          why = "first frame " + lab::text(*estimate);
      }
      participant.done = !why.empty();
    }
  }

  void follow(Motion<D>& motion, std::size_t round) {
    const lab::Step<D> first = first_step<D>(motion.boxes);
    for (const std::size_t place : lab::turns(participants_.size(), round)) {
      Racer<D>& participant = participants_[place];
      if (participant.done) continue;
      make(participant);
      const double milliseconds = update(participant, first);
      check(participant, 0, round);
      double& min_ms = participant.runner->build_ms;
      min_ms = min_ms > 0 ? std::min(min_ms, milliseconds) : milliseconds;
    }
    for (std::size_t frame = 0; frame < turns_.frames; frame += turns_.in_a_row) {
      std::vector<lab::Step<D>> steps;
      for (std::size_t i = frame; i < std::min(turns_.frames, frame + turns_.in_a_row); ++i)
        steps.push_back(motion.next());
      if (round == 0) {
        for (const lab::Step<D>& step : steps) outcome_.movers.push_back(step.changed.size());
      }
      for (const std::size_t place : lab::turns(participants_.size(), round * turns_.frames + frame)) {
        for (std::size_t i = 0; i < steps.size(); ++i) take(participants_[place], steps[i], frame + i, round);
      }
    }
  }

  void take(Racer<D>& participant, const lab::Step<D>& step, std::size_t frame, std::size_t round) {
    if (participant.done) return;
    const double milliseconds = update(participant, step);
    check(participant, frame + 1, round);
    participant.spent_ms += milliseconds;
    std::vector<double>& frames = participant.runner->frames_ms;
    if (frame < frames.size())
      frames[frame] = std::min(frames[frame], milliseconds);
    else
      frames.push_back(milliseconds);
    participant.done = frames.size() >= std::min(fewest_frames, turns_.frames) &&
                       participant.spent_ms > turns_.budget_seconds * 1e3;
  }

  static void make(Racer<D>& participant) {
    participant.follower.reset();
    participant.follower = participant.competitor.make();
  }

  double update(Racer<D>& participant, const lab::Step<D>& step) {
    participant.follower->take(step);
    if (turns_.is_cold) flush_caches();
    const lab::Stopwatch watch;
    participant.follower->update();
    return watch.milliseconds();
  }

  /// Writes more bytes than the caches hold.
  void flush_caches() {
    flushed_.resize(std::size_t{256} << 20);
    for (std::size_t i = 0; i < flushed_.size(); i += 64) ++flushed_[i];
  }

  void check(const Racer<D>& participant, std::size_t frame, std::size_t round) {
    const lab::FrameEvents& events = participant.follower->events();
    lab::EventHasher hasher;
    hasher.add(events);
    std::vector<ReportedEvents>& reported = reported_[participant.competitor.definition];
    if (frame == reported.size()) {
      reported.push_back({hasher.hash(), participant.runner->algorithm});
      if (frame > 0 && reported_.size() == 1) outcome_.events += events.begun.size() + events.ended.size();
    }
    if (reported[frame].hash != hasher.hash()) {
      throw std::runtime_error(fmt::format(
          "frame {}: {} tells {} and {} as ended; expected the events that {} told", frame,
          participant.runner->algorithm, lab::counted(events.begun.size(), "pair as begun", "pairs as begun"),
          events.ended.size(), reported[frame].by));
    }
    if (round == 0) participant.follower->verify();
  }

  const Turns& turns_;
  RaceOutcome outcome_;
  std::vector<Racer<D>> participants_;
  std::vector<char> flushed_{};
  // By definition and frame, including the first frame.
  std::map<std::string, std::vector<ReportedEvents>> reported_;
};

}  // namespace

double RaceOutcome::mean_movers() const {
  if (movers.empty()) return 0;
  return static_cast<double>(std::accumulate(movers.begin(), movers.end(), std::size_t{0})) /
         static_cast<double>(movers.size());
}

template <int D>
std::vector<Competitor<D>> trackers(std::span<const lab::Entry> entries) {
  std::vector<Competitor<D>> competitors;
  for (const lab::Entry& entry : entries) {
    const auto make = [&entry] { return std::make_unique<TrackerFollower<D>>(entry); };
    competitors.push_back({entry.spec.text(), "boxes", make, &entry});
  }
  return competitors;
}

template <int D>
RaceOutcome race(std::vector<Competitor<D>> competitors, const StartMotion<D>& start, const Turns& turns) {
  return Race<D>(std::move(competitors), turns).run(start);
}

template <int D>
RaceOutcome race(std::span<const lab::Entry> entries, const StartMotion<D>& start, const Turns& turns) {
  return race<D>(trackers<D>(entries), start, turns);
}

void merge(RaceOutcome& outcome, RaceOutcome round) {
  if (outcome.runners.empty()) {
    outcome = std::move(round);
    return;
  }
  for (std::size_t i = 0; i < outcome.runners.size(); ++i) {
    RaceRunner& runner = outcome.runners[i];
    const RaceRunner& again = round.runners[i];
    runner.build_ms = std::min(runner.build_ms, again.build_ms);
    for (std::size_t frame = 0; frame < std::min(runner.frames_ms.size(), again.frames_ms.size()); ++frame)
      runner.frames_ms[frame] = std::min(runner.frames_ms[frame], again.frames_ms[frame]);
  }
}

template std::vector<Competitor<2>> trackers(std::span<const lab::Entry>);
template std::vector<Competitor<3>> trackers(std::span<const lab::Entry>);
template RaceOutcome race(std::vector<Competitor<2>>, const StartMotion<2>&, const Turns&);
template RaceOutcome race(std::vector<Competitor<3>>, const StartMotion<3>&, const Turns&);
template RaceOutcome race(std::span<const lab::Entry>, const StartMotion<2>&, const Turns&);
template RaceOutcome race(std::span<const lab::Entry>, const StartMotion<3>&, const Turns&);

}  // namespace broadside::bench
