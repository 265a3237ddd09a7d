// broadside info: what a file of boxes holds.
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/input_options.hpp"
#include "cli/interruption.hpp"
#include "cli/message.hpp"
#include "cli/verbs.hpp"
#include "lab/file_info.hpp"

namespace broadside::cli {
namespace {

struct InfoArguments {
  std::string file;
  InputOptions input;
};

Exit run(const InfoArguments& arguments) {
  on_signal(OnSignal::end);
  const lab::FileInfo info = lab::file_info(arguments.file, read_options(arguments.input, arguments.file));
  if (!info.warning.empty()) say(info.warning);
  print(lab::text_of(info));
  return Exit::fine;
}

}  // namespace

Verb add_info(CLI::App& program) {
  const auto arguments = std::make_shared<InfoArguments>();
  CLI::App* const verb = program.add_subcommand("info",
                                                "Tells what a file holds: how many boxes and frames, where, "
                                                "how large (of the frame that has the most), "
                                                "and how they move. Reads it frame by frame.");
  verb->add_option("file", arguments->file, "The file; - is standard input")->required();
  add_input_options(*verb, arguments->input);
  return [arguments] { return run(*arguments); };
}

}  // namespace broadside::cli
