// The equivalence test on a history of boxes: every algorithm in every frame.
#include "lab/verify/verify_history.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "broadside/sinks.hpp"

#include "lab/measure/benchmark.hpp"
#include "lab/measure/reference.hpp"
#include "lab/measure/rounds.hpp"
#include "lab/verify/verify.hpp"

namespace broadside::lab {
namespace {

/// The maximum number of brute-force tests over all frames: takes a few seconds.
constexpr double max_tests_by_definition = 4e9;

/// The pairs that some entries should report in the current frame.
struct Expectation {
  Reference reference;
  std::vector<Pair> before{};  // sorted
  std::vector<Pair> now{};
  EntryVerdict fault{};  // of the reference itself; without an algorithm if there is none
};

template <int D, typename Real>
struct HistoryParticipant {
  const Entry* entry;
  std::size_t verdict;  // its index in the list of verdicts
  Expectation* expected;
  Finder<D, Real> finder;
  std::optional<Tracker<D, Real>> tracker{};  // empty for a single frame
  double spent_ms = 0;
  bool done = false;
};

template <int D, typename Real>
class HistoryCheck {
 public:
  HistoryCheck(const History<D, Real>& history, std::span<const Entry> entries,
               std::span<const Algorithm> known, const VerifyOptions& options)
      : history_(history), known_(known), options_(options) {
    look_through();
    for (const Entry& entry : entries) let_in(entry);
  }

  HistoryVerdicts run() {
    std::vector<Box<D, Real>> boxes = history_.boxes;
    for (std::size_t frame = 0; frame <= history_.steps.size(); ++frame) {
      if (frame > 0) lab::apply(history_.steps[frame - 1], boxes);
      if (std::ranges::all_of(participants_, &HistoryParticipant<D, Real>::done)) break;
      check_frame(boxes, frame);
    }
    for (const auto& expected : expectations_) {
      add_fault(expected->fault);
      if (!expected->fault.algorithm.empty()) result_.pairs.reset();
    }
    return std::move(result_);
  }

 private:
  /// Finds the fullest frame, and the extremes that may be beyond limits.
  void look_through() {
    std::vector<Box<D, Real>> boxes = history_.boxes;
    fullest_ = boxes;
    extremes_.take<D, Real>(boxes);
    for (const Step<D, Real>& step : history_.steps) {
      lab::apply(step, boxes);
      extremes_.take<D, Real>(step.boxes);
      extremes_.boxes = std::max(extremes_.boxes, boxes.size());
      if (boxes.size() > fullest_.size()) fullest_ = boxes;
    }
  }

  void let_in(const Entry& entry) {
    EntryVerdict verdict{.algorithm = entry.spec.text()};
    verdict.reason = unfit(entry, D, extremes_);
    if (verdict.reason.empty()) verdict.reason = too_slow(entry);
    if (!verdict.reason.empty()) {
      verdict.outcome = Outcome::skipped;
    } else {
      Expectation& expected = expectation_for(*entry.algorithm);
      verdict.verified_by = expected.reference.text();
      HistoryParticipant<D, Real> participant{&entry, result_.verdicts.size(), &expected,
                                              Finder<D, Real>(*entry.algorithm, entry.spec)};
      if (!history_.steps.empty()) participant.tracker.emplace(*entry.algorithm, entry.spec);
      participants_.push_back(std::move(participant));
    }
    result_.verdicts.push_back(std::move(verdict));
  }

  /// Why the budget does not suffice for one search of the fullest frame; empty if it does.
  std::string too_slow(const Entry& entry) {
    const std::string name = entry.spec.text();
    const auto seconds_for = [&](std::size_t count) {
      options_.watch.at(fmt::format("{}, trying {} boxes", name, count));
      std::vector<Box<D, Real>> some;
      for (const std::size_t i : sample_of(fullest_.size(), count)) some.push_back(fullest_[i]);
      PairCounter counter;
      const Stopwatch watch;
      Finder<D, Real>(*entry.algorithm, entry.spec).find(some, counter);
      return watch.milliseconds() / 1e3;
    };
    std::string reason;
    const std::string fault = fault_of(name, [&]() -> std::string {
      if (const auto estimate = estimate_above(options_.budget_seconds, fullest_.size(), seconds_for))
        reason = fmt::format("{}; budget {:g} s", text(*estimate), options_.budget_seconds);
      return {};
    });
    // An algorithm that throws on some boxes should do so in the check that reports it.
    return fault.empty() ? reason : "";
  }

  Expectation& expectation_for(const Algorithm& algorithm) {
    const Reference reference(algorithm, known_, fullest_.size(),
                              max_by_definition(history_.steps.size() + 1));
    for (const auto& known : expectations_) {
      if (known->reference == reference) return *known;
    }
    expectations_.push_back(std::make_unique<Expectation>(Expectation{reference}));
    return *expectations_.back();
  }

  void check_frame(std::span<const Box<D, Real>> boxes, std::size_t frame) {
    for (const auto& expected : expectations_) {
      options_.watch.at(fmt::format("{}, frame {}", expected->reference.text(), frame));
      expected->before = std::move(expected->now);
      expected->now = expected->reference.template pairs<D, Real>(boxes);
      check_reference(*expected, boxes, frame);
      if (frame == history_.steps.size()) result_.pairs = expected->now.size();
    }
    for (HistoryParticipant<D, Real>& participant : participants_) {
      if (participant.done) continue;
      EntryVerdict& verdict = result_.verdicts[participant.verdict];
      options_.watch.at(fmt::format("{}, frame {}", verdict.algorithm, frame));
      verdict.frames = frame + 1;
      const std::string fault = fault_of(verdict.algorithm, [&] { return check(participant, boxes, frame); });
      const bool is_last = frame == history_.steps.size();
      if (!fault.empty()) {
        verdict.outcome = Outcome::failed;
        verdict.reason = fault;
        participant.done = true;
      } else if (!participant.expected->fault.algorithm.empty()) {
        verdict.outcome = Outcome::skipped;
        verdict.reason = participant.expected->fault.algorithm + ", which it was compared with, failed";
        participant.done = true;
      } else if (!is_last && participant.spent_ms > options_.budget_seconds * 1e3) {
        verdict.reason = fmt::format("frames 0 to {} of {}; budget {:g} s", frame, history_.steps.size(),
                                     options_.budget_seconds);
        participant.done = true;
      }
    }
  }

  /// Compares a sample with brute force if the expected pairs are not from brute force.
  void check_reference(Expectation& expected, std::span<const Box<D, Real>> boxes, std::size_t frame) {
    if (expected.reference.is_definition()) return;
    const std::size_t every = std::max<std::size_t>(history_.steps.size() / sampled_frames, 1);
    if (frame % every != 0 && frame != history_.steps.size()) return;
    auto divergence = check_sample<D, Real>(boxes, expected.now);
    if (divergence) blame_reference(expected, *std::move(divergence), boxes, frame);
  }

  /// Records that a reference is wrong.
  void blame_reference(Expectation& expected, PairDivergence divergence, std::span<const Box<D, Real>> boxes,
                       std::size_t frame) {
    const std::string& name = expected.reference.algorithm()->name;
    expected.fault = {.algorithm = name,
                      .outcome = Outcome::failed,
                      .verified_by = "the definition",
                      .reason = explained<D, Real>(std::move(divergence), name, "search:", frame, boxes).text,
                      .frames = frame + 1};
  }

  /// Adds the fault of a reference, unless it has already failed as an entry.
  void add_fault(const EntryVerdict& fault) {
    const auto same = [&](const EntryVerdict& other) {
      return other.algorithm == fault.algorithm && other.outcome == Outcome::failed;
    };
    if (!fault.algorithm.empty() && std::ranges::none_of(result_.verdicts, same))
      result_.verdicts.push_back(fault);
  }

  /// The fault of a participant in one frame.
  std::string check(HistoryParticipant<D, Real>& participant, std::span<const Box<D, Real>> boxes,
                    std::size_t frame) {
    const std::string name = participant.entry->spec.text();
    Expectation& expected = *participant.expected;
    std::vector<Pair> found;
    PairCollector collector(found);
    const Stopwatch search;
    participant.finder.find(boxes, collector);
    participant.spent_ms += search.milliseconds();
    if (auto divergence = compare_pairs(std::move(found), expected.now)) {
      if (is_right_about(*divergence, boxes)) {
        blame_reference(expected, swapped(*divergence), boxes, frame);
        return {};
      }
      return explained<D, Real>(*std::move(divergence), name, "search:", frame, boxes).text;
    }
    if (!participant.tracker) return {};
    std::vector<Pair> begun;
    std::vector<Pair> ended;
    PairCollector begun_pairs(begun);
    PairCollector ended_pairs(ended);
    const Stopwatch update;
    participant.tracker->update(
        {boxes, frame == 0 ? std::span<const BoxId>() : history_.steps[frame - 1].changed}, begun_pairs,
        ended_pairs);
    participant.spent_ms += update.milliseconds();
    const auto divergence =
        check_events<D, Real>(begun, ended, expected.before, expected.now, name, frame, boxes);
    return divergence ? divergence->text : "";
  }

  /// Whether, by brute force, the participant is right and its expected result wrong.
  static bool is_right_about(const PairDivergence& divergence, std::span<const Box<D, Real>> boxes) {
    const std::size_t first = index(divergence.pair.first);
    const std::size_t second = index(divergence.pair.second);
    if (divergence.kind == PairDivergence::Kind::repeated || first >= second || second >= boxes.size())
      return false;
    const bool is_pair =
        is_present(boxes[first]) && is_present(boxes[second]) && overlap(boxes[first], boxes[second]);
    return is_pair == (divergence.kind == PairDivergence::Kind::extra);
  }

  /// The divergence from the reference's point of view.
  static PairDivergence swapped(const PairDivergence& divergence) {
    return *compare_pairs(divergence.kind == PairDivergence::Kind::extra ? std::vector<Pair>()
                                                                         : std::vector<Pair>{divergence.pair},
                          divergence.kind == PairDivergence::Kind::extra ? std::span(&divergence.pair, 1)
                                                                         : std::span<const Pair>());
  }

  const History<D, Real>& history_;
  std::span<const Algorithm> known_;
  const VerifyOptions& options_;
  std::vector<Box<D, Real>> fullest_;  // the boxes of the frame with the most places
  Extremes extremes_;
  std::vector<std::unique_ptr<Expectation>> expectations_;
  std::vector<HistoryParticipant<D, Real>> participants_;
  HistoryVerdicts result_;
};

}  // namespace

std::size_t max_by_definition(std::size_t frames) noexcept {
  const double max_boxes = std::sqrt(2 * max_tests_by_definition / static_cast<double>(frames));
  return std::min(static_cast<std::size_t>(max_boxes), Effort{}.definition_boxes);
}

template <int D, typename Real>
HistoryVerdicts verify_history(const History<D, Real>& history, std::span<const Entry> entries,
                               std::span<const Algorithm> known, const VerifyOptions& options) {
  return HistoryCheck<D, Real>(history, entries, known, options).run();
}

template HistoryVerdicts verify_history(const History<2, float>&, std::span<const Entry>,
                                        std::span<const Algorithm>, const VerifyOptions&);
template HistoryVerdicts verify_history(const History<2, double>&, std::span<const Entry>,
                                        std::span<const Algorithm>, const VerifyOptions&);
template HistoryVerdicts verify_history(const History<3, float>&, std::span<const Entry>,
                                        std::span<const Algorithm>, const VerifyOptions&);
template HistoryVerdicts verify_history(const History<3, double>&, std::span<const Entry>,
                                        std::span<const Algorithm>, const VerifyOptions&);

}  // namespace broadside::lab
