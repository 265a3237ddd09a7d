// What intervals are worth: agreement FIRST.json SECOND.json, of two runs of one comparison (`compare
// --json`) on one machine. Prints how many of the ratios' intervals overlap, how wide they are, and how far
// ratios move from run to run.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/guarded.hpp"
#include "lab/measure/measurement.hpp"
#include "lab/measure/samples.hpp"

namespace broadside::bench {
namespace {

using Json = nlohmann::json;

Json read(const std::string& file) {
  std::ifstream stream(file);
  Json json = Json::parse(stream, nullptr, false);
  if (json.is_discarded() || !json.is_object() || json.value("schema", "") != "broadside.results/2")
    throw std::runtime_error(file + " holds no broadside.results/2; expected what compare --json writes");
  return json;
}

/// The ratios that have an interval and are not to themselves, by what they are of and to.
std::map<std::string, lab::PairedRatio> ratios_of(const Json& json) {
  std::map<std::string, lab::PairedRatio> ratios;
  for (const Json& measurement : json["measurements"]) {
    std::string name;
    for (const char* const key : {"scene", "dimension", "boxes", "moving", "frames", "algorithm"})
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

void print(const std::map<std::string, lab::PairedRatio>& first,
           const std::map<std::string, lab::PairedRatio>& second) {
  std::size_t overlapping = 0;
  std::vector<double> widths;
  std::vector<double> changes;
  for (const auto& [name, one] : first) {
    const auto found = second.find(name);
    if (found == second.end()) continue;
    const lab::PairedRatio& other = found->second;
    if (one.interval->low <= other.interval->high && other.interval->low <= one.interval->high) ++overlapping;
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
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("agreement", 2, [&] {
    if (count != 3) throw std::runtime_error(fmt::format("{} files; expected two", count - 1));
    print(ratios_of(read(arguments[1])), ratios_of(read(arguments[2])));
    return 0;
  });
}
