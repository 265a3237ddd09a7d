// broadside convert: writes the boxes of a file in another format.
#include "lab/convert.hpp"

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

#include "cli/input_options.hpp"
#include "cli/interruption.hpp"
#include "cli/message.hpp"
#include "cli/values.hpp"
#include "cli/verbs.hpp"

namespace broadside::cli {
namespace {

struct ConvertArguments {
  std::string file;
  InputOptions input;
  std::string output;
  std::string to;
};

Exit run(const ConvertArguments& arguments) {
  on_signal(OnSignal::end);
  check_writable("-o", arguments.output);
  const lab::Format& format = lab::writable_format(arguments.output, arguments.to);
  lab::ReadOptions options = read_options(arguments.input, arguments.file);
  // Rounded on the way out instead, where it is counted.
  const std::optional<lab::Precision> precision = std::exchange(options.precision, std::nullopt);
  lab::BoxFile file = lab::open_file(arguments.file, options);
  on_signal(OnSignal::note);
  const lab::Converted converted =
      lab::convert(std::move(file), arguments.output, format, precision, end_if_interrupted);
  if (!converted.warning.empty()) say(converted.warning);
  say(lab::text_of(converted, arguments.output, format));
  return Exit::fine;
}

}  // namespace

Verb add_convert(CLI::App& program) {
  const auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* const verb = program.add_subcommand(
      "convert",
      "Writes the boxes of a file in another format, frame by frame; `broadside list` tells which. The "
      "output may be the input: it is replaced once the new file is whole.");
  verb->add_option("file", arguments->file, "The file to read; - is standard input")->required();
  verb->add_option("-o,--output", arguments->output,
                   "The file to write, in the format that its extension says; - is standard output")
      ->required();
  verb->add_option("--to", arguments->to, "The format to write, by its name or an extension")
      ->type_name("NAME");
  add_input_options(*verb, arguments->input);
  return [arguments] { return run(*arguments); };
}

}  // namespace broadside::cli
