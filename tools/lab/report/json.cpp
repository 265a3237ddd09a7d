// A comparison as JSON, by the schema "broadside.results/2".
#include "lab/report/json.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lab/measure/ranking.hpp"
#include "lab/measure/samples.hpp"
#include "lab/measure/steadiness.hpp"
#include "lab/report/machine.hpp"

namespace broadside::lab {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const std::optional<PairedRatio>& ratio) {
  if (!ratio) return {};
  const auto& interval = ratio->interval;
  return {{"of", ratio->of},
          {"median", ratio->median},
          {"low", interval ? Json(interval->low) : Json()},
          {"high", interval ? Json(interval->high) : Json()},
          {"rounds", ratio->rounds},
          {"ms", ratio->ms},
          {"of_ms", ratio->of_ms}};
}

/// A count of each measured seed; null for the others.
Json by_seed(const Measurement& measurement, std::uint64_t Statistics::*count) {
  Json counts = Json::array();
  for (const std::optional<Statistics>& statistics : measurement.statistics_by_seed)
    counts.push_back(statistics ? Json(*statistics.*count) : Json());
  return counts;
}

/// A list for each phase, with a value for each sample.
Json phases_json(const std::vector<paper::Phases>& phases) {
  Json json;
  for (const paper::Phases& sample : phases) {
    json["initializing_ms"].push_back(sample.initializing_ms);
    json["adding_ms"].push_back(sample.adding_ms);
    json["detecting_ms"].push_back(sample.detecting_ms);
    json["mending_ms"].push_back(sample.mending_ms);
    json["searching_ms"].push_back(sample.searching_ms);
    json["comparing_ms"].push_back(sample.comparing_ms);
    json["movers"].push_back(sample.movers);
    json["visited"].push_back(sample.visited);
    json["moved"].push_back(sample.moved);
    json["built"].push_back(sample.built);
  }
  return json;
}

Json measurement_json(const CaseResult& result, const Measurement& measurement) {
  const Case& of = result.of;
  const std::vector<double>& samples = measurement.samples_ms;
  const bool timed = !samples.empty();
  const auto& statistics = measurement.statistics;
  const double movers = of.mode == Mode::track ? of.moving * static_cast<double>(of.boxes) : 0;
  Json parameters = Json::object();
  for (const auto& [name, value] : of.parameters) parameters[name] = value;
  Json json;
  if (!of.name.empty()) json["case"] = of.name;
  json["scene"] = of.scene;
  json["scene_parameters"] = std::move(parameters);
  json["seeds"] = of.seeds;
  json["dimension"] = of.dimension;
  json["boxes"] = of.boxes;
  json["frames"] = of.frames;
  json["moving"] = of.moving;
  if (of.left > 0) json["left"] = of.left;
  if (of.filtered) json["filtered"] = true;
  json["drift"] = or_null(of.drift);
  json["teleport"] = or_null(of.teleport);
  json["algorithm"] = measurement.algorithm;
  json["version"] = measurement.version;
  json["kind"] = name(measurement.kind);
  json["mode"] = of.mode == Mode::find ? "find" : "track";
  json["threads"] = measurement.threads;
  json["target"] = or_null(measurement.target);
  json["pairs"] = or_null(measurement.pairs);
  json["pair_hash"] = measurement.pair_hash ? Json(fmt::format("{:016x}", *measurement.pair_hash)) : Json();
  json["verified"] =
      measurement.outcome == Outcome::skipped ? Json() : Json(measurement.outcome == Outcome::verified);
  const auto& evidence = measurement.evidence;
  const bool verified = evidence && measurement.outcome == Outcome::verified;
  json["verified_by"] = verified ? Json(evidence->text()) : Json();
  json["agreeing_structures"] = verified ? Json(evidence->structures) : Json();
  json["agreeing_libraries"] = verified ? Json(evidence->libraries) : Json();
  json["skipped"] = or_null(measurement.reason);
  json["estimated_ms"] = or_null(measurement.estimated_ms);
  json["rounds"] = samples.size() / measurement.samples_per_round;
  json["median_ms"] = timed ? Json(time_of(measurement)) : Json();
  json["min_ms"] = timed ? Json(std::ranges::min(samples)) : Json();
  json["p99_ms"] = timed ? Json(percentile(samples, 0.99)) : Json();
  json["max_ms"] = timed ? Json(std::ranges::max(samples)) : Json();
  json["samples_ms"] = timed ? Json(samples) : Json();
  json["unsteady"] = timed ? Json(is_unsteady(of, measurement)) : Json();
  json["build_ms"] = timed ? or_null(measurement.build_ms) : Json();
  json["ns_per_box"] =
      timed && of.boxes > 0 ? Json(time_of(measurement) * 1e6 / static_cast<double>(of.boxes)) : Json();
  json["ns_per_mover"] = timed && movers > 0 ? Json(time_of(measurement) * 1e6 / movers) : Json();
  json["ratio_to_fastest"] = json_of(measurement.to_fastest);
  json["ratio_to_best_own"] = json_of(measurement.to_best_own);
  json["ratio_to_fastest_peer"] = json_of(measurement.to_fastest_peer);
  json["floor_ms"] = result.floor_ms.empty() ? Json() : Json(median(result.floor_ms));
  json["tests"] = statistics ? Json(statistics->tests) : Json();
  json["references"] = statistics ? Json(statistics->references) : Json();
  if (!of.name.empty()) {
    json["tests_by_seed"] = by_seed(measurement, &Statistics::tests);
    json["references_by_seed"] = by_seed(measurement, &Statistics::references);
  }
  if (!measurement.phases.empty()) json["phases"] = phases_json(measurement.phases);
  json["explanation"] = or_null(measurement.explanation);
  json["own_bytes"] = or_null(measurement.own_bytes);
  json["peak_bytes"] = or_null(measurement.peak_bytes);
  return json;
}

}  // namespace

// One measurement per line: short, and readable in a diff of two results.
std::string json_of(const Comparison& comparison, std::span<const std::string> command) {
  std::string text = fmt::format(
      "{{\n\"schema\": \"broadside.results/2\",\n\"date\": {},\n\"machine\": {},\n\"build\": {},\n",
      json_text(today()), json_text(json_of(this_machine())), json_text(json_of(this_build())));
  text += fmt::format("\"command\": {},\n\"stopped\": {},\n\"processor_share\": {},\n\"busy\": {},\n",
                      json_text(std::vector<std::string>(command.begin(), command.end())), comparison.stopped,
                      json_text(comparison.processor_share), is_busy(comparison.processor_share));
  if (comparison.load_before && comparison.load_after)
    text += fmt::format("\"load_before\": {},\n\"load_after\": {},\n", json_text(*comparison.load_before),
                        json_text(*comparison.load_after));
  text += "\"measurements\": [";
  std::string_view separator = "\n";
  for (const CaseResult& result : comparison.cases) {
    for (const Measurement& measurement : result.measurements) {
      text += separator;
      text += json_text(measurement_json(result, measurement));
      separator = ",\n";
    }
  }
  return text + "\n]\n}\n";
}

}  // namespace broadside::lab
