// broadside measure: measures a list of cases, each with its own algorithms, and writes every sample as JSON.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/help.hpp"
#include "cli/interruption.hpp"
#include "cli/message.hpp"
#include "cli/options.hpp"
#include "cli/values.hpp"
#include "cli/verbs.hpp"
#include "lab/formats/format.hpp"
#include "lab/formats/input.hpp"
#include "lab/formats/write_file.hpp"
#include "lab/measure/case_list.hpp"
#include "lab/measure/steadiness.hpp"
#include "lab/numbers.hpp"
#include "lab/report/json.hpp"
#include "paper/plain/plain.hpp"

namespace broadside::cli {
namespace {

struct MeasureArguments {
  std::string list;
  std::string json;
  bool only_checks = false;
};

Exit run(const MeasureArguments& arguments, const lab::Catalogue& catalogue,
         std::span<const std::string> command) {
  if (arguments.only_checks == !arguments.json.empty())
    throw Unusable(
        std::string(arguments.only_checks ? "both --check and --json are given" : "no --json is given") +
        "; expected --json FILE for the results, or --check to measure nothing");
  if (!arguments.json.empty()) {
    check_is_no_output("--json", arguments.json);
    check_extension("--json", arguments.json, {".json"});
    check_is_other_file("--json", arguments.json, arguments.list);
  }
  lab::Catalogue all = catalogue;
  for (Algorithm& algorithm : plain::algorithms()) all.add_outside_groups(std::move(algorithm));
  lab::Input input(arguments.list);
  const std::vector<lab::ListedCase> cases =
      lab::read_case_list(input.bytes(), input.name(), all, lab::scene_finder({}));
  if (arguments.only_checks) {
    print(lab::counted(cases.size(), "case", "cases") + "\n");
    return Exit::success;
  }
  check_writable("--json", arguments.json);

  on_signal(OnSignal::note_then_end);
  ProgressLine progress;
  std::size_t finished = 0;
  lab::Steadiness steadiness;
  const auto show = [&](std::string_view what) {
    progress.show(what, static_cast<double>(finished) / static_cast<double>(cases.size()));
  };
  const lab::Stopwatch watch;
  const lab::Comparison comparison = lab::measure_cases(all, cases, {.stop = interrupted, .progress = show},
                                                        [&](const lab::CaseResult& result) {
                                                          ++finished;
                                                          steadiness.add(lab::steadiness_of(result));
                                                        });
  progress.clear();
  if (comparison.stopped) {
    say(fmt::format("stopped; nothing is written to {}", arguments.json));
    return Exit::interrupted;
  }
  on_signal(OnSignal::end);
  const std::string json = lab::json_of(comparison, command);
  lab::write_file(arguments.json, [&json](std::ostream& file) { file << json; });
  for (const lab::CaseResult& result : comparison.cases) {
    for (const lab::Measurement& measurement : result.measurements) {
      if (measurement.outcome != lab::Outcome::verified)
        print(fmt::format("{}: {} has no time: {}\n", result.of.name, measurement.algorithm,
                          measurement.reason));
    }
  }
  print(fmt::format("{} in {}\n", lab::counted(cases.size(), "case", "cases"),
                    lab::duration(watch.milliseconds() / 1e3)) +
        lab::hint_of(steadiness, "") + lab::busy_hint(comparison.processor_share));
  return comparison.all_verified() ? Exit::success : Exit::failed;
}

}  // namespace

Verb add_measure(CLI::App& program, const lab::Catalogue& catalogue, std::span<const std::string> command) {
  const auto arguments = std::make_shared<MeasureArguments>();
  CLI::App* const verb = program.add_subcommand(
      "measure",
      "Measures a list of cases, each with its own algorithms, in fair rounds, every result verified. For "
      "programs such as the paper's experiments: docs/benchmarking.md says what a list holds.");
  verb->group("");
  verb->add_option("list", arguments->list, "The list, a file of JSON; - is standard input")
      ->required()
      ->type_name("FILE");
  verb->add_option("--json", arguments->json, "Write the results, with every sample, to this file")
      ->type_name("FILE");
  verb->add_flag("--check", arguments->only_checks, "Only check the list, and measure nothing");
  add_progress_options(*verb);
  add_examples(*verb, {{"measure cases.json --json results.json", "all cases of a list"}});
  return [arguments, &catalogue, command] { return run(*arguments, catalogue, command); };
}

}  // namespace broadside::cli
