// Advice as JSON, by the schema "broadside.advice/2".
#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "broadside/executor.hpp"

#include "lab/advise/advise.hpp"
#include "lab/measure/ranking.hpp"
#include "lab/measure/samples.hpp"
#include "lab/measure/steadiness.hpp"
#include "lab/report/machine.hpp"

namespace broadside::lab {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const MotionSignals& motion) {
  return {{"frames", motion.frames},         {"min_moving", motion.min_moving},    {"moving", motion.moving},
          {"max_moving", motion.max_moving}, {"drift", or_null(motion.drift)},     {"jumps", motion.jumps},
          {"added_per_frame", motion.added}, {"removed_per_frame", motion.removed}};
}

Json json_of(const Signals& signals) {
  Json json = {{"dimension", signals.dimension},
               {"precision", name(signals.precision)},
               {"boxes", signals.boxes},
               {"absent", signals.absent},
               {"infinite", signals.infinite},
               {"points", signals.points},
               {"flat", signals.flat},
               {"floats_hold_all", signals.floats_hold_all},
               {"size_percentiles", size_percentiles},
               {"sizes", signals.sizes},
               {"largest", signals.largest},
               {"axis_tests_per_box", signals.axis_tests},
               {"clustering", signals.clustering},
               {"overlaps_per_box", or_null(signals.overlaps)}};
  json["motion"] = signals.motion ? json_of(*signals.motion) : Json();
  return json;
}

Json json_of(const RankedAlgorithm& ranked) {
  const Measurement& measurement = ranked.measurement;
  const std::vector<double>& samples = measurement.samples_ms;
  const bool timed = !samples.empty();
  Json json;
  json["algorithm"] = measurement.algorithm;
  json["version"] = measurement.version;
  json["kind"] = name(measurement.kind);
  json["threads"] = measurement.threads;
  json["variant"] = ranked.is_variant;
  json["finalist"] = ranked.is_finalist;
  json["verified"] =
      measurement.outcome == Outcome::skipped ? Json() : Json(measurement.outcome == Outcome::verified);
  const bool verified = measurement.evidence && measurement.outcome == Outcome::verified;
  json["verified_by"] = verified ? Json(measurement.evidence->text()) : Json();
  json["skipped"] = or_null(measurement.reason);
  json["samples"] = samples.size();
  json["time_ms"] = timed ? Json(ranked.milliseconds) : Json();
  json["median_ms"] = timed ? Json(median(samples)) : Json();
  json["min_ms"] = timed ? Json(std::ranges::min(samples)) : Json();
  json["p99_ms"] = timed ? Json(percentile(samples, 0.99)) : Json();
  json["estimated_ms"] = or_null(measurement.estimated_ms);
  json["build_ms"] = timed ? or_null(measurement.build_ms) : Json();
  json["pairs"] = or_null(measurement.pairs);
  json["tests"] = measurement.statistics ? Json(measurement.statistics->tests) : Json();
  json["explanation"] = or_null(measurement.explanation);
  json["own_bytes"] = or_null(measurement.own_bytes);
  json["peak_bytes"] = or_null(measurement.peak_bytes);
  return json;
}

Json advice_json(const Advice& advice) {
  if (!advice.choice || advice.is_withheld) return {};
  const AlgorithmChoice& choice = *advice.choice;
  const Measurement& chosen = advice.ranking[choice.chosen].measurement;
  const auto spec_of = [&](std::size_t place) { return advice.ranking[place].measurement.algorithm; };
  constexpr std::array<std::string_view, 3> whys = {"fastest", "automatic", "variant"};
  Json json;
  json["spec"] = advice.spec;
  json["why"] = whys[static_cast<std::size_t>(choice.why)];
  json["time_ms"] = advice.milliseconds;
  json["p99_ms"] = advice.p99_ms;
  json["own_bytes"] = or_null(chosen.own_bytes);
  json["peak_bytes"] = or_null(chosen.peak_bytes);
  json["fastest_plain"] = spec_of(choice.fastest_plain);
  json["faster_peer"] = choice.peer ? Json(spec_of(*choice.peer)) : Json();
  json["reasons"] = advice.reasons;
  json["changes"] = advice.changes;
  json["snippet"] = advice.snippet;
  return json;
}

}  // namespace

std::string json_of(const Advice& advice, std::span<const std::string> command) {
  std::string text = "{\n\"schema\": \"broadside.advice/2\"";
  const auto add = [&](std::string_view key, const Json& value) {
    text += fmt::format(",\n\"{}\": {}", key, json_text(value));
  };
  add("machine", json_of(this_machine()));
  add("build", json_of(this_build()));
  add("command", std::vector<std::string>(command.begin(), command.end()));
  add("target", instruction_set());
  add("input", advice.input);
  add("warning", or_null(advice.warning));
  add("processor_share", advice.processor_share);
  add("busy", is_busy(advice.processor_share));
  add("signals", json_of(advice.signals));
  add("mode", advice.mode == Mode::find ? "find" : "track");
  add("first_frame", advice.first_frame);
  add("frames", advice.frames);
  add("floor_ms", or_null(advice.floor_ms));
  add("advice", advice_json(advice));
  text += ",\n\"ranking\": [";
  std::string_view separator = "\n";
  for (const RankedAlgorithm& ranked : advice.ranking) {
    text += separator;
    text += json_text(json_of(ranked));
    separator = ",\n";
  }
  return text + "\n]\n}\n";
}

}  // namespace broadside::lab
