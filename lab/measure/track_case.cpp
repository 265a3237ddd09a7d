// Measures trackers: every contender over the same histories, frame by frame in turns, all events checked.
#include "lab/measure/track_case.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "broadside/sinks.hpp"

#include "lab/measure/expected_events.hpp"
#include "lab/measure/samples.hpp"

namespace broadside::lab {
namespace {

/// The expected events of one input.
struct Expectation {
  Reference reference;
  std::size_t input;
  ExpectedEvents events;
};

template <int D, typename Real>
struct Contestant {
  const Contender* contender;
  Measurement* entry;
  std::unique_ptr<PairTracker<D, Real>> tracker{};  // of this pass
  const ExpectedEvents* expected = nullptr;         // of this pass
  EventHasher hasher{};
  std::vector<double> frames_ms{};  // of this pass
  std::vector<double> builds_ms{};  // the first frames of all passes
  double pass_ms = 0;               // of this pass, the first frame too
  double spent_ms = 0;              // in frames, of all passes
  std::uint64_t tests = 0;
  std::uint64_t references = 0;
  std::int64_t pairs = 0;
  Allocation memory{0, 0};  // taken by the tracker since it was made
  bool done = false;
};

/// Some of the boxes of a history and its first steps, as a history of their own.
template <int D, typename Real>
History<D, Real> thinned(const History<D, Real>& history, std::size_t count, std::size_t most_steps) {
  constexpr std::size_t left_out = static_cast<std::size_t>(-1);
  std::size_t size = history.boxes.size();
  for (const Step<D, Real>& step : history.steps) size = std::max(size, step.size);
  std::vector<std::size_t> place(size, left_out);
  History<D, Real> thin;
  std::size_t next = 0;
  for (const std::size_t i : sample_of(size, count)) {
    place[i] = next++;
    thin.boxes.push_back(i < history.boxes.size() ? history.boxes[i] : absent_box<D, Real>());
  }
  for (std::size_t s = 0; s < std::min(most_steps, history.steps.size()); ++s) {
    const Step<D, Real>& step = history.steps[s];
    Step<D, Real> few{thin.boxes.size(), {}, {}};
    for (std::size_t i = 0; i < step.changed.size(); ++i) {
      if (place[index(step.changed[i])] == left_out) continue;
      few.changed.push_back(BoxId(place[index(step.changed[i])]));
      few.boxes.push_back(step.boxes[i]);
    }
    thin.steps.push_back(std::move(few));
  }
  return thin;
}

template <int D, typename Real>
class TrackCase {
 public:
  TrackCase(const Case& of, Histories<D, Real> inputs, const Contest& contest)
      : case_(of), inputs_(inputs), contest_(contest) {
    for (const History<D, Real>& input : inputs) {
      extremes_.template take<D, Real>(input.boxes);
      for (const Step<D, Real>& step : input.steps) {
        extremes_.template take<D, Real>(step.boxes);
        extremes_.boxes = std::max(extremes_.boxes, step.size);
      }
    }
  }

  std::vector<Measurement> run() {
    std::vector<Measurement> entries;
    for (const Contender& contender : contest_.contenders) entries.push_back(entry_of(contender));
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (let_in(contest_.contenders[i], entries[i]))
        contestants_.push_back({&contest_.contenders[i], &entries[i]});
    }
    // The first pass sees what memory is taken; where it takes too long to be done again, it is timed as
    // well.
    pass(0, true);
    for (Contestant<D, Real>& contestant : contestants_) close_first_pass(contestant);
    for (std::size_t round = 1; std::ranges::any_of(contestants_, is_on); ++round) {
      pass(round % inputs_.size(), false);
      for (Contestant<D, Real>& contestant : contestants_) close_pass(contestant);
    }
    return entries;
  }

 private:
  static bool is_on(const Contestant<D, Real>& contestant) { return !contestant.done; }

  /// Fills in why not, if the contender is not let in.
  bool let_in(const Contender& contender, Measurement& entry) {
    const History<D, Real>& history = inputs_[0];
    entry.reason = unfit(contender, D, extremes_);
    if (!entry.reason.empty()) return false;
    const double budget = contest_.effort.history_seconds;
    const auto history_seconds = [&](std::size_t count) {
      contest_.watch.at(fmt::format("{}, trying {} boxes", entry.algorithm, count));
      return seconds_of(contender, thinned(history, count, 2));
    };
    const std::string fault = fault_of(entry, [&]() -> std::string {
      // A history cannot be left half way, so that its frames share the budget.
      if (const auto estimate = estimate_above(budget, case_.boxes, history_seconds))
        skip(entry, *estimate, case_.frames + 1, budget);
      return {};
    });
    if (!fault.empty()) fail(entry, fault);
    return entry.reason.empty();
  }

  /// Seconds for as many frames as the case has, by a history's first frame and the mean of its others; of
  /// two tries the shorter one where they are short, since those are easily disturbed.
  double seconds_of(const Contender& contender, const History<D, Real>& history) {
    constexpr double is_short = 0.02;  // for all frames
    double least = INFINITY;
    for (int attempt = 0; attempt < 3; ++attempt) {
      if (attempt > 0 && least > is_short) break;
      const auto tracker = make_tracker<D, Real>(*contender.algorithm, contender.spec);
      std::vector<Box<D, Real>> boxes = history.boxes;
      const double first = update(*tracker, {boxes, {}});
      double others = 0;
      for (const Step<D, Real>& step : history.steps) {
        apply(step, boxes);
        others += update(*tracker, {boxes, step.changed});
      }
      const double frames = static_cast<double>(case_.frames) /
                            static_cast<double>(std::max<std::size_t>(history.steps.size(), 1));
      least = std::min(least, (first + others * frames) / 1e3);
    }
    return least;
  }

  /// Milliseconds for one frame, whose events are then in events_.
  double update(PairTracker<D, Real>& tracker, const Frame<D, Real>& frame) {
    events_.begun.clear();
    events_.ended.clear();
    PairCollector begun(events_.begun);
    PairCollector ended(events_.ended);
    const Stopwatch watch;
    tracker.update(frame, begun, ended);
    return watch.milliseconds();
  }

  /// Lets all that are not done track an input from its first frame to its last.
  void pass(std::size_t input, bool is_first) {
    const History<D, Real>& history = inputs_[input];
    std::vector<Box<D, Real>> boxes = history.boxes;
    for (Contestant<D, Real>& contestant : contestants_) {
      if (contestant.done) continue;
      contest_.watch.at(contestant.entry->algorithm + ", checking");
      contestant.expected = &expectation(contestant, input);
      contestant.tracker.reset();
      contestant.frames_ms.clear();
      contestant.pass_ms = 0;
    }
    for (std::size_t frame = 0; frame <= history.steps.size(); ++frame) {
      if (frame > 0) apply(history.steps[frame - 1], boxes);
      const Frame<D, Real> now{boxes,
                               frame == 0 ? std::span<const BoxId>() : history.steps[frame - 1].changed};
      for (const std::size_t seat : turns(contestants_.size(), frame)) {
        Contestant<D, Real>& contestant = contestants_[seat];
        if (contestant.done) continue;
        contest_.watch.at(fmt::format("{}, frame {}", contestant.entry->algorithm, frame));
        const std::string fault =
            fault_of(*contestant.entry, [&] { return take(contestant, now, frame, is_first); });
        if (fault.empty()) continue;
        fail(*contestant.entry, fault);
        contestant.done = true;
      }
    }
  }

  /// One frame of one contestant; what is wrong with its events.
  std::string take(Contestant<D, Real>& contestant, const Frame<D, Real>& now, std::size_t frame,
                   bool is_first) {
    const ExpectedEvents& expected = *contestant.expected;
    if (!expected.fault.empty()) return expected.fault;
    events_.begun.reserve(expected.frames[frame].begun.size());
    events_.ended.reserve(expected.frames[frame].ended.size());
    const auto make_and_update = [&] {
      if (!contestant.tracker)
        contestant.tracker =
            make_tracker<D, Real>(*contestant.contender->algorithm, contestant.contender->spec);
      return update(*contestant.tracker, now);
    };
    const double milliseconds = is_first ? counted(contestant, make_and_update) : make_and_update();
    contestant.pass_ms += milliseconds;
    (frame > 0 ? contestant.frames_ms : contestant.builds_ms).push_back(milliseconds);
    if (is_first) note(contestant, frame);
    return difference<D, Real>(events_, expected.frames[frame], contestant.entry->algorithm, frame,
                               now.boxes);
  }

  /// Runs one frame and adds the memory it takes to the contestant's.
  template <typename Run>
  double counted(Contestant<D, Real>& contestant, const Run& run) {
    const AllocationMeter meter;
    const double milliseconds = run();
    if (const auto allocation = meter.read()) {
      Allocation& memory = contestant.memory;
      memory.peak = std::max(memory.peak, memory.kept + allocation->peak);
      memory.kept += allocation->kept;
      count_memory(*contestant.entry, *contestant.contender->algorithm, memory);
    }
    return milliseconds;
  }

  /// Notes what is counted in the first pass.
  void note(Contestant<D, Real>& contestant, std::size_t frame) {
    contestant.hasher.add(events_);
    contestant.pairs +=
        static_cast<std::int64_t>(events_.begun.size()) - static_cast<std::int64_t>(events_.ended.size());
    const auto& statistics = contestant.tracker->statistics();
    if (frame == 0 || !statistics) return;
    contestant.tests += statistics->tests;
    contestant.references += statistics->references;
    contestant.entry->statistics = Statistics{contestant.tests / frame, contestant.references / frame};
  }

  void close_first_pass(Contestant<D, Real>& contestant) {
    if (contestant.done) return;
    Measurement& entry = *contestant.entry;
    entry.outcome = Outcome::verified;
    entry.pairs = static_cast<std::uint64_t>(contestant.pairs);
    entry.pair_hash = contestant.hasher.hash();
    entry.explanation = contestant.tracker->explanation();
    entry.build_ms = median(contestant.builds_ms);
    if (contestant.pass_ms > contest_.effort.single_sample_seconds * 1e3) {
      entry.samples_ms = contestant.frames_ms;
      contestant.done = true;
    }
  }

  void close_pass(Contestant<D, Real>& contestant) {
    if (contestant.done) return;
    Measurement& entry = *contestant.entry;
    entry.samples_ms.insert(entry.samples_ms.end(), contestant.frames_ms.begin(), contestant.frames_ms.end());
    // The first pass counts memory, which takes time.
    entry.build_ms = median(std::span(contestant.builds_ms).subspan(1));
    contestant.spent_ms += contestant.pass_ms;
    const std::size_t samples = entry.samples_ms.size();
    contestant.done = samples >= contest_.effort.most_samples ||
                      (samples >= contest_.effort.least_samples &&
                       contestant.spent_ms >= contest_.effort.share_seconds * 1e3);
  }

  /// What the contestant must report on the input; computed when first asked for.
  const ExpectedEvents& expectation(Contestant<D, Real>& contestant, std::size_t input) {
    const Reference reference(*contestant.contender->algorithm, contest_.known, case_.boxes,
                              most_tracked_boxes_by_definition);
    contestant.entry->verified_by = reference.text();
    for (const auto& known : expectations_) {
      if (known->reference == reference && known->input == input) return known->events;
    }
    expectations_.push_back(std::make_unique<Expectation>(
        Expectation{reference, input, expected_events(reference, inputs_[input])}));
    return expectations_.back()->events;
  }

  const Case& case_;
  Histories<D, Real> inputs_;
  const Contest& contest_;
  Extremes extremes_;
  std::vector<Contestant<D, Real>> contestants_;
  std::vector<std::unique_ptr<Expectation>> expectations_;
  Events events_;  // of the last update; its memory serves all
};

}  // namespace

template <int D, typename Real>
std::vector<Measurement> measure_track(const Case& of, Histories<D, Real> inputs, const Contest& contest) {
  return TrackCase<D, Real>(of, inputs, contest).run();
}

template std::vector<Measurement> measure_track<2, float>(const Case&, Histories<2, float>, const Contest&);
template std::vector<Measurement> measure_track<3, float>(const Case&, Histories<3, float>, const Contest&);
template std::vector<Measurement> measure_track<2, double>(const Case&, Histories<2, double>, const Contest&);
template std::vector<Measurement> measure_track<3, double>(const Case&, Histories<3, double>, const Contest&);

}  // namespace broadside::lab
