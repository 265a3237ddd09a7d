// broadside verify: runs the equivalence test on a file. If an algorithm or an engine fails, writes a small
// file that shows the failure.
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/help.hpp"
#include "cli/interruption.hpp"
#include "cli/message.hpp"
#include "cli/options.hpp"
#include "cli/scene_arguments.hpp"
#include "cli/values.hpp"
#include "cli/verbs.hpp"
#include "lab/verify/verify_file.hpp"

namespace broadside::cli {
namespace {

struct VerifyArguments {
  BoxArguments boxes;
  lab::VerifyOptions options;
  std::string counterexample;
};

Exit run(const VerifyArguments& arguments, const CLI::App& verb, const lab::Catalogue& catalogue) {
  on_signal(OnSignal::end);
  lab::VerifyOptions options = arguments.options;
  if (!(options.budget_seconds > 0))
    throw Unusable(
        fmt::format("--budget is {}; expected a number of seconds above 0", options.budget_seconds));
  if (!arguments.counterexample.empty()) {
    if (arguments.counterexample == "-") throw Unusable("--counterexample is '-'; expected a file");
    check_writable("--counterexample", arguments.counterexample);
    for (const std::string& file : arguments.boxes.scenes)
      check_is_other_file("--counterexample", arguments.counterexample, file);
    lab::writable_format(arguments.counterexample);
    options.counterexample = arguments.counterexample;
  }
  ProgressLine progress;
  options.watch.stop = interrupted;
  options.watch.progress = [&](std::string_view what) { progress.show(what); };
  catalogue.select(options.algorithms);  // refused before the file is read
  lab::BoxFile file = open_boxes(verb, arguments.boxes);
  on_signal(OnSignal::note_then_end);
  try {
    const lab::Verification verification = lab::verify_file(catalogue, std::move(file), options);
    progress.clear();
    say_lines(verification.warning);
    print(lab::text_of(verification, program_name()));
    return verification.all_verified() ? Exit::success : Exit::failed;
  } catch (const lab::Stopped&) {
    throw Interruption();
  }
}

}  // namespace

Verb add_verify(CLI::App& program, const lab::Catalogue& catalogue) {
  const auto arguments = std::make_shared<VerifyArguments>();
  CLI::App* const verb = program.add_subcommand(
      "verify",
      "Checks on a file or a scene that algorithms find exactly the overlapping pairs in every frame, and "
      "that they report exactly the changes between frames, in the precision of the input; and, in a trace "
      "that holds them, the pairs that an engine's own broad phase reported. If one fails, writes a small "
      "file that shows it and ends with status 1, also if all are skipped.");
  add_boxes(*verb, arguments->boxes);
  add_algorithms(*verb, arguments->options.algorithms);
  verb->add_option("--budget", arguments->options.budget_seconds,
                   "Seconds that each algorithm may take; one that needs more for a frame is skipped, "
                   "one that needs more for all stops there")
      ->capture_default_str();
  verb->add_option("--counterexample", arguments->counterexample,
                   "Where the small file is written (default: counterexample.csv, or .btrace where boxes "
                   "move or pairs are recorded; numbered where there is one already)")
      ->type_name("FILE");
  add_examples(*verb, {{"verify boxes.csv", "do all algorithms find exactly the overlapping pairs?"},
                       {"verify recording.btrace --algorithms auto,grid:cell=2.5",
                        "two of them, in every frame of a recording"}});
  return [arguments, verb, &catalogue] { return run(*arguments, *verb, catalogue); };
}

}  // namespace broadside::cli
