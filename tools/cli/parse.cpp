// Parses the arguments of a program with verbs, and explains arguments that cannot be used.
#include "cli/parse.hpp"

#include <algorithm>
#include <sstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "broadside/algorithm.hpp"

#include "cli/message.hpp"
#include "src/core/suggestion.hpp"

namespace broadside::cli {
namespace {

/// The verb that was called, or the program if there was none.
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

/// An option of earlier versions and its replacement; docs/migration.md lists them all.
struct RemovedOption {
  std::string_view verb;
  std::string_view name;
  std::string_view instead;
};

constexpr RemovedOption removed_options[] = {
    {"compare", "--merge",
     "`python3 -m tools.paper compare`, which measures several processes and gives intervals between them"},
    {"compare", "--samples", "--json, which has every sample"},
};

/// Message about an argument that is neither a known option nor an expected positional argument.
std::string about_extra(const CLI::App& verb, const std::string& argument) {
  if (!argument.starts_with('-'))
    return fmt::format(
        "unexpected argument '{}'; expected {}", argument,
        verb.get_options([](const CLI::Option* option) { return option->get_positional(); }).empty()
            ? "none"
            : "fewer");
  const std::string name = argument.substr(0, argument.find('='));
  for (const RemovedOption& removed : removed_options) {
    if (removed.verb == verb.get_name() && removed.name == name)
      return fmt::format("option '{}' is no longer there; expected {}", name, removed.instead);
  }
  const std::vector<std::string> known = names_of_options(verb);
  const std::string suggested = core::did_you_mean(name, known);
  return fmt::format("unknown option '{}'{}; expected {}", name, suggested,
                     suggested.empty() ? fmt::format("one of: {}", fmt::join(known, ", "))
                                       : "an option of " + verb.get_name());
}

/// The option whose value could not be read as a number; null if it is none of the verb's options.
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
  if (verb == "experiment")
    throw Unusable(
        "verb 'experiment' is no longer there; expected `make experiments`, which measures and judges the "
        "paper's claims, or `python3 -m tools.paper run` for some of them (tools/paper/README.md)");
  if (!verb.starts_with('-') && std::ranges::find(known, verb) == known.end())
    throw Unusable(fmt::format("unknown verb '{}'{}; {}", verb, core::did_you_mean(verb, known), expected));
}

/// The message for arguments that CLI11 refused with `error`.
Unusable explained(const CLI::ParseError& error, const CLI::App& program) {
  const CLI::App& verb = called(program);
  // An unknown option is more informative than a missing one that it caused.
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

std::optional<std::string> parse(CLI::App& program, const std::vector<std::string>& arguments) {
  check_verb(arguments, program);
  try {
    // CLI11 takes the arguments in reverse and without the program.
    program.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend() - 1));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw explained(error, program);
    std::ostringstream text;
    program.exit(error, text);
    return text.str();
  }
  return std::nullopt;
}

}  // namespace broadside::cli
