// The command-line program: reads the verb and its options, runs it, and turns what it throws into an exit
// status and a message.
#include "broadside/program.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
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
#include "cli/man_page.hpp"
#include "cli/message.hpp"
#include "cli/verbs.hpp"
#include "lab/catalogue.hpp"
#include "lab/platform/terminal.hpp"

namespace broadside::cli {
namespace {

/// The verb that was called, or the program where there was none.
const CLI::App& called(const CLI::App& program) {
  const std::vector<CLI::App*> verbs = program.get_subcommands();
  return verbs.empty() ? program : *verbs.front();
}

std::string help_of(const CLI::App& program) {
  const CLI::App& verb = called(program);
  const std::string name = &verb == &program ? "" : verb.get_name() + " ";
  return fmt::format("`{} {}--help` tells more", program_name(), name);
}

std::vector<std::string> names_of_options(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* const option : verb.get_options()) {
    for (const std::string& letter : option->get_snames()) names.push_back("-" + letter);
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string name_of(const CLI::Option& option) {
  return option.get_positional() ? option.get_name(true, false) : option.get_name();
}

/// An argument that neither an option nor a position takes.
std::string about_extra(const CLI::App& verb, const std::string& argument) {
  if (!argument.starts_with('-'))
    return fmt::format(
        "unexpected argument '{}'; expected {}", argument,
        verb.get_options([](const CLI::Option* option) { return option->get_positional(); }).empty()
            ? "none"
            : "fewer");
  const std::string name = argument.substr(0, argument.find('='));
  const std::vector<std::string> known = names_of_options(verb);
  const std::string suggested = did_you_mean(name, known);
  return fmt::format("unknown option '{}'{}; expected {}", name, suggested,
                     suggested.empty() ? fmt::format("one of: {}", fmt::join(known, ", "))
                                       : "an option of " + verb.get_name());
}

/// The option whose value could not be read as a number; null if it is none of the verb's.
const CLI::Option* unreadable_option(const CLI::App& verb, const std::string& message) {
  for (const CLI::Option* const option : verb.get_options()) {
    if (option->count() > 0 && message.find(option->get_name()) != std::string::npos) return option;
  }
  return nullptr;
}

/// Throws Unusable if the first argument is neither a verb of the program nor an option.
void check_verb(const std::vector<std::string>& arguments, const CLI::App& program) {
  std::vector<std::string> known;
  for (const CLI::App* const verb : program.get_subcommands({})) known.push_back(verb->get_name());
  const std::string expected = fmt::format("expected one of: {}; --help tells more", fmt::join(known, ", "));
  if (arguments.size() < 2) throw Unusable("no verb; " + expected);
  const std::string& verb = arguments[1];
  if (!verb.starts_with('-') && std::ranges::find(known, verb) == known.end())
    throw Unusable(fmt::format("unknown verb '{}'{}; {}", verb, did_you_mean(verb, known), expected));
}

/// The message for arguments that CLI11 refused with `error`.
Unusable explained(const CLI::ParseError& error, const CLI::App& program) {
  const CLI::App& verb = called(program);
  // An option that is unknown tells more than one that is missing because of it.
  const std::vector<std::string> extras = program.remaining(true);
  std::string what = error.what();
  if (!extras.empty()) {
    what = about_extra(verb, extras.front());
  } else if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    const auto missing = verb.get_options(
        [](const CLI::Option* option) { return option->get_required() && option->count() == 0; });
    if (!missing.empty())
      what = fmt::format("{} is missing; expected: {}", name_of(*missing.front()),
                         missing.front()->get_description());
  } else if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
    if (const CLI::Option* const option = unreadable_option(verb, what))
      what =
          fmt::format("{} is '{}'; expected a number", option->get_name(), fmt::join(option->results(), ","));
  }
  return Unusable(fmt::format("{}; {}", what, help_of(program)));
}

}  // namespace
}  // namespace broadside::cli

namespace {

using broadside::cli::Exit;

/// Says which of the algorithms that are named have another name by now.
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
  if (broadside::cli::wants_man_page(given))
    program.formatter(std::make_shared<broadside::cli::ManPageFormatter>());
  else
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
      {"experiment", broadside::cli::add_experiment(program, catalogue, given)},
      {"pairs", broadside::cli::add_pairs(program, catalogue)},
      {"info", broadside::cli::add_info(program)},
      {"verify", broadside::cli::add_verify(program, catalogue)},
      {"convert", broadside::cli::add_convert(program)},
      {"scene", broadside::cli::add_scene(program)},
      {"draw", broadside::cli::add_draw(program, catalogue)},
      {"list", broadside::cli::add_list(program, catalogue)},
      {"completion", broadside::cli::add_completion(program)},
  };
  program.add_subcommand("help",
                         fmt::format("Shows this help, or a verb's: {} help pairs. With --man, as a page of "
                                     "the manual.",
                                     broadside::cli::program_name()));
  for (CLI::App* const verb : program.get_subcommands([](CLI::App*) { return true; })) verb->group("Verbs");
  broadside::cli::check_verb(arguments, program);
  try {
    // CLI11 takes the arguments in reverse and without the program.
    program.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend() - 1));
  } catch (const CLI::ParseError& error) {
    // Help and version end here as well, with status 0.
    if (error.get_exit_code() != 0) throw broadside::cli::explained(error, program);
    program.exit(error);
    return Exit::fine;
  }
  explain_former_names(given);
  for (const auto& [name, verb] : verbs) {
    if (program.got_subcommand(name)) return verb();
  }
  return Exit::unusable;
}

}  // namespace

namespace broadside {

int run_program(int count, const char* const* values, std::vector<Algorithm> algorithms) {
  using cli::Exit;
  lab::platform::prepare_standard_streams();
  const std::vector<std::string> arguments = lab::platform::arguments(count, values);
  if (!arguments.empty()) cli::set_program_name(std::filesystem::path(arguments[0]).filename().string());
  cli::on_failing_write();
  cli::on_signal(cli::OnSignal::end);
  try {
    for (Algorithm& algorithm : algorithms) register_algorithm(std::move(algorithm));
    const lab::Catalogue catalogue;
    const Exit exit = run(arguments, catalogue);
    cli::flush_output();
    return static_cast<int>(exit);
  } catch (const cli::Interruption& interruption) {
    cli::say(interruption.what());
    return static_cast<int>(Exit::interrupted);
  } catch (const std::bad_alloc&) {
    cli::say("out of memory; expected fewer boxes, frames or pairs");
    return static_cast<int>(Exit::unusable);
  } catch (const std::exception& error) {
    cli::say(error.what());
    return static_cast<int>(Exit::unusable);
  }
}

}  // namespace broadside
