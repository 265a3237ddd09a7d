// The help of the program or of a verb as a page of the manual, for man.
#include "cli/man_page.hpp"

#include <algorithm>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "broadside/version.hpp"

#include "cli/message.hpp"

namespace broadside::cli {
namespace {

/// The text with what roff would read as its own written out.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
  }
  const bool is_request = !text.empty() && (text[0] == '.' || text[0] == '\'');
  return is_request ? "\\&" + result : result;
}

std::string heading(std::string_view text) { return fmt::format(".SH {}\n", text); }

std::string paragraph(const std::string& name, const std::string& text) {
  return fmt::format(".TP\n.B {}\n{}\n", escaped(name), escaped(text));
}

/// The words of a text that was wrapped.
std::string in_one_line(const std::string& text) {
  std::string line;
  std::istringstream words(text);
  for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
  return line;
}

/// What a footer says: examples, and then the meaning of exit statuses.
std::string footer_of(const CLI::App& app) {
  static constexpr std::string_view status = "Exit status: ";
  std::string page;
  std::istringstream lines(app.get_footer());
  for (std::string line; std::getline(lines, line);) {
    if (line == "Examples:")
      page += heading("EXAMPLES");
    else if (line.starts_with(status))
      page += heading("EXIT STATUS") + escaped(line.substr(status.size())) + "\n";
    else if (line.starts_with("      "))
      page += escaped(line.substr(6)) + "\n";
    else if (line.starts_with("  "))
      page += fmt::format(".TP\n.B {}\n", escaped(line.substr(2)));
  }
  return page;
}

}  // namespace

std::string ManPageFormatter::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode) const {
  std::string page_name = name;
  std::ranges::replace(page_name, ' ', '-');
  std::string title = page_name;
  std::ranges::transform(title, title.begin(),
                         [](char c) { return c >= 'a' && c <= 'z' ? char(c - 32) : c; });
  std::string page =
      fmt::format(".TH {} 1 \"\" \"Broadside {}\" \"User Commands\"\n", title, BROADSIDE_VERSION);
  page += heading("NAME") +
          fmt::format("{} \\- {}\n", escaped(page_name), escaped(first_clause(app->get_description())));

  const std::string usage = in_one_line(make_usage(app, name));
  const std::string arguments = usage.substr(usage.find(name) + name.size() + 1);
  page += heading("SYNOPSIS") + fmt::format(".B {}\n{}\n", escaped(name), escaped(arguments));
  page += heading("DESCRIPTION") + escaped(app->get_description()) + "\n";

  const std::vector<const CLI::App*> verbs =
      app->get_subcommands([](const CLI::App* verb) { return !verb->get_name().empty(); });
  if (!verbs.empty()) page += heading("VERBS");
  for (const CLI::App* const verb : verbs) page += paragraph(verb->get_name(), verb->get_description());

  std::string positionals;
  std::string options;
  for (const CLI::Option* const option : app->get_options()) {
    if (option->get_positional()) {
      const Entry shown = entry_of(*option, true);
      positionals += paragraph(shown.name, shown.text);
    }
    if (option->nonpositional() && !option->get_group().empty()) {
      const Entry shown = entry_of(*option, false);
      options += paragraph(shown.name, shown.text);
    }
  }
  if (!positionals.empty()) page += heading("ARGUMENTS") + positionals;
  page += heading("OPTIONS") + options + footer_of(*app);

  page += heading("SEE ALSO");
  if (app->get_parent() != nullptr) return page + fmt::format(".BR {} (1)\n", escaped(program_name()));
  std::string others;
  for (const CLI::App* const verb : verbs) {
    if (verb->get_name() != "help")
      others +=
          fmt::format("{}.BR {} (1)", others.empty() ? "" : ",\n", escaped(name + "-" + verb->get_name()));
  }
  return page + others + "\n";
}

}  // namespace broadside::cli
