// Merges results: of one machine as further processes, machines side by side.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/format.hpp"
#include "lab/measure/paired_ratio.hpp"
#include "lab/measure/ranking.hpp"
#include "lab/numbers.hpp"
#include "lab/report/results.hpp"

namespace broadside::lab {
namespace {

/// Results and the file that they came first from.
struct Merged {
  std::string file;
  Results results;
};

/// Throws unless the two texts are equal; `what` differs between a file and one that came before it.
void check_equal(const std::string& file, std::string_view what, const std::string& found,
                 const std::string& expected, const std::string& first_file) {
  if (found != expected)
    throw FileError(
        fmt::format("{}: {} is '{}'; expected '{}', as in {}", file, what, found, expected, first_file));
}

/// All that a case is told from others by.
std::string text_of(const Case& of) {
  std::string text = fmt::format("{} {}D", of.scene, of.dimension);
  for (const auto& [name, value] : of.parameters) text += fmt::format(":{}={}", name, value);
  text += fmt::format(", {}, seeds {}", counted(of.boxes, "box", "boxes"), fmt::join(of.seeds, " "));
  if (of.frames == 0) return text;
  text += fmt::format(", {}, moving {}", counted(of.frames, "frame", "frames"), of.moving);
  if (of.drift) text += fmt::format(", drift {}", *of.drift);
  if (of.teleport) text += fmt::format(", teleport {}", *of.teleport);
  return text;
}

std::string text_of(const Measurement& measurement) {
  return fmt::format("{} ({}, {})", measurement.algorithm, measurement.version,
                     counted(measurement.threads, "thread", "threads"));
}

/// The pairs of a case that were verified first.
std::string pairs_of(const CaseResult& result) {
  for (const Measurement& measurement : result.measurements) {
    if (measurement.outcome == Outcome::verified && measurement.pairs && measurement.pair_hash)
      return fmt::format("{}, hash {:016x}", *measurement.pairs, *measurement.pair_hash);
  }
  return {};
}

/// The command without the program's place and the files that it wrote to.
std::vector<std::string> without_files(const std::vector<std::string>& command) {
  std::vector<std::string> words{"broadside"};
  for (std::size_t i = 1; i < command.size(); ++i) {
    const std::string option = command[i].substr(0, command[i].find('='));
    if (option != "--json" && option != "--report" && option != "--samples") {
      words.push_back(command[i]);
    } else if (option == command[i]) {
      ++i;  // its value is the next word
    }
  }
  return words;
}

/// A number that tells a process's run from any other: of all its samples in their order.
std::uint64_t identity_of(const Results& results, std::size_t process) {
  std::uint64_t identity = 14695981039346656037U;  // FNV-1a
  for (const CaseResult& result : results.comparison.cases) {
    for (const Measurement& measurement : result.measurements) {
      const std::vector<std::size_t>& rounds = measurement.rounds_of_processes;
      std::size_t first = 0;
      std::size_t count = measurement.samples_ms.size();
      if (!rounds.empty()) {
        const auto before = rounds.begin() + static_cast<std::ptrdiff_t>(process);
        first = std::accumulate(rounds.begin(), before, std::size_t{0}) * measurement.samples_a_round;
        count = rounds[process] * measurement.samples_a_round;
      }
      for (std::size_t i = first; i < first + count; ++i)
        identity = (identity ^ std::bit_cast<std::uint64_t>(measurement.samples_ms[i])) * 1099511628211U;
    }
  }
  return identity;
}

/// Throws unless `other` has the cases of `results`, and where both are verified their pairs.
void check_cases(const Merged& first, const Merged& other) {
  const std::vector<CaseResult>& cases = first.results.comparison.cases;
  const std::vector<CaseResult>& others = other.results.comparison.cases;
  for (std::size_t i = 0; i < std::max(cases.size(), others.size()); ++i) {
    check_equal(other.file, fmt::format("case {}", i + 1), i < others.size() ? text_of(others[i].of) : "none",
                i < cases.size() ? text_of(cases[i].of) : "none", first.file);
    const std::string pairs = pairs_of(cases[i]);
    const std::string other_pairs = pairs_of(others[i]);
    if (!pairs.empty() && !other_pairs.empty())
      check_equal(other.file, fmt::format("the number of pairs of {}", text_of(cases[i].of)), other_pairs,
                  pairs, first.file);
  }
}

/// Throws unless two that have a machine in common differ by nothing else but the run.
void check_same_program(const Merged& first, const Merged& other) {
  const Build& build = first.results.build;
  const Build& others = other.results.build;
  check_equal(other.file, "build.version", others.version, build.version, first.file);
  check_equal(other.file, "build.compiler", others.compiler, build.compiler, first.file);
  check_equal(other.file, "build.type", others.type, build.type, first.file);
  check_equal(other.file, "build.flags", others.flags, build.flags, first.file);
  check_equal(other.file, "command", fmt::format("{}", fmt::join(other.results.command, " ")),
              fmt::format("{}", fmt::join(first.results.command, " ")), first.file);
  const std::vector<CaseResult>& cases = first.results.comparison.cases;
  const std::vector<CaseResult>& other_cases = other.results.comparison.cases;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::vector<Measurement>& some = cases[i].measurements;
    const std::vector<Measurement>& same = other_cases[i].measurements;
    for (std::size_t j = 0; j < std::max(some.size(), same.size()); ++j) {
      check_equal(other.file, fmt::format("algorithm {} of {}", j + 1, text_of(cases[i].of)),
                  j < same.size() ? text_of(same[j]) : "none", j < some.size() ? text_of(some[j]) : "none",
                  first.file);
    }
  }
}

/// How many rounds each of `processes` processes has.
std::vector<std::size_t> rounds_of(const Measurement& measurement, std::size_t processes) {
  if (!measurement.rounds_of_processes.empty()) return measurement.rounds_of_processes;
  return std::vector<std::size_t>(processes, measurement.samples_ms.size() / measurement.samples_a_round);
}

/// Adds the rounds of other processes. What failed in one has failed; what was skipped in some has the
/// others' rounds.
void add(Measurement& to, std::size_t processes, const Measurement& from, std::size_t from_processes) {
  std::vector<std::size_t> rounds = rounds_of(to, processes);
  const std::vector<std::size_t> more = rounds_of(from, from_processes);
  rounds.insert(rounds.end(), more.begin(), more.end());
  const bool takes_over = to.outcome != Outcome::failed && from.outcome != Outcome::skipped &&
                          (to.outcome == Outcome::skipped || from.outcome == Outcome::failed);
  if (to.outcome == Outcome::verified && from.outcome == Outcome::verified) {
    if (to.build_ms && from.build_ms) {
      const auto weight =
          static_cast<double>(from_processes) / static_cast<double>(processes + from_processes);
      to.build_ms = (1 - weight) * *to.build_ms + weight * *from.build_ms;
    }
    if (to.evidence && from.evidence) to.evidence = weaker(*to.evidence, *from.evidence);
  }
  std::vector<double> samples = std::move(to.samples_ms);
  if (takes_over) to = from;
  samples.insert(samples.end(), from.samples_ms.begin(), from.samples_ms.end());
  to.samples_ms = std::move(samples);
  to.rounds_of_processes = std::move(rounds);
  if (to.outcome == Outcome::failed) {
    to.samples_ms.clear();
    std::ranges::fill(to.rounds_of_processes, std::size_t{0});
  }
}

void add(Results& to, const Results& from) {
  for (std::size_t i = 0; i < to.comparison.cases.size(); ++i) {
    CaseResult& result = to.comparison.cases[i];
    const CaseResult& more = from.comparison.cases[i];
    result.floor_ms.insert(result.floor_ms.end(), more.floor_ms.begin(), more.floor_ms.end());
    for (std::size_t j = 0; j < result.measurements.size(); ++j)
      add(result.measurements[j], to.processes.size(), more.measurements[j], from.processes.size());
  }
  to.processes.insert(to.processes.end(), from.processes.begin(), from.processes.end());
  to.comparison.processor_share = std::min(to.comparison.processor_share, from.comparison.processor_share);
}

}  // namespace

Results results_of(Comparison comparison, std::span<const std::string> command) {
  const double share = comparison.processor_share;
  return {this_machine(),
          this_build(),
          {command.begin(), command.end()},
          {{today(), share}},
          std::move(comparison)};
}

std::string target_of(const Results& results) {
  for (const CaseResult& result : results.comparison.cases) {
    for (const Measurement& measurement : result.measurements) {
      if (!measurement.target.empty()) return measurement.target;
    }
  }
  return {};
}

std::string name_of_machine(const Results& results) {
  const std::string target = target_of(results);
  return fmt::format("{}, {}{}", results.machine.cpu.empty() ? "unknown processor" : results.machine.cpu,
                     counted(results.machine.cores, "core", "cores"), target.empty() ? "" : ", " + target);
}

std::vector<Results> merge_results(std::span<const std::string> paths) {
  std::vector<Merged> machines;
  std::map<std::uint64_t, std::string> runs;  // the file that each is in
  for (const std::string& path : paths) {
    for (Results& results : read_results(path)) {
      results.command = without_files(results.command);
      for (std::size_t process = 0; process < results.processes.size(); ++process) {
        const auto [run, is_new] = runs.emplace(identity_of(results, process), path);
        if (!is_new)
          throw FileError(fmt::format("{}: holds a run that is in {} as well; expected each run once", path,
                                      run->second));
      }
      Merged more{path, std::move(results)};
      if (!machines.empty()) {
        check_equal(path, "build.revision", more.results.build.revision, machines[0].results.build.revision,
                    machines[0].file);
        check_cases(machines[0], more);
      }
      const auto same = std::ranges::find_if(machines, [&](const Merged& machine) {
        return name_of_machine(machine.results) == name_of_machine(more.results);
      });
      if (same == machines.end()) {
        machines.push_back(std::move(more));
      } else {
        check_same_program(*same, more);
        add(same->results, more.results);
      }
    }
  }
  std::vector<Results> merged;
  for (Merged& machine : machines) {
    for (CaseResult& result : machine.results.comparison.cases) add_ratios(result);
    merged.push_back(std::move(machine.results));
  }
  return merged;
}

}  // namespace broadside::lab
