// Compares two builds of the program: compare_builds OLD NEW [ROUNDS] [ARGUMENTS OF compare ...]. Runs `OLD
// compare` and `NEW compare` in turns, ROUNDS times each (default: 5). Every run is a new process, and the
// order is drawn anew for each round. For each case and algorithm it prints the time of the new build over
// that of the old one: the median over the rounds, with a 95 % bootstrap interval. Processes differ among
// themselves, for example in memory layout, so a single process of each build proves little.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/guarded.hpp"
#include "lab/measure/paired_ratio.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "lab/report/aligned_columns.hpp"
#include "lab/report/machine.hpp"
#include "lab/report/table.hpp"

namespace broadside::bench {
namespace {

using Json = nlohmann::json;

/// Single quotes: a shell expands nothing inside them.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

/// Median times of one run of `program compare`, by case and algorithm. Skipped algorithms are left out.
std::map<std::string, double> times_of(const std::string& program,
                                       const std::vector<std::string>& arguments) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("compare_builds.{}.json", std::random_device()());
  std::string command = quoted(program) + " compare --json " + quoted(file.string());
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  const int status = std::system((command + " >/dev/null").c_str());
  std::ifstream stream(file);
  const Json json = Json::parse(stream, nullptr, false);
  std::filesystem::remove(file);
  if (status != 0 || json.is_discarded())
    throw std::runtime_error(
        fmt::format("'{}' ended with status {}; expected 0 and results", command, status));
  std::map<std::string, double> times;
  for (const Json& measurement : json["measurements"]) {
    if (measurement["median_ms"].is_null()) continue;
    const std::string name = fmt::format(
        "{}, {}D, {} boxes, {:.3g} % moving, {}", measurement["scene"].get<std::string>(),
        measurement["dimension"].get<int>(), lab::grouped(measurement["boxes"].get<std::size_t>()),
        measurement["moving"].get<double>() * 100, measurement["algorithm"].get<std::string>());
    times[name] = measurement["median_ms"].get<double>();
  }
  return times;
}

void run(const std::vector<std::string>& programs, std::size_t rounds,
         const std::vector<std::string>& arguments) {
  std::map<std::string, std::array<std::vector<double>, 2>> times;
  std::mt19937 random;
  for (std::size_t round = 0; round < rounds; ++round) {
    const std::size_t first = random() % 2;
    for (const std::size_t build : {first, 1 - first}) {
      std::fprintf(stderr, "round %zu of %zu: %s\n", round + 1, rounds, programs[build].c_str());
      for (const auto& [name, time] : times_of(programs[build], arguments))
        times[name][build].push_back(time);
    }
  }
  const lab::Build build = lab::this_build();
  fmt::print("{} over {}, {} rounds; {}, {} cores; {}\n", programs[1], programs[0], rounds,
             lab::this_machine().cpu, lab::this_machine().cores, build.compiler);
  lab::AlignedColumns columns("<>>>");
  columns.add({"case and algorithm", "old ms", "new ms", "new over old"});
  std::vector<lab::RatiosBySeed> pairs;
  for (const auto& [name, both] : times) {
    // An algorithm near the budget is skipped in some runs.
    if (both[0].size() != rounds || both[1].size() != rounds) continue;
    pairs.emplace_back(both[1], both[0], 1);
    columns.add(
        {name, lab::rounded(lab::median(both[0])), lab::rounded(lab::median(both[1])),
         fmt::format("{:.3f} ({})", pairs.back().median(), lab::interval_text(pairs.back().interval()))});
  }
  if (pairs.empty()) throw std::runtime_error("no algorithm was timed by both builds; expected at least one");
  const lab::MeanRatio mean = lab::geometric_mean(pairs);
  fmt::print("{}geometric mean of {}: {:.3f} ({:.3f} to {:.3f})\n", columns.text(""), pairs.size(), mean.mean,
             mean.interval.low, mean.interval.high);
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("compare_builds", 2, [&] {
    const std::vector<std::string> given(arguments + 1, arguments + count);
    if (given.size() < 2)
      throw std::runtime_error(
          fmt::format("{} arguments; expected OLD NEW [ROUNDS] [ARGUMENTS OF compare ...]", given.size()));
    const bool has_rounds = given.size() > 2 && given[2].find_first_not_of("0123456789") == std::string::npos;
    const std::size_t rounds = has_rounds ? std::stoul(given[2]) : 5;
    run({given[0], given[1]}, std::max<std::size_t>(rounds, 1),
        {given.begin() + (has_rounds ? 3 : 2), given.end()});
    return 0;
  });
}
