// Signals and advice as text.
#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "lab/advise/advise.hpp"
#include "lab/measure/ranking.hpp"
#include "lab/measure/samples.hpp"
#include "lab/measure/steadiness.hpp"
#include "lab/numbers.hpp"
#include "lab/report/aligned_columns.hpp"

namespace broadside::lab {
namespace {

std::string percent(double part) { return fmt::format("{:.3g} %", part * 100); }

std::string motion_text(const MotionSignals& motion) {
  std::string text = fmt::format("In {} after the first, {} of the boxes move in the mean ({} to {})",
                                 counted(motion.frames, "frame", "frames"), percent(motion.moving),
                                 percent(motion.min_moving), percent(motion.max_moving));
  if (motion.drift)
    text += fmt::format(", by {} of their longest side in the median", rounded(*motion.drift));
  if (motion.jumps > 0)
    text +=
        fmt::format("; {} of the moves are jumps of over {} sides", percent(motion.jumps), sides_of_a_jump);
  if (motion.added + motion.removed > 0)
    text += fmt::format("; {} come and {} go a frame", rounded(motion.added), rounded(motion.removed));
  return text + ".";
}

std::string verdict_with_reason(const Measurement& measurement) {
  if (measurement.outcome == Outcome::verified) return "verified";
  if (measurement.outcome == Outcome::failed) return "FAILED: " + measurement.reason;
  return "skipped: " + measurement.reason;
}

std::string table(const Advice& advice, std::size_t width) {
  const bool moves = advice.mode == Mode::track;
  AlignedColumns columns(moves ? "<>>>>>><" : "<>>>>><");
  std::vector<std::string> head = {
      "spec", moves ? "a frame" : "a call", "ratio", "tests a box", "memory", "peak", ""};
  if (moves) head.insert(head.begin() + 2, "p99");
  columns.add(head);
  const double chosen = advice.milliseconds;
  bool was_finalist = false;
  for (const RankedAlgorithm& ranked : advice.ranking) {
    if (was_finalist && !ranked.is_finalist) columns.add_line("measured in the first, short round only:");
    was_finalist = ranked.is_finalist;
    const Measurement& measurement = ranked.measurement;
    const bool timed = is_timed(measurement);
    const auto memory = [&](const std::optional<std::uint64_t>& count) {
      return timed && count ? bytes(*count) : "-";
    };
    const bool counts = timed && measurement.statistics && advice.signals.boxes > 0;
    const double time = ranked.milliseconds;
    std::vector<std::string> row = {measurement.algorithm,
                                    timed                      ? duration(time / 1e3)
                                    : measurement.estimated_ms ? "~" + duration(time / 1e3)
                                                               : "-",
                                    timed && chosen > 0 ? ratio_text(time / chosen) : "-",
                                    counts ? rounded(static_cast<double>(measurement.statistics->tests) /
                                                     static_cast<double>(advice.signals.boxes))
                                           : "-",
                                    memory(measurement.own_bytes),
                                    memory(measurement.peak_bytes),
                                    verdict_with_reason(measurement)};
    if (moves)
      row.insert(row.begin() + 2, timed ? duration(percentile(measurement.samples_ms, 0.99) / 1e3) : "-");
    columns.add(row);
  }
  return columns.text("  ", width);
}

std::string list(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += fmt::format("  - {}.\n", sentence);
  return text;
}

}  // namespace

std::string text_of(const Signals& signals) {
  std::string text = fmt::format("{} in {}D, as {}s", counted(signals.boxes, "box", "boxes"),
                                 signals.dimension, name(signals.precision));
  if (signals.precision == Precision::float64 && signals.floats_hold_all && signals.boxes > 0)
    text += " that floats hold exactly (--precision float)";
  if (signals.absent > 0) text += fmt::format(", {} absent", grouped(signals.absent));
  if (signals.infinite > 0) text += fmt::format(", {} infinite", grouped(signals.infinite));
  if (signals.points > 0) text += fmt::format(", {}", counted(signals.points, "point", "points"));
  if (signals.flat > 0) text += fmt::format(", {} flat", grouped(signals.flat));
  text += ".";
  if (signals.boxes > signals.infinite)
    text += fmt::format(
        " Their longest sides: {} in the median, half of them {} to {}, 98 % {} to {}, the longest {}.",
        rounded(signals.sizes[2]), rounded(signals.sizes[1]), rounded(signals.sizes[3]),
        rounded(signals.sizes[0]), rounded(signals.sizes[4]), rounded(signals.largest));
  if (signals.overlaps) text += fmt::format(" A box overlaps {} others.", rounded(*signals.overlaps));
  if (signals.boxes > 1) {
    text += " Tests a box that a sweep leaves:";
    for (std::size_t axis = 0; axis < signals.axis_tests.size(); ++axis)
      text += fmt::format("{} {} along {}", axis > 0 ? "," : "", rounded(signals.axis_tests[axis]),
                          axis_name(axis));
    // Below 1, boxes keep apart; no algorithm makes use of that.
    if (signals.clustering >= 1)
      text += fmt::format("; {} times as many are near each other as if they were spread evenly",
                          rounded(signals.clustering));
    text += ".";
  }
  if (signals.motion) text += " " + motion_text(*signals.motion);
  return text;
}

std::string text_of(const Advice& advice, std::size_t width) {
  std::string text = busy_hint(advice.processor_share);
  if (advice.is_withheld)
    text =
        "No advice: this machine is busy, so the times below may mislead. Add --allow-busy to get the advice "
        "and its reasons all the same.\n" +
        text;
  if (!text.empty()) text += "\n";
  text += fmt::format("{}: {}\n\n", advice.input, text_of(advice.signals));
  if (advice.mode == Mode::track && advice.frames < advice.signals.motion->frames)
    text += fmt::format("Measured on the {} from frame {} on:\n", counted(advice.frames, "frame", "frames"),
                        grouped(advice.first_frame + 1));
  text += table(advice, width);
  if (advice.floor_ms && advice.choice)
    text += fmt::format("  sorting the boxes and writing the pairs alone takes {}\n",
                        duration(*advice.floor_ms / 1e3));
  if (!advice.choice) text += "\nNothing of Broadside's own was verified, so there is nothing to advise.\n";
  if (!advice.choice || advice.is_withheld) return folded(text, width);
  const Measurement& chosen = advice.ranking[advice.choice->chosen].measurement;
  text += fmt::format("\nAdvice: {}\n", advice.spec);
  text += fmt::format("  {} {} to be expected on this machine", duration(advice.milliseconds / 1e3),
                      advice.mode == Mode::find ? "a call" : "a frame");
  if (advice.mode == Mode::track) text += fmt::format(" (p99 {})", duration(advice.p99_ms / 1e3));
  if (chosen.own_bytes && chosen.peak_bytes)
    text += fmt::format(", {} kept, {} at most", bytes(*chosen.own_bytes), bytes(*chosen.peak_bytes));
  if (chosen.evidence) text += fmt::format("; verified {}", chosen.evidence->text());
  text += "\n";
  text += "\nWhy\n" + list(advice.reasons);
  if (!advice.changes.empty()) text += "\nWhat would change it\n" + list(advice.changes);
  return folded(text, width) + "\n" + advice.snippet;
}

}  // namespace broadside::lab
