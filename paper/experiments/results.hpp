// Experiments done: what they measured, what they found, and where.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lab/report/machine.hpp"
#include "paper/experiments/experiment.hpp"

namespace broadside::lab {

/// One experiment done.
struct ExperimentResult {
  const Experiment* experiment;  ///< one of experiments()
  std::vector<Table> tables;
  Finding finding;
  double seconds = 0;                      ///< that measuring took
  std::optional<Steadiness> steadiness{};  ///< empty in results of before it was noted
};

/// All that were done in one run.
struct ExperimentResults {
  Machine machine;
  Build build;
  std::string target;                ///< the instruction set of our kernels
  std::string date;                  ///< "2026-11-21", in UTC
  std::vector<std::string> command;  ///< the program's arguments, the program itself first
  bool quick = false;
  bool stopped = false;                     ///< before all were done; the one that was going on is left out
  std::optional<double> processor_share{};  ///< ProcessorShare of measuring; empty in results of before
  std::vector<ExperimentResult> results{};
};

/// What the experiment finds in these tables. Throws std::invalid_argument if the tables are not what it
/// judges by, or it comes to a figure that is not finite or has the name of another, or to a statement that
/// lacks its condition or names a figure that there is not.
Finding judged(const Experiment& experiment, const std::vector<Table>& tables);

/// What there is to say of a run that begins now, with no results yet.
ExperimentResults begin_results(std::span<const std::string> command, bool quick);

/// Does the experiments in turn, in this thread, and adds what they come to; `finished` is called after each.
/// Throws what measuring throws, but for Stopped.
void do_experiments(std::span<const Experiment* const> chosen, const Laboratory& laboratory,
                    ExperimentResults& results,
                    const std::function<void(const ExperimentResult&)>& finished = {});

/// One experiment as text for a terminal: the claim, the tables, the verdict on each statement and why.
std::string text_of(const ExperimentResult& result);

/// A line for each statement: label, name, verdict; and one that says how many measurements were unsteady,
/// if any.
std::string summary_of(const ExperimentResults& results);

/// One object by the schema "broadside.experiments/2": schema, machine, build, target, date, command, quick,
/// stopped, processor_share and busy where they are known, and a list of experiments, each with its texts,
/// its tables (columns, charts, rows), its finding and, where it is known, how many measurements there were
/// and how many of them unsteady. docs/schemas/ describes every field.
std::string json_of(const ExperimentResults& results);

/// What json_of() wrote, today or by the schema before, read back from the JSON in `text`; findings are not
/// read but made anew from the tables. `name` is what errors call the file. Throws FileError, with what was
/// found and expected where, if it is no such JSON, of another schema, holds no results, an unknown
/// experiment, or a cell that is neither a finite number, a text nor null; or if the tables are not what
/// their experiment judges by.
ExperimentResults read_experiments(std::string_view text, const std::string& name);

}  // namespace broadside::lab
