// What --help prints, in lines that the terminal holds.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>

namespace broadside::cli {

/// CLI11's help with every text wrapped to the width of the terminal (COLUMNS, where it is set; 80 where
/// neither tells), at most 100. An option is shown under its first name alone.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();

  std::string make_usage(const CLI::App* app, std::string name) const override;
  std::string make_description(const CLI::App* app) const override;
  std::string make_subcommand(const CLI::App* verb) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_footer(const CLI::App* app) const override;

 protected:
  /// What is shown of an option: how it is written, such as "-o, --output FILE", and what it does.
  struct OptionText {
    std::string name;
    std::string text;
  };
  OptionText entry_of(const CLI::Option& option, bool is_positional) const;

 private:
  std::string entry(const std::string& name, const std::string& text) const;

  std::size_t width_;
};

/// Ends a verb's help with examples: a command a line, under it what it does.
struct Example {
  std::string command;  ///< without the program's name
  std::string what;
};
void add_examples(CLI::App& verb, const std::vector<Example>& examples);

/// The program's arguments, in which `help` and `help VERB` have become --help and VERB --help.
std::vector<std::string> without_help_verb(const std::vector<std::string>& arguments);

}  // namespace broadside::cli
