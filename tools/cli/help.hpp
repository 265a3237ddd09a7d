// Formats --help to the width of the terminal.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>

namespace broadside::cli {

/// CLI11's help with every text wrapped to the width of the terminal, at most 100 columns. COLUMNS overrides
/// the width; it is 80 if unknown. An option is shown under its first name only.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();

  std::string make_usage(const CLI::App* app, std::string name) const override;
  std::string make_description(const CLI::App* app) const override;
  std::string make_subcommand(const CLI::App* verb) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_footer(const CLI::App* app) const override;

 protected:
  /// Text of an option: its spelling, such as "-o, --output FILE", and its description.
  struct OptionText {
    std::string name;
    std::string text;
  };
  OptionText entry_of(const CLI::Option& option, bool is_positional) const;

 private:
  std::string entry(const std::string& name, const std::string& text) const;

  std::size_t width_;
};

/// An example at the end of a verb's help: a command on one line, its effect below.
struct Example {
  std::string command;  ///< without the program's name
  std::string what;
};
void add_examples(CLI::App& verb, const std::vector<Example>& examples);

/// The program's arguments, with `help` and `help VERB` replaced by --help and VERB --help.
std::vector<std::string> without_help_verb(const std::vector<std::string>& arguments);

}  // namespace broadside::cli
