// broadside convert: writes the boxes of a file in another format.
#include "lab/convert.hpp"

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/help.hpp"
#include "cli/message.hpp"
#include "cli/options.hpp"
#include "cli/values.hpp"
#include "cli/verbs.hpp"

namespace broadside::cli {
namespace {

struct ConvertArguments {
  std::string file;
  InputOptions input;
  std::string ids;
  std::string output;
  std::string to;
};

Exit run(const ConvertArguments& arguments) {
  check_is_no_scene(arguments.file);
  check_writable("-o", arguments.output);
  check_is_other_file("-o", arguments.output, arguments.file);
  const lab::Format& format = lab::writable_format(arguments.output, arguments.to);
  lab::ReadOptions options = read_options(arguments.input, arguments.file);
  if (!arguments.ids.empty() && !format.keeps_ids)
    throw Unusable(fmt::format("--ids with format {}, which holds no ids; expected csv", format.name));
  options.ids = arguments.ids;
  options.finds_ids = format.keeps_ids;
  // Round while writing instead, where the rounding is counted.
  const std::optional<lab::Precision> precision = std::exchange(options.precision, std::nullopt);
  lab::BoxFile file = lab::open_file(arguments.file, options);
  const lab::Converted converted = lab::convert(std::move(file), arguments.output, format, precision);
  say_lines(converted.warning);
  const std::string left_out = lab::text_of_left_out(converted, format);
  if (!left_out.empty()) say(left_out);
  say(lab::text_of(converted, arguments.output, format));
  return Exit::success;
}

}  // namespace

Verb add_convert(CLI::App& program) {
  const auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* const verb = program.add_subcommand(
      "convert",
      "Writes the boxes of a file in another format, frame by frame; `broadside list` shows the formats. A "
      "table's ids stay where the format holds ids; a message names the columns that are left out.");
  verb->add_option("file", arguments->file, "The file to read; - is standard input")->required();
  verb->add_option("-o,--output", arguments->output,
                   "The file to write, in the format that its extension says; - is standard output")
      ->required();
  verb->add_option("--to", arguments->to, "The format to write, by its name or an extension")
      ->type_name("NAME");
  verb->add_option("--ids", arguments->ids,
                   "Keep these ids: a table's column (default: id, if there is one), or a map's property (id "
                   "is a feature's own)")
      ->type_name("NAME");
  add_input_options(*verb, arguments->input);
  add_examples(*verb, {{"convert boxes.csv -o boxes.npy", "a table as a NumPy array"},
                       {"convert counties.geojson --boxes segments --to csv -o -",
                        "a box a segment of each outline, to standard output"}});
  return [arguments] { return run(*arguments); };
}

}  // namespace broadside::cli
