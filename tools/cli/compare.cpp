// broadside compare: the comparison, as lines or tables, as JSON and as a page.
#include "lab/measure/compare.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/applicability.hpp"
#include "cli/help.hpp"
#include "cli/interruption.hpp"
#include "cli/message.hpp"
#include "cli/options.hpp"
#include "cli/result_files.hpp"
#include "cli/scene_arguments.hpp"
#include "cli/values.hpp"
#include "cli/verbs.hpp"
#include "lab/numbers.hpp"
#include "lab/report/fold.hpp"
#include "lab/report/json.hpp"
#include "lab/report/machine.hpp"
#include "lab/report/scene_drawings.hpp"
#include "lab/report/table.hpp"

namespace broadside::cli {
namespace {

struct CompareArguments {
  EntryOptions entries{.algorithms = "all"};
  std::vector<std::string> scenes;
  InputOptions input;
  std::vector<std::string> boxes;
  std::vector<int> dimensions;
  std::vector<double> moving;
  std::string frames;
  std::optional<double> left;
  bool filtered = false;
  MotionOptions motion;
  std::optional<std::uint64_t> seed;
  std::optional<double> budget;
  ResultFiles files;
  std::string check;
  bool is_long = false;
  bool is_cold = false;
  bool has_details = false;
};

/// Whether the user says what to compare, instead of taking the quick or the long comparison.
bool names_cases(const CompareArguments& arguments) {
  return !arguments.scenes.empty() || !arguments.boxes.empty() || !arguments.moving.empty() ||
         !arguments.frames.empty() || arguments.left || arguments.filtered || arguments.motion.any();
}

std::vector<lab::CaseRequest> plan_of(const CompareArguments& arguments, const lab::FindScene& find) {
  if (names_cases(arguments)) {
    if (arguments.is_long)
      throw Unusable(
          "--long is a plan of its own; expected it without --scenes, -n, --left, --filtered, --moving, "
          "--frames, "
          "--drift and --teleport");
    return lab::plan_of({
        .scenes = arguments.scenes,
        .boxes = read_counts("-n", arguments.boxes),
        .dimensions = arguments.dimensions,
        .moving = arguments.moving,
        .left = arguments.left.value_or(0),
        .filtered = arguments.filtered,
        .frames = arguments.frames.empty() ? 0 : read_count("--frames", arguments.frames),
        .drift = arguments.motion.drift_or_standard(),
        .teleport = arguments.motion.teleport_or_standard(),
        .find = find,
    });
  }
  std::vector<lab::CaseRequest> plan = arguments.is_long ? lab::long_plan() : lab::quick_plan();
  return arguments.dimensions.empty() ? plan : lab::in_dimensions(std::move(plan), arguments.dimensions);
}

void check(const CompareArguments& arguments) {
  for (const int dimension : arguments.dimensions) check_dimension(dimension);
  for (const double moving : arguments.moving) check_fraction("--moving", moving);
  check(arguments.motion);
  if (arguments.left && !(*arguments.left > 0 && *arguments.left < 1))
    throw Unusable(fmt::format("--left is {}; expected a fraction above 0 and below 1", *arguments.left));
  if (arguments.left && arguments.filtered)
    throw Unusable("--left with --filtered; expected one or the other");
  const char* const still = arguments.left ? "--left" : arguments.filtered ? "--filtered" : nullptr;
  if (still != nullptr && (!arguments.moving.empty() || !arguments.frames.empty() || arguments.motion.any()))
    throw Unusable(fmt::format(
        "{} compares boxes at rest; expected it without --moving, --frames, --drift and --teleport", still));
  const bool any_moves = std::ranges::any_of(arguments.moving, [](double moving) { return moving > 0; });
  if (arguments.motion.any() && !any_moves && arguments.frames.empty())
    throw Unusable("--drift and --teleport say how boxes move; expected --moving or --frames as well");
  if (arguments.budget && !(*arguments.budget > 0))
    throw Unusable(fmt::format("--budget is {}; expected a number of seconds above 0", *arguments.budget));
  for (const auto& [option, path] :
       {std::pair("--json", arguments.files.json), std::pair("--report", arguments.files.report)}) {
    if (std::ranges::find(arguments.scenes, path) != arguments.scenes.end())
      throw Unusable(fmt::format("{} is {}, which is a scene as well; expected another file", option, path));
  }
  check(arguments.files);
}

/// Refuses options that apply to nothing that is compared, and reports scenes that ignore an option.
void check_applies(const CLI::App& verb, const CompareArguments& arguments, const lab::FindScene& find,
                   const lab::Catalogue& catalogue) {
  std::vector<lab::NamedScene> scenes;
  for (const std::string& name : arguments.scenes) scenes.push_back(find(name));
  const bool is_named = !scenes.empty();
  for (const lab::Scene& scene : lab::scenes()) {
    if (!is_named && scene.kind == lab::SceneKind::generated && !scene.hard)
      scenes.push_back(find(scene.name));
  }
  const std::vector<std::string> remarks = check_options(verb, scenes);
  for (const std::string& remark : remarks) {
    if (is_named) say(remark);
  }
  check_moves(verb, scenes);
  check_threads(arguments.entries, catalogue.select(arguments.entries.algorithms));
}

/// Number of boxes of the largest search that is checked by definition, from the text of --check.
std::size_t definition_boxes(const std::string& text) {
  constexpr std::string_view name = "definition=";
  if (!text.starts_with(name))
    throw Unusable(fmt::format("--check is '{}'; expected definition= and a number of boxes", text));
  return read_count("--check definition", text.substr(name.size()));
}

/// Says where the details are that the lines leave out.
std::string details_hint(const ResultFiles& files) {
  return fmt::format(
      "details: --details prints each case's table; {}\n",
      files.any() ? "every sample is in " + files.names() : "--json or --report FILE keeps every sample");
}

Exit run(CompareArguments& arguments, const CLI::App& verb, const lab::Catalogue& catalogue,
         std::span<const std::string> command) {
  arguments.scenes = each_of(arguments.scenes);
  check(arguments);
  ProgressLine progress;
  lab::CompareOptions options;
  options.algorithms = arguments.entries.algorithms;
  options.threads = threads_of(arguments.entries);
  options.find = lab::scene_finder(read_options(arguments.input));
  check_applies(verb, arguments, options.find, catalogue);
  options.plan = plan_of(arguments, options.find);
  options.seed = arguments.seed.value_or(options.seed);
  if (!names_cases(arguments)) options.effort = arguments.is_long ? lab::long_effort() : lab::quick_effort();
  options.measure_options.cold = arguments.is_cold;
  if (arguments.budget) options.effort.budget_seconds = options.effort.history_seconds = *arguments.budget;
  if (!arguments.check.empty()) options.effort.definition_boxes = definition_boxes(arguments.check);
  options.watch.stop = interrupted;
  std::size_t finished = 0;
  options.watch.progress = [&](std::string_view what) {
    progress.show(what, static_cast<double>(finished) / static_cast<double>(options.plan.size()));
  };
  const std::size_t width = output_width();
  options.finished = [&, is_first = true](const lab::CaseResult& result) mutable {
    ++finished;
    progress.clear();
    if (arguments.has_details)
      print(lab::table_of(result, width) + '\n');
    else
      print((is_first ? lab::case_line_heading(width) : "") + lab::case_line(result, width));
    is_first = false;
    flush_output();
  };

  on_signal(OnSignal::note_then_end);
  const lab::Comparison comparison = lab::compare(catalogue, options);
  progress.clear();
  for (const std::string& warning : comparison.warnings) say_lines(warning);
  print((arguments.has_details || comparison.cases.empty() ? "" : "\n") + lab::summary_of(comparison, width));
  if (arguments.files.any() && (!comparison.stopped || !comparison.cases.empty())) {
    on_signal(OnSignal::end);
    const std::string json = lab::json_of(comparison, command);
    write(arguments.files, json, [&] {
      return lab::PageContent{.date = lab::today(),
                              .comparison = json,
                              .drawings = lab::drawings_of(lab::scenes_of(comparison), options.find,
                                                           catalogue.select(arguments.entries.algorithms))};
    });
    if (comparison.stopped)
      say(fmt::format("stopped; wrote the {} that had ended to {}",
                      lab::counted(comparison.cases.size(), "case", "cases"), arguments.files.names()));
  } else if (arguments.files.any()) {
    say(fmt::format("stopped before a case had ended; nothing is written to {}", arguments.files.names()));
  }
  if (!arguments.has_details && !comparison.cases.empty())
    print(lab::folded(details_hint(arguments.files), width));
  if (comparison.stopped) return Exit::interrupted;
  return comparison.all_verified() ? Exit::success : Exit::failed;
}

}  // namespace

Verb add_compare(CLI::App& program, const lab::Catalogue& catalogue, std::span<const std::string> command) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App* const verb = program.add_subcommand(
      "compare",
      "Compares algorithms on scenes, every result verified. Without options: the quick comparison, which "
      "takes about a minute and a half.");
  add_scenes(*verb, "scenes", arguments->scenes,
             "Names, specs such as power_law:exponent=2, or files, - for standard input (default: every "
             "generated scene)");
  add_algorithms(*verb, arguments->entries.algorithms);
  add_file_options(*verb, arguments->input);
  verb->add_option("-n", arguments->boxes, "Numbers of boxes, such as 1000,100k,1e6 (default: 10000)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NUMBERS");
  verb->add_option("--dimension", arguments->dimensions, "2, 3 or 2,3 (default: both)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NUMBERS")
      ->check(is_dimension);
  verb->add_option(
          "--moving", arguments->moving,
          "Fractions of the boxes that move, from 0 to 1; moving scenes are tracked, still ones found")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NUMBERS");
  verb->add_option("--frames", arguments->frames,
                   "Frames of a moving scene (default: 20); alone, a tenth of the boxes moves");
  verb->add_option("--left", arguments->left,
                   "Join two sets: this fraction of the boxes, drawn at random, is the left set, and the "
                   "others are the right set; only pairs across the two count")
      ->type_name("FRACTION");
  verb->add_flag("--filtered", arguments->filtered,
                 "Give boxes the filters of a game: a third is static, and debris and sensors ignore each "
                 "other; two thirds of the overlapping pairs count");
  add_motion_options(*verb, arguments->motion);
  add_threads(*verb, arguments->entries,
              "Number of threads to search with (0: as many as the machine has), or several, such as "
              "1,2. An algorithm that cannot use several takes part once, with one thread");
  verb->add_option("--seed", arguments->seed,
                   "Seed of a scene's first input; the others count up from it (default: 1)")
      ->check(is_seed);
  verb->add_option("--budget", arguments->budget,
                   fmt::format("Seconds that one search, or one history, may take; a slower algorithm is "
                               "skipped and its time estimated (default: {} and {}, with --long {})",
                               lab::Effort{}.budget_seconds, lab::Effort{}.history_seconds,
                               lab::long_effort().budget_seconds));
  verb->add_option(
          "--check", arguments->check,
          fmt::format("How much is checked by the definition: definition=N for searches of up to N boxes "
                      "(default: {}), and for histories of up to four times as many tests; what has more is "
                      "cross-checked",
                      lab::Effort{}.definition_boxes))
      ->type_name("definition=N");
  add_result_files(*verb, arguments->files);
  verb->add_flag("--details", arguments->has_details,
                 "Print a table a case, with every algorithm's time, memory and tests, instead of a line");
  verb->add_flag("--cold", arguments->is_cold,
                 "Empty all caches before each call, not only the small ones; takes far longer");
  verb->add_flag("--long", arguments->is_long, "The long comparison: up to 1,000,000 boxes, more motion");
  add_examples(
      *verb,
      {{"compare uniform clustered -n 1000,100k --algorithms own", "our algorithms on two scenes"},
       {"compare boxes.csv --moving 0.1 --json out.json", "all on your boxes, while a tenth of them moves"}});
  return [arguments, verb, &catalogue, command] { return run(*arguments, *verb, catalogue, command); };
}

}  // namespace broadside::cli
