// Sentences that explain, from the signals and the times, why an algorithm is advised and the others are not.
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "lab/advise/advise.hpp"
#include "lab/measure/ranking.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab {
namespace {

/// Boxes count as clustered if this many times as many are near each other as if spread evenly.
constexpr double clustered = 2;

/// Sizes count as alike if 99 % of the boxes are at most this many times as long as the median.
constexpr double alike = 4;

/// Sentences call an algorithm no slower if it takes at most this many times the time.
constexpr double as_fast = 1.05;
constexpr std::size_t max_others = 5;

/// A count explains a time difference if it is at least this many times the other count.
constexpr double clearly = 1.2;

std::string base_of(std::string_view spec) { return std::string(spec.substr(0, spec.find(':'))); }

std::optional<double> tests_of(const Measurement& measurement, const Signals& signals) {
  if (!measurement.statistics || measurement.statistics->tests == 0 || signals.boxes == 0) return {};
  return static_cast<double>(measurement.statistics->tests) / static_cast<double>(signals.boxes);
}

std::string tests_text(const Measurement& measurement, const Signals& signals) {
  const auto tests = tests_of(measurement, signals);
  return tests ? fmt::format("{} tests a box", rounded(*tests)) : "tests that it does not count";
}

/// Which property of the boxes suits the algorithm.
std::string suits(const std::string& algorithm, const Measurement& measurement, const Signals& signals) {
  const std::string tests = tests_text(measurement, signals);
  if (algorithm == "brute_force")
    return signals.motion ? fmt::format("comparing what changed with all {} boxes needs no structure",
                                        grouped(signals.boxes))
                          : fmt::format("{} are so few that comparing all costs less than sorting them",
                                        counted(signals.boxes, "box", "boxes"));
  if (algorithm == "sweep_and_prune") {
    const std::size_t axis = signals.best_axis();
    return fmt::format("along {} only {} intervals overlap a box's: {}", axis_name(axis),
                       rounded(signals.axis_tests[axis]), tests);
  }
  if (algorithm == "bvh") {
    if (signals.clustering >= clustered)
      return fmt::format("boxes form clusters, to which its bounds fit themselves: {}", tests);
    if (signals.overlaps.value_or(0) >= 6)
      return fmt::format("a box overlaps {} others, which cells would only repeat: {}",
                         rounded(*signals.overlaps), tests);
    return fmt::format("its bounds fit themselves to the boxes: {}", tests);
  }
  if (algorithm == "grid") {
    const bool even = signals.sizes[4] <= alike * signals.sizes[2];
    if (signals.clustering < clustered && even)
      return fmt::format("boxes of much the same size, spread evenly, suit its cells: {}", tests);
    if (even) return fmt::format("boxes of much the same size suit its cells: {}", tests);
    return fmt::format("its levels of cells take small boxes and large ones: {}", tests);
  }
  return fmt::format("it makes {}", tests);
}

/// The tests that remain for a sweep along the best axis, and for stripes of a second axis if these leave
/// fewer.
std::string sweep_text(double tests, const Signals& signals) {
  const std::size_t axis = signals.best_axis();
  const double along = signals.axis_tests[axis];
  if (signals.motion || tests > 0.8 * along)
    return fmt::format("its best axis, {}, leaves {} tests a box", axis_name(axis), rounded(tests));
  return fmt::format("its best axis, {}, leaves {} tests a box, and stripes of another one {}",
                     axis_name(axis), rounded(along), rounded(tests));
}

/// Why an algorithm is slower than the chosen one, if their counts show it; otherwise empty.
std::string hinders(const RankedAlgorithm& slow, const RankedAlgorithm& chosen, const Signals& signals) {
  const Measurement& of = slow.measurement;
  const Measurement& best = chosen.measurement;
  const std::string name = base_of(of.algorithm);
  const auto tests = tests_of(of, signals);
  const auto fewest = tests_of(best, signals);
  if (chosen.is_variant && !slow.is_variant && name == base_of(best.algorithm)) {
    if (tests && fewest && std::abs(*tests - *fewest) <= 0.01 * *fewest)
      return fmt::format("it chooses by itself about what {} sets by hand, and that takes the time",
                         best.algorithm);
    return fmt::format("what is set by hand in {} suits these boxes better than what it chooses itself",
                       best.algorithm);
  }
  const bool has_more_tests = tests && fewest && *tests >= clearly * *fewest;
  if (has_more_tests && name == "brute_force" && !signals.motion)
    return fmt::format("it tests each box against all others, {} tests a box", rounded(*tests));
  if (has_more_tests && name == "sweep_and_prune") return sweep_text(*tests, signals);
  if (has_more_tests)
    return fmt::format("it makes {} tests a box where {} makes {}", rounded(*tests), best.algorithm,
                       rounded(*fewest));
  return "";
}

/// Why auto takes longer than the advised algorithm, `name`.
std::string what_auto_takes(const Measurement& chooser, const std::string& name, Mode mode) {
  const std::string& what = chooser.explanation;
  if (what.empty()) return "";
  if (mode == Mode::track) return "in the last frame, " + what;
  if (what.substr(0, what.find_first_of(",: ")) == name)
    return fmt::format("it takes {} as well, once it has sampled the boxes", name);
  return "it takes " + what;
}

/// The fastest manually set variant that is faster than the advised algorithm by more than as_fast; null if
/// there is none.
const RankedAlgorithm* faster_variant(const Advice& advice) {
  const RankedAlgorithm* fastest = nullptr;
  for (const RankedAlgorithm& ranked : advice.ranking) {
    if (!ranked.is_variant || !is_timed(ranked.measurement) ||
        ranked.milliseconds * as_fast > advice.milliseconds)
      continue;
    if (fastest == nullptr || ranked.milliseconds < fastest->milliseconds) fastest = &ranked;
  }
  return fastest;
}

/// "1.2 times".
std::string times(double ratio) { return ratio_text(ratio) + " times"; }

}  // namespace

std::vector<std::string> reasons_of(const Advice& advice) {
  std::vector<std::string> reasons;
  if (!advice.choice) return reasons;
  const AlgorithmChoice& choice = *advice.choice;
  const Measurement& chosen = advice.ranking[choice.chosen].measurement;
  const Measurement& fastest = advice.ranking[choice.fastest_plain].measurement;
  const std::string name = base_of(chosen.algorithm);
  const double time = advice.milliseconds;
  const double min_time = advice.ranking[choice.fastest_plain].milliseconds;
  if (advice.signals.boxes < 2 && !advice.signals.motion)
    return {fmt::format(
        "with fewer than two boxes there are no pairs, whatever finds them; {} chooses once there are",
        default_algorithm)};
  switch (choice.why) {
    case ChoiceReason::automatic: {
      std::string text =
          choice.chosen == choice.fastest_plain
              ? fmt::format("{} is the fastest that sets its own options", chosen.algorithm)
              : fmt::format(
                    "{} takes {} the time of {}, the fastest that sets its own options, which is "
                    "within what repeated measurements differ by",
                    chosen.algorithm, times(time / min_time), fastest.algorithm);
      text += ", and it chooses anew when the boxes change";
      if (!chosen.explanation.empty())
        text += fmt::format(". {}: {}", advice.mode == Mode::find ? "For these boxes" : "In the last frame",
                            chosen.explanation);
      reasons.push_back(text);
      break;
    }
    case ChoiceReason::fastest:
      reasons.push_back(fmt::format("{} is the fastest that sets its own options: {}", chosen.algorithm,
                                    suits(name, chosen, advice.signals)));
      break;
    case ChoiceReason::variant:
      reasons.push_back(
          fmt::format("{} takes {:.0f} % less time than {}, the fastest that sets its own options, and is "
                      "faster in {:.0f} % of the rounds; it is for boxes like these only",
                      chosen.algorithm, (1 - time / min_time) * 100, fastest.algorithm,
                      part_of_rounds(chosen, fastest) * 100));
      break;
  }
  if (const RankedAlgorithm* const faster = faster_variant(advice)) {
    reasons.push_back(fmt::format(
        "{} takes {} the time, but it is for boxes like these only, and was faster in {:.0f} % of "
        "the rounds; advised only if in {:.0f} %, and by {:.0f} %",
        faster->measurement.algorithm, times(faster->milliseconds / time),
        100 * part_of_rounds(faster->measurement, fastest), 100 * rounds_of_variants,
        100 * (1 - 1 / margin_of_variants)));
  }
  std::size_t others = 0;
  for (const RankedAlgorithm& ranked : advice.ranking) {
    const Measurement& other = ranked.measurement;
    if (ranked.is_variant || &other == &chosen || !is_timed(other) || is_foreign(other.kind)) continue;
    const double ratio = ranked.milliseconds / time;
    if (ratio <= as_fast || ++others > max_others) continue;
    const std::string why = base_of(other.algorithm) == default_algorithm
                                ? what_auto_takes(other, name, advice.mode)
                                : hinders(ranked, advice.ranking[choice.chosen], advice.signals);
    reasons.push_back(
        fmt::format("{} takes {} as long{}{}", other.algorithm, times(ratio), why.empty() ? "" : ": ", why));
  }
  if (choice.peer) {
    const Measurement& peer = advice.ranking[*choice.peer].measurement;
    reasons.push_back(fmt::format(
        "{}, which is not part of Broadside's library, is faster here: {} takes {} as long as it",
        peer.algorithm, chosen.algorithm, times(time / advice.ranking[*choice.peer].milliseconds)));
  }
  return reasons;
}

namespace {

const RankedAlgorithm* find(const Advice& advice, std::string_view spec) {
  for (const RankedAlgorithm& ranked : advice.ranking) {
    if (ranked.measurement.algorithm == spec && is_timed(ranked.measurement)) return &ranked;
  }
  return nullptr;
}

/// The moving fraction from which searching anew is faster, computed from the measured times of both ways.
std::string break_even(const Advice& advice) {
  const RankedAlgorithm* const rebuild = find(advice, "auto:update=rebuild");
  const RankedAlgorithm* const follow = find(advice, "auto:update=follow");
  const double moving = advice.signals.motion ? advice.signals.motion->moving : 0;
  if (rebuild == nullptr || follow == nullptr || !(moving > 0)) return "";
  const double anew = rebuild->milliseconds;
  const double followed = follow->milliseconds;
  const std::string both =
      fmt::format("following what moves in every frame takes {} a frame, finding all anew in every frame {}",
                  duration(followed / 1e3), duration(anew / 1e3));
  const double from = moving * anew / followed;
  if (followed < anew && from >= 1) return fmt::format("{}: following pays however many boxes move", both);
  return fmt::format(
      "{}: if each mover costs what it does here, finding anew is the cheaper way from about {:.2g} % moving "
      "on "
      "(here {:.3g} % in the mean); auto decides it frame by frame",
      both, from * 100, moving * 100);
}

}  // namespace

std::vector<std::string> changes_of(const Advice& advice) {
  std::vector<std::string> changes;
  if (!advice.choice) return changes;
  const Measurement& chosen = advice.ranking[advice.choice->chosen].measurement;
  const double time = advice.milliseconds;
  if (const std::string text = break_even(advice); !text.empty()) changes.push_back(text);
  const RankedAlgorithm* leanest = nullptr;
  const RankedAlgorithm* steadiest = nullptr;
  for (const RankedAlgorithm& ranked : advice.ranking) {
    const Measurement& other = ranked.measurement;
    if (!is_timed(other) || is_foreign(other.kind) || ranked.is_variant || &other == &chosen) continue;
    if (chosen.peak_bytes && other.peak_bytes && *other.peak_bytes * 5 <= *chosen.peak_bytes * 3 &&
        ranked.milliseconds <= 8 * time && *chosen.peak_bytes > 1'000'000 &&
        (leanest == nullptr || *other.peak_bytes < *leanest->measurement.peak_bytes))
      leanest = &ranked;
    if (advice.mode == Mode::track && ranked.milliseconds <= 1.3 * time &&
        percentile(other.samples_ms, 0.99) * 1.5 <= percentile(chosen.samples_ms, 0.99) &&
        (steadiest == nullptr ||
         percentile(other.samples_ms, 0.99) < percentile(steadiest->measurement.samples_ms, 0.99)))
      steadiest = &ranked;
  }
  if (leanest != nullptr)
    changes.push_back(
        fmt::format("if memory matters more than time: {} holds at most {} where {} holds {}, "
                    "at {} the time",
                    leanest->measurement.algorithm, bytes(*leanest->measurement.peak_bytes), chosen.algorithm,
                    bytes(*chosen.peak_bytes), times(leanest->milliseconds / time)));
  if (steadiest != nullptr)
    changes.push_back(fmt::format(
        "if the slowest frames matter most: {} has a p99 of {} where {} has {}, at {} the median",
        steadiest->measurement.algorithm, duration(percentile(steadiest->measurement.samples_ms, 0.99) / 1e3),
        chosen.algorithm, duration(percentile(chosen.samples_ms, 0.99) / 1e3),
        times(steadiest->milliseconds / time)));
  return changes;
}

}  // namespace broadside::lab
