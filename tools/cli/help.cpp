// Formats --help to the width of the terminal.
#include "cli/help.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include "cli/message.hpp"
#include "lab/report/fold.hpp"

namespace broadside::cli {
namespace {

using lab::wrapped;

constexpr std::size_t default_width = 80;
constexpr std::size_t min_width = 40;
constexpr std::size_t max_width = 100;  // longer lines are hard to read

std::size_t help_width() {
  const std::size_t width = terminal_columns();
  return width == 0 ? default_width : std::clamp(width, min_width, max_width);
}

}  // namespace

HelpFormatter::HelpFormatter() : width_(help_width()) {
  column_width(std::min<std::size_t>(26, width_ / 3));
  label("SUBCOMMAND", "VERB");
  label("Positionals", "Arguments");
  label("TEXT", "VALUE");
  for (const char* const number : {"INT", "UINT", "FLOAT"}) label(number, "NUMBER");
}

std::string HelpFormatter::make_usage(const CLI::App* app, std::string name) const {
  std::string usage = CLI::Formatter::make_usage(app, std::move(name));
  usage.pop_back();
  return wrapped(usage, width_, 0, 2) + "\n";
}

std::string HelpFormatter::make_description(const CLI::App* app) const {
  return wrapped(app->get_description(), width_, 0, 0) + "\n";
}

std::string HelpFormatter::make_subcommand(const CLI::App* verb) const {
  return entry(verb->get_name(), verb->get_description());
}

HelpFormatter::OptionText HelpFormatter::entry_of(const CLI::Option& option, bool is_positional) const {
  std::string name;
  if (is_positional) {
    name = option.get_name(true, false);
  } else {
    for (const std::string& letter : option.get_snames()) name += (name.empty() ? "-" : ", -") + letter;
    if (!option.get_lnames().empty()) name += (name.empty() ? "--" : ", --") + option.get_lnames().front();
  }
  const bool is_shown_before = !is_positional && option.get_positional();
  if (is_shown_before) return {name, "The same as " + option.get_name(true, false)};
  const bool has_value = option.get_type_size() != 0 && !option.get_type_name().empty();
  if (has_value) name += " " + get_label(option.get_type_name());
  std::string text = option.get_description();
  if (!option.get_default_str().empty()) text += " (default: " + option.get_default_str() + ")";
  if (option.get_required()) text += " (required)";
  return {name, text};
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  const OptionText shown = entry_of(*option, is_positional);
  return entry(shown.name, shown.text);
}

std::string HelpFormatter::make_footer(const CLI::App* app) const {
  // Indented lines are commands to copy, so they are not wrapped.
  std::string footer;
  std::istringstream lines(app->get_footer());
  for (std::string line; std::getline(lines, line);)
    footer += (line.starts_with(' ') ? line : wrapped(line, width_, 0, 0)) + "\n";
  return footer;
}

std::string HelpFormatter::entry(const std::string& name, const std::string& text) const {
  const std::string begin = "  " + name + "  ";
  const std::size_t indent = get_column_width();
  const bool fits = begin.size() <= indent;
  const std::string space = fits ? std::string(indent - begin.size(), ' ') : "\n" + std::string(indent, ' ');
  return begin + space + wrapped(text, width_, indent, indent) + "\n";
}

void add_examples(CLI::App& verb, const std::vector<Example>& examples) {
  std::string footer = "Examples:";
  for (const Example& example : examples)
    footer += fmt::format("\n  {} {}\n      {}", program_name(), example.command, example.what);
  // The program's footer about all verbs comes last.
  verb.footer(footer + "\n\n" + verb.get_footer());
}

std::vector<std::string> without_help_verb(const std::vector<std::string>& arguments) {
  if (arguments.size() < 2 || arguments[1] != "help") return arguments;
  std::vector<std::string> asked = {arguments[0]};
  asked.insert(asked.end(), arguments.begin() + 2, arguments.end());
  asked.emplace_back("--help");
  return asked;
}

}  // namespace broadside::cli
