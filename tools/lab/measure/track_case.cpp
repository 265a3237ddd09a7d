// Measures trackers: every algorithm on the same histories, frame by frame in turns, with all events checked.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "lab/measure/cases.hpp"
#include "lab/measure/evidence.hpp"
#include "lab/measure/expected_events.hpp"
#include "lab/measure/memory.hpp"
#include "lab/measure/rounds.hpp"
#include "lab/measure/samples.hpp"
#include "lab/measure/seen_algorithm.hpp"

namespace broadside::lab {
namespace {

/// The expected events of one input.
struct InputEvents {
  Reference reference;
  std::size_t input;
  ExpectedEvents events;
};

/// An algorithm that takes part.
template <int D, typename Real>
struct TrackParticipant {
  const Entry* entry;
  Measurement* measurement;
  std::unique_ptr<SeenAlgorithm> seen{};
  std::optional<Tracker<D, Real>> tracker{};  // of this pass
  const ExpectedEvents* expected = nullptr;   // of this pass
  EventHasher hasher{};
  std::vector<double> frames_ms{};      // of this pass
  std::vector<double> builds_ms{};      // the first frames of all timed passes
  std::vector<paper::Phases> phases{};  // of this pass
  std::optional<Statistics> counts{};   // the sum of this pass, without the first frame
  std::int64_t pairs = 0;
  Allocation memory{0, 0};  // allocated by the tracker since it was made
  std::size_t max_rounds = no_limit;
  bool plays = false;    // takes part in the current pass
  bool is_long = false;  // has long frames
};

template <int D, typename Real>
class TrackCase {
 public:
  TrackCase(const Case& measured, Histories<D, Real> inputs, const Benchmark& benchmark)
      : case_(measured), inputs_(inputs), benchmark_(benchmark), caches_(benchmark.measure_options.cold) {
    for (const History<D, Real>& input : inputs) {
      extremes_.template take<D, Real>(input.boxes);
      for (const Step<D, Real>& step : input.steps) {
        extremes_.template take<D, Real>(step.boxes);
        extremes_.boxes = std::max(extremes_.boxes, step.size);
      }
    }
    // The maximum cost of checking a whole history, in searches.
    constexpr double searches = 4;
    const auto boxes = static_cast<double>(benchmark.effort.definition_boxes);
    is_by_definition_ = tests_by_definition(inputs[0]) <= searches * boxes * boxes / 2;
  }

  std::vector<Measurement> run() {
    keep_freed_memory();
    for (const Entry& entry : benchmark_.entries) measurements_.push_back(measurement_of(entry));
    for (std::size_t i = 0; i < measurements_.size(); ++i) {
      measurements_[i].samples_per_round = inputs_[0].steps.size();
      if (is_eligible(benchmark_.entries[i], measurements_[i]))
        participants_.push_back(
            {&benchmark_.entries[i], &measurements_[i],
             std::make_unique<SeenAlgorithm>(*benchmark_.entries[i].algorithm, SeenAlgorithm::Sees::followers,
                                             benchmark_.measure_options.phases)});
    }
    warm_up();
    for (std::size_t round = 0; has_time(benchmark_.effort, round, watch_.milliseconds()) && play(round);
         ++round) {
    }
    for (TrackParticipant<D, Real>& participant : participants_) tear_down(participant);
    benchmark_.watch.at("counting agreement");
    std::vector<Reference> references;
    for (const auto& known : expectations_) references.push_back(known->reference);
    count_agreement(measurements_, references);
    return std::move(measurements_);
  }

 private:
  /// Whether the entry can take part; if not, fills in the reason.
  bool is_eligible(const Entry& entry, Measurement& measurement) {
    const History<D, Real>& history = inputs_[0];
    benchmark_.watch.at(measurement.algorithm + ", checking its limits");
    measurement.reason = unfit(entry, D, extremes_);
    if (!measurement.reason.empty()) return false;
    const double budget = benchmark_.effort.history_seconds;
    const auto history_seconds = [&](std::size_t count) {
      benchmark_.watch.at(fmt::format("{}, trying {} boxes", measurement.algorithm, count));
      return seconds_of(entry, thinned(history, count, 2));
    };
    attempt(measurement, [&]() -> std::string {
      // A history cannot stop half way, so its frames share the budget.
      if (const auto estimate = estimate_above(budget, case_.boxes, history_seconds))
        skip(measurement, *estimate, case_.frames + 1, budget);
      return {};
    });
    return measurement.reason.empty();
  }

  /// Seconds for all of the case's frames, extrapolated from a history's first frame and the mean of its
  /// others. Short times, which are easily disturbed, are measured twice, and the shorter one counts.
  double seconds_of(const Entry& entry, const History<D, Real>& history) {
    constexpr double is_short = 0.02;  // for all frames
    double min_time = INFINITY;
    for (int attempt = 0; attempt < 3; ++attempt) {
      if (attempt > 0 && min_time > is_short) break;
      Tracker<D, Real> tracker(*entry.algorithm, entry.spec);
      benchmark_.watch.ask_within(tracker);
      std::vector<Box<D, Real>> boxes = history.boxes;
      const double first = update(tracker, {boxes, {}});
      double others = 0;
      for (const Step<D, Real>& step : history.steps) {
        apply(step, boxes);
        others += update(tracker, {boxes, step.changed});
      }
      const double frames = static_cast<double>(case_.frames) /
                            static_cast<double>(std::max<std::size_t>(history.steps.size(), 1));
      min_time = std::min(min_time, (first + others * frames) / 1e3);
    }
    return min_time;
  }

  /// Times one frame, in milliseconds. Sets events_ and statistics_.
  double update(Tracker<D, Real>& tracker, const Frame<D, Real>& frame) {
    events_.begun.clear();
    events_.ended.clear();
    PairCollector begun(events_.begun);
    PairCollector ended(events_.ended);
    caches_.settle(std::as_bytes(frame.boxes));
    const Stopwatch watch;
    statistics_ = tracker.update(frame, begun, ended);
    return watch.milliseconds();
  }

  /// Runs every participant over the first input once, untimed, so that it allocates its memory, which is
  /// counted.
  void warm_up() {
    for (TrackParticipant<D, Real>& participant : participants_) participant.plays = true;
    pass(0, 0, true);
    for (TrackParticipant<D, Real>& participant : participants_) {
      if (!participant.plays) continue;
      Measurement& measurement = *participant.measurement;
      measurement.outcome = Outcome::verified;
      measurement.pairs = static_cast<std::uint64_t>(participant.pairs);
      measurement.pair_hash = participant.hasher.hash();
      measurement.explanation =
          explanation_of(*participant.entry->algorithm, participant.tracker->explanation());
      participant.builds_ms.clear();
    }
  }

  /// Runs every participant of this round over the same input; false if there are none.
  bool play(std::size_t round) {
    for (TrackParticipant<D, Real>& participant : participants_)
      participant.plays =
          has_another_round(*participant.measurement, benchmark_.effort, participant.max_rounds);
    if (std::ranges::none_of(participants_, &TrackParticipant<D, Real>::plays)) return false;
    pass(round % inputs_.size(), round + 1, false);
    for (TrackParticipant<D, Real>& participant : participants_) {
      if (!participant.plays) continue;
      Measurement& measurement = *participant.measurement;
      measurement.samples_ms.insert(measurement.samples_ms.end(), participant.frames_ms.begin(),
                                    participant.frames_ms.end());
      measurement.phases.insert(measurement.phases.end(), participant.phases.begin(),
                                participant.phases.end());
      measurement.build_ms = median(participant.builds_ms);
    }
    if (round > 0) return true;
    for (TrackParticipant<D, Real>& participant : participants_) {
      participant.max_rounds = round_limit(*participant.measurement, measurements_, benchmark_.effort,
                                           benchmark_.effort.slow_history_seconds);
    }
    return true;
  }

  /// Runs the playing participants over an input from its first frame to its last, frame by frame in turns.
  /// The order of turns depends on `number`, the number of the pass.
  void pass(std::size_t input, std::size_t number, bool counts_memory) {
    const History<D, Real>& history = inputs_[input];
    std::vector<Box<D, Real>> boxes = history.boxes;
    for (TrackParticipant<D, Real>& participant : participants_) {
      if (!participant.plays) continue;
      participant.expected = &expectation(participant, input);
      tear_down(participant);
      participant.frames_ms.clear();
      participant.phases.clear();
      participant.counts.reset();
    }
    for (std::size_t frame = 0; frame <= history.steps.size(); ++frame) {
      if (frame > 0) apply(history.steps[frame - 1], boxes);
      const Frame<D, Real> now{boxes,
                               frame == 0 ? std::span<const BoxId>() : history.steps[frame - 1].changed};
      for (const std::size_t turn :
           turns(participants_.size(), number * (history.steps.size() + 1) + frame)) {
        TrackParticipant<D, Real>& participant = participants_[turn];
        if (!participant.plays) continue;
        benchmark_.watch.at(fmt::format("{}, frame {}", participant.measurement->algorithm, frame));
        participant.plays =
            attempt(*participant.measurement, [&] { return take(participant, now, frame, counts_memory); });
      }
    }
    for (TrackParticipant<D, Real>& participant : participants_) {
      if (participant.plays) note_statistics(participant, input);
    }
  }

  void tear_down(TrackParticipant<D, Real>& participant) const {
    benchmark_.watch.at(participant.measurement->algorithm + ", tearing down");
    participant.tracker.reset();
  }

  /// One frame of one participant; returns the fault of its events.
  std::string take(TrackParticipant<D, Real>& participant, const Frame<D, Real>& now, std::size_t frame,
                   bool counts_memory) {
    const ExpectedEvents& expected = *participant.expected;
    if (!expected.fault.empty()) return expected.fault;
    touch(std::max(expected.frames[frame].begun.size(), expected.frames[frame].ended.size()));
    const auto make_and_update = [&] {
      if (!participant.tracker) {
        participant.tracker.emplace(participant.seen->algorithm(), participant.entry->spec);
        benchmark_.watch.ask_within(*participant.tracker, counts_memory || participant.is_long);
      }
      return update(*participant.tracker, now);
    };
    const double milliseconds = counts_memory ? counted(participant, make_and_update) : make_and_update();
    participant.is_long |= milliseconds >= min_asking_ms;
    (frame > 0 ? participant.frames_ms : participant.builds_ms).push_back(milliseconds);
    if (counts_memory) note(participant);
    if (frame > 0) note_frame(participant);
    return difference<D, Real>(events_, expected.frames[frame], participant.measurement->algorithm, frame,
                               now.boxes);
  }

  /// Writes to the memory for `count` events of each kind, so that no timed update has page faults there.
  void touch(std::size_t count) {
    if (count <= touched_) return;
    touched_ = count + count / 8;
    events_.begun.resize(touched_);
    events_.ended.resize(touched_);
  }

  /// Runs one frame and adds the memory it allocates to the participant's.
  template <typename Run>
  double counted(TrackParticipant<D, Real>& participant, const Run& run) {
    const AllocationMeter meter;
    const double milliseconds = run();
    if (const auto allocation = meter.read()) {
      Allocation& memory = participant.memory;
      memory.peak = std::max(memory.peak, memory.kept + allocation->peak);
      memory.kept += allocation->kept;
      count_memory(*participant.measurement, *participant.entry->algorithm, memory);
    }
    return milliseconds;
  }

  /// During the warm-up: adds the frame's events to the hash and to the number of pairs.
  void note(TrackParticipant<D, Real>& participant) {
    participant.hasher.add(events_);
    participant.pairs +=
        static_cast<std::int64_t>(events_.begun.size()) - static_cast<std::int64_t>(events_.ended.size());
  }

  /// Stores the phases and counts of one frame after the first.
  void note_frame(TrackParticipant<D, Real>& participant) {
    if (const paper::Phases* const phases = participant.seen->phases()) participant.phases.push_back(*phases);
    if (!statistics_) return;
    if (!participant.counts) participant.counts.emplace();
    participant.counts->tests += statistics_->tests;
    participant.counts->references += statistics_->references;
  }

  /// Stores the mean counts per frame of the finished pass.
  void note_statistics(TrackParticipant<D, Real>& participant, std::size_t input) {
    if (!participant.counts) return;
    const std::size_t frames = inputs_[input].steps.size();
    const Statistics mean{participant.counts->tests / frames, participant.counts->references / frames};
    std::vector<std::optional<Statistics>>& all = participant.measurement->statistics_by_seed;
    all.resize(inputs_.size());
    all[input] = mean;
    if (input == 0) participant.measurement->statistics = mean;
  }

  /// The expected events of the participant on the input; computed on first use.
  const ExpectedEvents& expectation(TrackParticipant<D, Real>& participant, std::size_t input) {
    const Reference reference(*participant.entry->algorithm, benchmark_.known, case_.boxes,
                              is_by_definition_ ? case_.boxes : 0);
    participant.measurement->evidence = Evidence{reference.is_definition()};
    for (const auto& known : expectations_) {
      if (known->reference == reference && known->input == input) return known->events;
    }
    benchmark_.watch.at("making the reference: " + reference.text());
    ExpectedEvents events = expected_events(reference, inputs_[input], [this] { benchmark_.watch.ask(); });
    for (const auto& known : expectations_) {
      if (known->input == input && events.fault.empty())
        events.fault = disagreement(reference, events, *known);
    }
    expectations_.push_back(std::make_unique<InputEvents>(InputEvents{reference, input, std::move(events)}));
    return expectations_.back()->events;
  }

  /// The difference between two references on the same input; empty if they agree.
  std::string disagreement(const Reference& reference, const ExpectedEvents& events,
                           const InputEvents& other) const {
    for (std::size_t frame = 0; frame < events.frames.size(); ++frame) {
      if (std::string fault = difference<D, Real>(
              events.frames[frame], other.events.frames[frame],
              fmt::format("reference: {} beside {}", reference.text(), other.reference.text()), frame,
              inputs_[other.input].boxes);
          !fault.empty())
        return fault;
    }
    return {};
  }

  const Case& case_;
  Histories<D, Real> inputs_;
  const Benchmark& benchmark_;
  Extremes extremes_;
  bool is_by_definition_ = false;
  std::vector<Measurement> measurements_;  // of the entries, in their order
  std::vector<TrackParticipant<D, Real>> participants_;
  std::vector<std::unique_ptr<InputEvents>> expectations_;
  FrameEvents events_;                    // of the last update; the memory is reused for all
  std::optional<Statistics> statistics_;  // likewise
  std::size_t touched_ = 0;               // how many events of that memory have been written to
  CacheState caches_;
  Stopwatch watch_;
};

}  // namespace

template <int D, typename Real>
std::vector<Measurement> measure_track(const Case& measured, Histories<D, Real> inputs,
                                       const Benchmark& benchmark) {
  return TrackCase<D, Real>(measured, inputs, benchmark).run();
}

template std::vector<Measurement> measure_track<2, float>(const Case&, Histories<2, float>, const Benchmark&);
template std::vector<Measurement> measure_track<3, float>(const Case&, Histories<3, float>, const Benchmark&);
template std::vector<Measurement> measure_track<2, double>(const Case&, Histories<2, double>,
                                                           const Benchmark&);
template std::vector<Measurement> measure_track<3, double>(const Case&, Histories<3, double>,
                                                           const Benchmark&);

}  // namespace broadside::lab
