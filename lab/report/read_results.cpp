// Reads what a comparison wrote as JSON, by the schema "broadside.results/2".
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lab/formats/format.hpp"
#include "lab/formats/input.hpp"
#include "lab/formats/json/json_place.hpp"
#include "lab/measure/paired_ratio.hpp"
#include "lab/report/results.hpp"

namespace broadside::lab {
namespace {

using Json = nlohmann::ordered_json;
using Place = JsonPlace;

Case read_case(const Place& place) {
  Case of;
  of.scene = place.at("scene").text();
  const Place parameters = place.at("scene_parameters");
  if (!parameters.json().is_object()) parameters.refuse("an object");
  for (const auto& [name, value] : parameters.json().items())
    of.parameters.emplace_back(name, parameters.at(name.c_str()).text());
  for (const Place& seed : place.at("seeds").list()) of.seeds.push_back(seed.count());
  if (of.seeds.empty()) place.at("seeds").refuse("at least one seed");
  of.dimension = static_cast<int>(place.at("dimension").count());
  of.boxes = place.at("boxes").count();
  of.frames = place.at("frames").count();
  of.moving = place.at("moving").number();
  of.drift = place.at("drift").or_empty(&Place::number);
  of.teleport = place.at("teleport").or_empty(&Place::number);
  const Place mode = place.at("mode");
  if (mode.text() != "find" && mode.text() != "track") mode.refuse("find or track");
  of.mode = mode.text() == "find" ? Mode::find : Mode::track;
  if ((of.mode == Mode::track) != (of.frames > 0))
    place.at("frames").refuse("frames in mode track and none in find");
  return of;
}

AlgorithmKind read_kind(const Place& place) {
  for (const AlgorithmKind kind :
       {AlgorithmKind::own, AlgorithmKind::paper, AlgorithmKind::literature, AlgorithmKind::peer}) {
    if (place.text() == name(kind)) return kind;
  }
  place.refuse("own, paper, literature or peer");
}

/// Samples, which must be of whole rounds, and of how many in each of `processes`.
void read_samples(const Place& place, std::size_t processes, Measurement& measurement) {
  const Place samples = place.at("samples_ms");
  if (samples.is_null()) samples.refuse("the samples, which an archive has (--samples)");
  for (const Place& sample : samples.list()) {
    measurement.samples_ms.push_back(sample.number());
    if (!(measurement.samples_ms.back() > 0)) sample.refuse("a time above 0");
  }
  const std::uint64_t rounds = place.at("rounds").count();
  if (rounds == 0 || measurement.samples_ms.size() != rounds * measurement.samples_a_round)
    samples.refuse(fmt::format("{} of {} rounds", rounds * measurement.samples_a_round, rounds));
  if (processes == 1) return;
  std::uint64_t sum = 0;
  const Place parts = place.at("rounds_of_processes");
  for (const Place& part : parts.list()) {
    measurement.rounds_of_processes.push_back(part.count());
    sum += part.count();
  }
  if (sum != rounds || measurement.rounds_of_processes.size() != processes)
    parts.refuse(fmt::format("{} numbers that sum to {}", processes, rounds));
}

Measurement read_measurement(const Place& place, const Case& of, std::size_t processes) {
  Measurement measurement;
  measurement.algorithm = place.at("algorithm").text();
  measurement.version = place.at("version").text();
  measurement.kind = read_kind(place.at("kind"));
  measurement.threads = place.at("threads").count();
  measurement.target = place.at("target").text_or_empty();
  measurement.samples_a_round = std::max<std::size_t>(of.frames, 1);
  const std::optional<bool> verified = place.at("verified").or_empty(&Place::truth);
  measurement.outcome = !verified ? Outcome::skipped : *verified ? Outcome::verified : Outcome::failed;
  measurement.reason = place.at("skipped").text_or_empty();
  measurement.pairs = place.at("pairs").or_empty(&Place::count);
  measurement.pair_hash = place.at("pair_hash").or_empty(&Place::hash);
  measurement.build_ms = place.at("build_ms").or_empty(&Place::number);
  measurement.explanation = place.at("explanation").text_or_empty();
  measurement.own_bytes = place.at("own_bytes").or_empty(&Place::count);
  measurement.peak_bytes = place.at("peak_bytes").or_empty(&Place::count);
  if (place.has("estimated_ms")) measurement.estimated_ms = place.at("estimated_ms").or_empty(&Place::number);
  if (!place.at("tests").is_null() && !place.at("references").is_null())
    measurement.statistics = Statistics{place.at("tests").count(), place.at("references").count()};
  if (const std::string by = place.at("verified_by").text_or_empty(); !by.empty()) {
    measurement.evidence = Evidence{by == "by definition" || by == "the definition"};
    if (place.has("agreeing_structures")) {
      measurement.evidence->structures = place.at("agreeing_structures").count();
      measurement.evidence->libraries = place.at("agreeing_libraries").count();
    }
  }
  if (measurement.outcome == Outcome::verified)
    read_samples(place, processes, measurement);
  else if (processes > 1)
    measurement.rounds_of_processes.assign(processes, 0);
  return measurement;
}

bool are_equal(const Case& a, const Case& b) {
  return a.scene == b.scene && a.parameters == b.parameters && a.seeds == b.seeds &&
         a.dimension == b.dimension && a.boxes == b.boxes && a.frames == b.frames && a.moving == b.moving &&
         a.drift == b.drift && a.teleport == b.teleport && a.mode == b.mode;
}

Results read_machine_results(const Place& place) {
  Results results;
  results.machine = read_machine(place.at("machine").json());
  results.build = read_build(place.at("build").json());
  for (const Place& word : place.at("command").list()) results.command.push_back(word.text());
  if (place.at("stopped").truth()) place.at("stopped").refuse("false: results of a whole run");
  results.comparison.processor_share = place.at("processor_share").number();
  if (place.has("processes")) {
    for (const Place& process : place.at("processes").list())
      results.processes.push_back({process.at("date").text(), process.at("processor_share").number()});
    if (results.processes.size() < 2) place.at("processes").refuse("at least two");
  } else {
    results.processes.push_back({place.at("date").text(), results.comparison.processor_share});
  }
  const std::vector<Place> measurements = place.at("measurements").list();
  if (measurements.empty()) place.at("measurements").refuse("at least one measurement");
  for (const Place& measurement : measurements) {
    Case of = read_case(measurement);
    std::vector<CaseResult>& cases = results.comparison.cases;
    if (cases.empty() || !are_equal(cases.back().of, of)) {
      cases.push_back({std::move(of), {}});
      if (const auto floor = measurement.at("floor_ms").or_empty(&Place::number))
        cases.back().floor_ms.assign(results.processes.size(), *floor);
    }
    cases.back().measurements.push_back(
        read_measurement(measurement, cases.back().of, results.processes.size()));
  }
  return results;
}

}  // namespace

std::vector<Results> read_results(const std::string& path) {
  Input input(path);
  const Json json = parse_json(input.bytes(), input.name());
  const Place root(json, input.name());
  if (const Place schema = root.at("schema"); schema.text() != "broadside.results/2")
    schema.refuse("\"broadside.results/2\", as compare --json writes it");
  std::vector<Results> machines;
  machines.push_back(read_machine_results(root));
  if (root.has("other_machines")) {
    for (const Place& other : root.at("other_machines").list())
      machines.push_back(read_machine_results(other));
  }
  for (Results& results : machines) {
    for (CaseResult& result : results.comparison.cases) add_ratios(result);
  }
  return machines;
}

}  // namespace broadside::lab
