// The command-line program: runs a verb, and turns exceptions into an exit status and a message.
#include "broadside/program.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "broadside/algorithm.hpp"
#include "broadside/version.hpp"

#include "cli/help.hpp"
#include "cli/interruption.hpp"
#include "cli/message.hpp"
#include "cli/parse.hpp"
#include "cli/verbs.hpp"
#include "lab/catalogue.hpp"
#include "lab/platform/terminal.hpp"

namespace {

using broadside::cli::Exit;

/// Tells the current name of each algorithm that is requested by a former name.
void explain_former_names(std::span<const std::string> arguments) {
  for (const std::string& argument : arguments) {
    for (std::size_t begin = 0; begin < argument.size();) {
      const std::size_t end = std::min(argument.find(',', begin), argument.size());
      const std::string spec = argument.substr(begin, end - begin);
      const std::string name = spec.substr(0, spec.find(':'));
      begin = end + 1;
      const broadside::Algorithm* const found = broadside::find_algorithm(name);
      if (found != nullptr && found->name != name)
        broadside::cli::say(fmt::format("'{}' is a former name of {}", name, found->name));
    }
  }
}

Exit run(const std::vector<std::string>& given, const broadside::lab::Catalogue& catalogue) {
  const std::vector<std::string> arguments = broadside::cli::without_help_verb(given);
  CLI::App program("Finds overlapping boxes by every common broad-phase algorithm and compares them.",
                   broadside::cli::program_name());
  program.formatter(std::make_shared<broadside::cli::HelpFormatter>());
  program.set_help_flag("-h,--help", "Print this help and end");
  program.set_version_flag("--version", "broadside " BROADSIDE_VERSION, "Print the version and end");
  program.require_subcommand(1);
  program.footer(
      "Exit status: 0 fine, 1 a verification failed or nothing was verified, 2 unusable arguments or input, "
      "130 interrupted, 141 a pipe was closed by its reader.");
  const std::vector<std::pair<std::string, broadside::cli::Verb>> verbs = {
      {"compare", broadside::cli::add_compare(program, catalogue, given)},
      {"advise", broadside::cli::add_advise(program, catalogue, given)},
      {"measure", broadside::cli::add_measure(program, catalogue, given)},
      {"pairs", broadside::cli::add_pairs(program, catalogue)},
      {"info", broadside::cli::add_info(program)},
      {"verify", broadside::cli::add_verify(program, catalogue)},
      {"convert", broadside::cli::add_convert(program)},
      {"scene", broadside::cli::add_scene(program)},
      {"draw", broadside::cli::add_draw(program, catalogue)},
      {"list", broadside::cli::add_list(program, catalogue)},
      {"completion", broadside::cli::add_completion(program)},
  };
  program.add_subcommand(
      "help", fmt::format("Shows this help, or a verb's: {} help pairs.", broadside::cli::program_name()));
  // Verbs without a group are not shown: they are for programs.
  for (CLI::App* const verb : program.get_subcommands([](CLI::App*) { return true; }))
    verb->group(verb->get_group().empty() ? "" : "Verbs");
  if (const std::optional<std::string> text = broadside::cli::parse(program, arguments)) {
    broadside::cli::print(*text);
    return Exit::success;
  }
  explain_former_names(given);
  for (const auto& [name, verb] : verbs) {
    if (program.got_subcommand(name)) return verb();
  }
  return Exit::usage_error;
}

}  // namespace

namespace broadside {

int detail::run_program(int count, const char* const* values, std::span<const Algorithm> algorithms) {
  using cli::Exit;
  lab::platform::prepare_standard_streams();
  const std::vector<std::string> arguments = lab::platform::arguments(count, values);
  if (!arguments.empty()) cli::set_program_name(std::filesystem::path(arguments[0]).filename().string());
  cli::on_failing_write();
  cli::on_signal(cli::OnSignal::end);
  try {
    for (const Algorithm& algorithm : algorithms) register_algorithm(algorithm);
    const lab::Catalogue catalogue;
    const Exit exit = run(arguments, catalogue);
    cli::flush_output();
    return static_cast<int>(exit);
  } catch (const cli::Interruption& interruption) {
    cli::say(interruption.what());
    return static_cast<int>(Exit::interrupted);
  } catch (const std::bad_alloc&) {
    cli::say("out of memory; expected fewer boxes, frames or pairs");
    return static_cast<int>(Exit::usage_error);
  } catch (const std::exception& error) {
    cli::say(error.what());
    return static_cast<int>(Exit::usage_error);
  }
}

}  // namespace broadside
