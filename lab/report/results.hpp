// The results of a comparison with where, when and from what they came, of one process or of several:
// written, read, and merged.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lab/measure/compare.hpp"
#include "lab/report/machine.hpp"

namespace broadside::lab {

/// One run of the program.
struct ProcessRun {
  std::string date;  ///< "2026-11-21"
  double processor_share = 1;
};

/// What the processes on one machine measured, all with one build and one command.
struct Results {
  Machine machine;
  Build build;
  std::vector<std::string> command;
  std::vector<ProcessRun> processes;  ///< in the order in which measurements hold their rounds
  Comparison comparison;              ///< of all of them; its processor_share is the least
};

/// The results of this process.
Results results_of(Comparison comparison, std::span<const std::string> command);

/// The instruction set that Broadside's own algorithms used; empty where none took part.
std::string target_of(const Results& results);

/// "AMD EPYC, 2 cores, AVX-512".
std::string name_of_machine(const Results& results);

/// Reads what json_of() wrote (json.hpp), gzipped or not: one machine's results or several. Throws FileError,
/// with the file, the field, what was found and what was expected; so it does where samples were left out or
/// where a run was stopped.
std::vector<Results> read_results(const std::string& path);

/// Merges results files: what has one machine (by processor, cores and instruction set) becomes one, each
/// process with its rounds, and ratios anew; the machines stand in the order in which they come first.
///
/// Throws FileError that names the file, what was found and what was expected, where the revisions, the cases
/// or their pairs differ, where on one machine the builds, the commands or the algorithms do, or where one
/// run is given twice, under whatever names.
std::vector<Results> merge_results(std::span<const std::string> paths);

}  // namespace broadside::lab
