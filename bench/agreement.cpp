// Whether two runs say the same: agreement FIRST.json SECOND.json, two files of `compare --json`, merged or
// not, or two of `experiment --json`. Of comparisons it prints for each machine that both have how many of
// the ratios' intervals overlap, how wide they are, how far ratios move from run to run, and which of two
// algorithms is faster in the one and slower in the other; of experiments which statement's verdict changes.
// Ends with 1 where a verdict, or which one is faster, changes.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/guarded.hpp"
#include "lab/measure/measurement.hpp"
#include "lab/measure/samples.hpp"

namespace broadside::bench {
namespace {

using Json = nlohmann::json;

constexpr std::string_view results = "broadside.results/2";
constexpr std::string_view experiments = "broadside.experiments/2";

std::string schema_of(const Json& json) { return json.value("schema", ""); }

Json read(const std::string& file) {
  std::ifstream stream(file);
  Json json = Json::parse(stream, nullptr, false);
  if (json.is_discarded() || !json.is_object() ||
      (schema_of(json) != results && schema_of(json) != experiments))
    throw std::runtime_error(
        fmt::format("{} holds neither {} nor {}; expected what compare --json or experiment --json writes",
                    file, results, experiments));
  return json;
}

/// The machines' results, by the name that a machine is told by.
std::map<std::string, Json> machines_of(const Json& json) {
  std::map<std::string, Json> machines;
  const auto add = [&](const Json& one) {
    const Json& machine = one["machine"];
    machines[machine["cpu"].dump() + ", " + machine["cores"].dump() + " cores"] = one;
  };
  add(json);
  if (json.contains("other_machines")) std::ranges::for_each(json["other_machines"], add);
  return machines;
}

/// The ratios that have an interval and are not to themselves, by what they are of and to.
std::map<std::string, lab::PairedRatio> ratios_of(const Json& json) {
  std::map<std::string, lab::PairedRatio> ratios;
  for (const Json& measurement : json["measurements"]) {
    std::string name;
    for (const char* const key :
         {"scene", "dimension", "boxes", "moving", "frames", "drift", "teleport", "algorithm"})
      name += measurement[key].dump() + " ";
    for (const char* const key : {"ratio_to_fastest", "ratio_to_best_own", "ratio_to_fastest_peer"}) {
      const Json& ratio = measurement[key];
      if (ratio.is_null() || ratio["low"].is_null() || ratio["of"] == measurement["algorithm"]) continue;
      ratios[name + ratio["of"].dump()] = {ratio["of"], ratio["median"],
                                           lab::Interval{ratio["low"], ratio["high"]}, ratio["rounds"]};
    }
  }
  return ratios;
}

/// How wide the interval is, as a part of the ratio.
double width_of(const lab::PairedRatio& ratio) {
  return (ratio.interval->high - ratio.interval->low) / ratio.median;
}

/// Whether the one says that an algorithm is faster than another, and the other one that it is slower.
bool contradict(const lab::Interval& one, const lab::Interval& other) {
  return (one.high < 1 && other.low > 1) || (one.low > 1 && other.high < 1);
}

/// Compares two runs on one machine; returns how many ratios contradict each other.
std::size_t print(const std::map<std::string, lab::PairedRatio>& first,
                  const std::map<std::string, lab::PairedRatio>& second) {
  std::vector<std::string> contradictions;
  std::size_t overlapping = 0;
  std::vector<double> widths;
  std::vector<double> changes;
  for (const auto& [name, one] : first) {
    const auto found = second.find(name);
    if (found == second.end()) continue;
    const lab::PairedRatio& other = found->second;
    if (one.interval->low <= other.interval->high && other.interval->low <= one.interval->high) ++overlapping;
    if (contradict(*one.interval, *other.interval))
      contradictions.push_back(fmt::format("{}: {:.3f} ({:.3f} to {:.3f}), then {:.3f} ({:.3f} to {:.3f})",
                                           name, one.median, one.interval->low, one.interval->high,
                                           other.median, other.interval->low, other.interval->high));
    widths.insert(widths.end(), {width_of(one), width_of(other)});
    changes.push_back(std::abs(std::log(one.median / other.median)));
  }
  if (changes.empty())
    throw std::runtime_error(
        "the two have no ratio with an interval in common; expected two runs of one comparison");
  fmt::print("{} of {} intervals of the one overlap those of the other: {:.1f} %\n", overlapping,
             changes.size(), 100 * static_cast<double>(overlapping) / static_cast<double>(changes.size()));
  fmt::print(
      "width of an interval over its ratio: median {:.1f} %, nine in ten at most {:.1f} %, widest {:.0f} %\n",
      100 * lab::median(widths), 100 * lab::percentile(widths, 0.9), 100 * lab::percentile(widths, 1));
  fmt::print("change of a ratio from run to run: median {:.1f} %, nine in ten at most {:.1f} %\n",
             100 * lab::median(changes), 100 * lab::percentile(changes, 0.9));
  fmt::print("faster in the one and slower in the other: {} of {}\n", contradictions.size(), changes.size());
  for (const std::string& contradiction : contradictions) fmt::print("  {}\n", contradiction);
  return contradictions.size();
}

int compare_results(const Json& first, const Json& second) {
  const std::map<std::string, Json> others = machines_of(second);
  std::size_t contradictions = 0;
  bool any = false;
  for (const auto& [name, machine] : machines_of(first)) {
    const auto other = others.find(name);
    if (other == others.end()) continue;
    any = true;
    fmt::print("{}\n", name);
    contradictions += print(ratios_of(machine), ratios_of(other->second));
  }
  if (!any) throw std::runtime_error("the two have no machine in common; expected at least one");
  return contradictions == 0 ? 0 : 1;
}

/// The verdicts of each statement, by the experiment's name and the statement's.
std::map<std::string, std::string> verdicts_of(const Json& json) {
  std::map<std::string, std::string> verdicts;
  for (const Json& experiment : json["experiments"]) {
    for (const Json& statement : experiment["statements"])
      verdicts[fmt::format("{}, {}", experiment["name"].get<std::string>(),
                           statement["name"].get<std::string>())] = statement["verdict"];
  }
  return verdicts;
}

int compare_experiments(const Json& first, const Json& second) {
  const std::map<std::string, std::string> others = verdicts_of(second);
  std::size_t common = 0;
  std::vector<std::string> changed;
  for (const auto& [name, verdict] : verdicts_of(first)) {
    const auto other = others.find(name);
    if (other == others.end()) continue;
    ++common;
    if (other->second != verdict)
      changed.push_back(fmt::format("{}: {}, then {}", name, verdict, other->second));
  }
  if (common == 0) throw std::runtime_error("the two have no statement in common; expected at least one");
  fmt::print("verdicts that change: {} of {}\n", changed.size(), common);
  for (const std::string& change : changed) fmt::print("  {}\n", change);
  return changed.empty() ? 0 : 1;
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("agreement", 2, [&] {
    if (count != 3) throw std::runtime_error(fmt::format("{} files; expected two", count - 1));
    const Json first = read(arguments[1]);
    const Json second = read(arguments[2]);
    if ((schema_of(first) == results) != (schema_of(second) == results))
      throw std::runtime_error(fmt::format("{} is {}; expected {}, as {}", arguments[2], schema_of(second),
                                           schema_of(first), arguments[1]));
    return schema_of(first) == results ? compare_results(first, second) : compare_experiments(first, second);
  });
}
