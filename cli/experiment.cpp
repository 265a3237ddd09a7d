// broadside experiment: the paper's claims, tested.
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/applicability.hpp"
#include "cli/help.hpp"
#include "cli/interruption.hpp"
#include "cli/message.hpp"
#include "cli/options.hpp"
#include "cli/result_files.hpp"
#include "cli/verbs.hpp"
#include "lab/formats/format.hpp"
#include "lab/formats/input.hpp"
#include "lab/measure/steadiness.hpp"
#include "lab/numbers.hpp"
#include "lab/report/scene_drawings.hpp"
#include "paper/experiments/results.hpp"

namespace broadside::cli {
namespace {

struct ExperimentArguments {
  std::vector<std::string> names;
  bool is_quick = false;
  bool is_list = false;
  std::string from;
  ResultFiles files;
};

/// The named experiments, each once, in the order of the list; all if none was named.
std::vector<const lab::Experiment*> chosen(const std::vector<std::string>& names) {
  std::vector<const lab::Experiment*> all;
  if (names.empty()) {
    for (const lab::Experiment& experiment : lab::experiments()) all.push_back(&experiment);
  }
  for (const std::string& name : names) all.push_back(&lab::find_experiment(name));
  std::ranges::sort(all, std::less<>());  // they are elements of one list
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

struct NamedText {
  std::string name;  ///< what errors call it
  std::string text;
};

/// All of a file, or of standard input where the path is "-".
NamedText read_whole(const std::string& path) {
  try {
    lab::Input input(path);
    return {input.name(), std::string(input.bytes())};
  } catch (const lab::FileError& error) {
    throw Unusable(fmt::format("{}; expected results of experiments", error.what()));
  }
}

void print_list() {
  for (const lab::Experiment& experiment : lab::experiments())
    print(fmt::format("{:>2}  {:20}  {} ({})\n", experiment.label(), experiment.name, experiment.title,
                      experiment.is_own() ? "our own claim" : "section " + experiment.section));
}

void print_result(const lab::ExperimentResult& result) {
  print(lab::text_of(result) + '\n');
  flush_output();
}

/// Results of an earlier run, judged anew.
lab::ExperimentResults read(const ExperimentArguments& arguments) {
  const auto [name, text] = read_whole(arguments.from);
  lab::ExperimentResults results = lab::read_experiments(text, name);
  const std::vector<const lab::Experiment*> wanted = chosen(arguments.names);
  std::erase_if(results.results, [&](const lab::ExperimentResult& result) {
    return std::ranges::find(wanted, result.experiment) == wanted.end();
  });
  if (results.results.empty())
    throw Unusable(
        fmt::format("{}: no results of {}; expected some", name, fmt::join(arguments.names, ", ")));
  for (const lab::ExperimentResult& result : results.results) print_result(result);
  return results;
}

lab::ExperimentResults measure(const ExperimentArguments& arguments, const lab::Catalogue& catalogue,
                               std::span<const std::string> command) {
  const std::vector<const lab::Experiment*> wanted = chosen(arguments.names);
  ProgressLine progress;
  std::size_t finished = 0;
  const lab::Laboratory laboratory(
      catalogue, arguments.is_quick,
      {.stop = interrupted, .progress = [&](std::string_view what) {
         progress.show(what, static_cast<double>(finished) / static_cast<double>(wanted.size()));
       }});
  lab::ExperimentResults results = lab::begin_results(command, arguments.is_quick);
  on_signal(OnSignal::note_then_end);
  const lab::ProcessorShare share;
  lab::do_experiments(wanted, laboratory, results, [&](const lab::ExperimentResult& result) {
    ++finished;
    progress.clear();
    print_result(result);
  });
  results.processor_share = share.value();
  return results;
}

Exit run(const ExperimentArguments& arguments, const CLI::App& verb, const lab::Catalogue& catalogue,
         std::span<const std::string> command) {
  check_alone(verb, "--list", {"names", "--quick", "--from", "--json", "--report"}, "which only lists");
  check_alone(verb, "--from", {"--quick"}, "which measures nothing");
  if (arguments.is_list) {
    print_list();
    return Exit::fine;
  }
  check(arguments.files, arguments.from);
  const bool are_measured = arguments.from.empty();
  const lab::ExperimentResults results =
      are_measured ? measure(arguments, catalogue, command) : read(arguments);
  print(lab::summary_of(results) + (results.processor_share ? lab::busy_hint(*results.processor_share) : ""));
  if (arguments.files.any() && !results.results.empty()) {
    on_signal(OnSignal::end);
    const std::string json = lab::json_of(results);
    write(arguments.files, json, [&] {
      const auto find = [](std::string_view scene) { return lab::find_scene(scene); };
      return lab::PageContent{
          .date = results.date,
          .comparison = {},
          .experiments = json,
          .drawings = lab::drawings_of(lab::scenes_of_experiments(), find, catalogue.select("own,paper"))};
    });
    if (results.stopped && are_measured)
      say(fmt::format("stopped; wrote the {} that had ended to {}",
                      lab::counted(results.results.size(), "experiment", "experiments"),
                      arguments.files.names()));
  } else if (arguments.files.any()) {
    say(fmt::format("stopped before an experiment had ended; nothing is written to {}",
                    arguments.files.names()));
  }
  // Results that were read may be of a run that was stopped; this one was not.
  return results.stopped && arguments.from.empty() ? Exit::interrupted : Exit::fine;
}

}  // namespace

Verb add_experiment(CLI::App& program, const lab::Catalogue& catalogue,
                    std::span<const std::string> command) {
  const auto arguments = std::make_shared<ExperimentArguments>();
  CLI::App* const verb = program.add_subcommand(
      "experiment",
      "Tests the claims of the paper, each by an experiment with a verdict. All of them take up to twenty "
      "minutes, with --quick up to three.");
  verb->add_option(
      "names", arguments->names,
      "Names or numbers of experiments, as --list shows them; B1 is our own claim (default: all)");
  verb->add_flag("--list", arguments->is_list, "List the experiments");
  verb->add_flag("--quick", arguments->is_quick, "Fewer boxes and fewer samples, for a first impression");
  add_progress_options(*verb);
  verb->add_option(
          "--from", arguments->from,
          "Measure nothing; judge the results in this file, which --json has written; - is standard input")
      ->type_name("FILE");
  add_result_files(*verb, arguments->files);
  add_examples(
      *verb, {{"experiment --quick --report claims.html", "all claims, with fewer boxes, as a page"},
              {"experiment --from results.json 3", "the verdict on the third, of an earlier run's --json"}});
  return [arguments, verb, &catalogue, command] { return run(*arguments, *verb, catalogue, command); };
}

}  // namespace broadside::cli
