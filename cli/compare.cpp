// broadside compare: the comparison, as a table and as JSON.
#include "lab/measure/compare.hpp"

#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "cli/interruption.hpp"
#include "cli/unusable.hpp"
#include "cli/values.hpp"
#include "cli/verbs.hpp"
#include "lab/readers/write_file.hpp"
#include "lab/report/json.hpp"
#include "lab/report/table.hpp"

namespace broadside::cli {
namespace {

struct CompareArguments {
  std::string algorithms = "all";
  std::vector<std::string> scenes;
  std::vector<std::string> boxes;
  std::vector<int> dimensions;
  std::vector<double> moving;
  std::string frames;
  int threads = 1;
  std::uint64_t seed = 1;
  std::optional<double> budget;
  std::string json;
  bool is_long = false;
};

/// One line on stderr that is written over again and again; nothing where stderr is no terminal.
class ProgressLine {
 public:
  void show(std::string_view what) {
    const auto now = std::chrono::steady_clock::now();
    if (!on_terminal_ || now - shown_ < std::chrono::milliseconds(100)) return;
    shown_ = now;
    // A longer line would wrap and could not be written over.
    fmt::print(stderr, "\r\x1b[K{}", what.substr(0, 78));
  }

  void clear() {
    if (on_terminal_) fmt::print(stderr, "\r\x1b[K");
  }

 private:
  bool on_terminal_ = isatty(STDERR_FILENO) != 0;
  std::chrono::steady_clock::time_point shown_{};
};

std::vector<lab::CaseRequest> plan_of(const CompareArguments& arguments) {
  const bool own_plan = !arguments.scenes.empty() || !arguments.boxes.empty() || !arguments.moving.empty() ||
                        !arguments.frames.empty();
  if (own_plan) {
    if (arguments.is_long)
      throw Unusable("--long is a plan of its own; expected it without --scenes, -n, --moving and --frames");
    return lab::plan_of({
        .scenes = arguments.scenes,
        .boxes = read_counts("-n", arguments.boxes),
        .dimensions = arguments.dimensions,
        .moving = arguments.moving,
        .frames = arguments.frames.empty() ? 0 : read_count("--frames", arguments.frames),
    });
  }
  std::vector<lab::CaseRequest> plan = arguments.is_long ? lab::long_plan() : lab::quick_plan();
  return arguments.dimensions.empty() ? plan : lab::in_dimensions(std::move(plan), arguments.dimensions);
}

void check(const CompareArguments& arguments) {
  if (arguments.threads != 1)
    throw Unusable(fmt::format("--threads is {}; expected 1: the algorithms of this version use one thread",
                               arguments.threads));
  for (const int dimension : arguments.dimensions) check_dimension(dimension);
  for (const double moving : arguments.moving) check_fraction("--moving", moving);
  if (arguments.budget && !(*arguments.budget > 0))
    throw Unusable(fmt::format("--budget is {}; expected a number of seconds above 0", *arguments.budget));
  if (std::ranges::find(arguments.scenes, arguments.json) != arguments.scenes.end())
    throw Unusable(
        fmt::format("--json is {}, which is a scene as well; expected another file", arguments.json));
  if (!arguments.json.empty()) check_writable("--json", arguments.json);
}

Exit run(const CompareArguments& arguments, std::span<const std::string> command) {
  check(arguments);
  ProgressLine progress;
  lab::CompareOptions options;
  options.algorithms = arguments.algorithms;
  options.plan = plan_of(arguments);
  options.seed = arguments.seed;
  if (arguments.is_long) options.effort = lab::long_effort();
  if (arguments.budget) options.effort.budget_seconds = *arguments.budget;
  options.watch.stop = interrupted;
  options.watch.progress = [&](std::string_view what) { progress.show(what); };
  options.finished = [&](const lab::CaseResult& result) {
    progress.clear();
    fmt::print("{}\n", lab::table_of(result));
    std::fflush(stdout);
  };

  on_signal(OnSignal::note_then_end);
  const lab::Catalogue catalogue;
  const lab::Comparison comparison = lab::compare(catalogue, options);
  progress.clear();
  for (const std::string& warning : comparison.warnings) fmt::print(stderr, "broadside: {}\n", warning);
  fmt::print("{}", lab::summary_of(comparison));
  if (comparison.stopped) {
    if (!arguments.json.empty())
      fmt::print(stderr, "broadside: stopped; {} is not written\n", arguments.json);
    return Exit::interrupted;
  }
  if (!arguments.json.empty()) {
    on_signal(OnSignal::note);
    const std::string text = lab::json_of(comparison, command);
    lab::write_file(arguments.json, [&text](std::ostream& file) { file << text; });
  }
  return comparison.all_verified() ? Exit::fine : Exit::failed;
}

}  // namespace

Verb add_compare(CLI::App& program, std::span<const std::string> command) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App* const verb = program.add_subcommand(
      "compare",
      "Compares algorithms on scenes, every result verified. Without options: the quick comparison, which "
      "takes at most two minutes.");
  verb->add_option(
          "--algorithms", arguments->algorithms,
          "Names, specs such as grid:cell=2.5, or the groups own, paper, peers, all; a comma between")
      ->capture_default_str();
  verb->add_option("--scenes", arguments->scenes,
                   "Names, specs or files; a comma between (standard: every generated scene)")
      ->delimiter(',');
  verb->add_option("-n,--boxes", arguments->boxes,
                   "Numbers of boxes, such as 1000,100k,1e6 (standard: 10000)")
      ->delimiter(',');
  verb->add_option("--dimension", arguments->dimensions, "2, 3 or 2,3 (standard: both)")->delimiter(',');
  verb->add_option(
          "--moving", arguments->moving,
          "Fractions of the boxes that move, from 0 to 1; moving scenes are tracked, still ones found")
      ->delimiter(',');
  verb->add_option("--frames", arguments->frames,
                   "Frames of a moving scene (standard: 20); alone, a tenth of the boxes moves");
  verb->add_option("--threads", arguments->threads, "Threads an algorithm may use; in this version 1")
      ->capture_default_str();
  verb->add_option("--seed", arguments->seed, "Seed of a scene's first input; the others count up from it")
      ->check(is_seed)
      ->capture_default_str();
  verb->add_option("--budget", arguments->budget,
                   fmt::format("Seconds that one search, or one history, may take; a slower algorithm is "
                               "skipped and its time estimated (standard: {}, with --long {})",
                               lab::Effort{}.budget_seconds, lab::long_effort().budget_seconds));
  verb->add_option("--json", arguments->json, "Write the results to this file as well")->type_name("FILE");
  verb->add_flag("--long", arguments->is_long, "The long comparison: up to 1,000,000 boxes, more motion");
  return [arguments, command] { return run(*arguments, command); };
}

}  // namespace broadside::cli
