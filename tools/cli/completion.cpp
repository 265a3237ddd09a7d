// broadside completion: generates shell completions.
#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "broadside/algorithm.hpp"

#include "cli/help.hpp"
#include "cli/message.hpp"
#include "cli/verbs.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::cli {
namespace {

/// The first clause of a text, without the full stop at its end.
std::string first_clause(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool ends = i + 1 == text.size() || text[i + 1] == ' ';
    if (ends && std::string_view(".:;").find(text[i]) != std::string_view::npos) return text.substr(0, i);
  }
  return text;
}

/// An option for shell completion.
struct CompletedOption {
  std::vector<std::string> letters;  ///< without the dash
  std::vector<std::string> names;    ///< without the dashes
  std::string summary;
  bool has_value;
  std::vector<std::string> values;  ///< known values; if empty, the value is a file name
};

struct CompletedVerb {
  std::string name;
  std::string summary;
  std::vector<CompletedOption> options;
  std::vector<std::string> values;  ///< known values of positional arguments
};

std::vector<std::string> algorithm_names() {
  std::vector<std::string> names = {"own", "paper", "literature", "peers", "all"};
  for (const Algorithm& algorithm : algorithms()) names.push_back(algorithm.name);
  return names;
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const lab::Scene& scene : lab::scenes()) names.push_back(scene.name);
  return names;
}

bool has_name(const CLI::Option& option, std::string_view name) {
  return std::ranges::count(option.get_lnames(), name) > 0;
}

std::vector<std::string> values_of(const CLI::Option& option) {
  if (has_name(option, "algorithm") || has_name(option, "algorithms")) return algorithm_names();
  if (has_name(option, "scenes") || has_name(option, "scene")) return scene_names();
  return {};
}

CompletedVerb completed(const CLI::App& app) {
  CompletedVerb verb{app.get_name(), first_clause(app.get_description()), {}, {}};
  for (const CLI::Option* const option : app.get_options()) {
    if (option->get_positional()) verb.values = values_of(*option);
    if (option->nonpositional())
      verb.options.push_back({option->get_snames(), option->get_lnames(),
                              first_clause(option->get_description()), option->get_type_size() != 0,
                              values_of(*option)});
  }
  return verb;
}

/// The program's verbs. `help` accepts their names, and `completion` those of the shells.
std::vector<CompletedVerb> completed_verbs(const CLI::App& program) {
  std::vector<CompletedVerb> verbs;
  std::vector<std::string> names;
  for (const CLI::App* const verb : program.get_subcommands({})) {
    verbs.push_back(completed(*verb));
    names.push_back(verb->get_name());
  }
  for (CompletedVerb& verb : verbs) {
    if (verb.name == "help") verb.values = names;
    if (verb.name == "completion") verb.values = {"bash", "zsh", "fish"};
  }
  return verbs;
}

/// The text in single quotes, which every shell here understands.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

std::string bash_words(const CompletedVerb& verb) {
  std::vector<std::string> words;
  for (const CompletedOption& option : verb.options) {
    for (const std::string& letter : option.letters) words.push_back("-" + letter);
    for (const std::string& name : option.names) words.push_back("--" + name);
  }
  return fmt::format("{}", fmt::join(words, " "));
}

std::string bash_script(const CLI::App& program, const std::vector<CompletedVerb>& verbs) {
  std::vector<std::string> names;
  std::string cases;
  for (const CompletedVerb& verb : verbs) {
    names.push_back(verb.name);
    cases += fmt::format("    {})\n      options='{}'\n      values='{}'\n      ;;\n", verb.name,
                         bash_words(verb), fmt::join(verb.values, " "));
  }
  return fmt::format(R"(# Completes the command lines of {0} in bash; made by `{0} completion bash`.
_{0}() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} options= values=
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W '{1} {2}' -- "$word")
    return
  fi
  case ${{COMP_WORDS[COMP_CWORD - 1]}} in
    --algorithm|--algorithms) values='{3}' ;;
    *)
      case ${{COMP_WORDS[1]}} in
{4}      esac
      ;;
  esac
  case $word in
    -*) mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word") ;;
    *) mapfile -t COMPREPLY < <(compgen -W "$values" -- "$word"; compgen -f -- "$word") ;;
  esac
}}
complete -o filenames -F _{0} {0}
)",
                     program_name(), fmt::join(names, " "), bash_words(completed(program)),
                     fmt::join(algorithm_names(), " "), cases);
}

/// The text escaped for _arguments and _describe of zsh.
std::string zsh_text(const std::string& text) {
  std::string result;
  for (const char c : text)
    result += std::string_view("[]:\\").find(c) == std::string_view::npos ? std::string(1, c)
                                                                          : std::string("\\") + c;
  return result;
}

std::string zsh_values(const std::vector<std::string>& values) {
  return values.empty() ? "_files" : fmt::format("{{compadd -- {}; _files}}", fmt::join(values, " "));
}

std::string zsh_options(const CompletedVerb& verb) {
  std::string lines;
  for (const CompletedOption& option : verb.options) {
    std::vector<std::string> all;
    for (const std::string& letter : option.letters) all.push_back("-" + letter);
    for (const std::string& name : option.names) all.push_back("--" + name);
    for (const std::string& one : all) {
      const std::string value = option.has_value ? ":value:" + zsh_values(option.values) : "";
      lines += fmt::format("        {} \\\n",
                           quoted(fmt::format("*{}[{}]{}", one, zsh_text(option.summary), value)));
    }
  }
  return lines;
}

std::string zsh_script(const CLI::App& program, const std::vector<CompletedVerb>& verbs) {
  std::string described;
  std::string cases;
  for (const CompletedVerb& verb : verbs) {
    described += fmt::format("    {}\n", quoted(verb.name + ":" + zsh_text(verb.summary)));
    cases += fmt::format("    {})\n      _arguments \\\n{}        {}\n      ;;\n", verb.name,
                         zsh_options(verb), quoted("*:argument:" + zsh_values(verb.values)));
  }
  return fmt::format(R"(#compdef {0}
# Completes the command lines of {0} in zsh; made by `{0} completion zsh`.
_{0}() {{
  local -a verbs
  verbs=(
{1}  )
  if (( CURRENT == 2 )); then
    _describe verb verbs
    _arguments \
{2}        ''
    return
  fi
  local verb=$words[2]
  shift words
  (( CURRENT -= 1 ))
  case $verb in
{3}  esac
}}
_{0} "$@"
)",
                     program_name(), described, zsh_options(completed(program)), cases);
}

std::string fish_options(const std::string& condition, const CompletedVerb& verb) {
  std::string lines;
  for (const CompletedOption& option : verb.options) {
    lines += fmt::format("complete -c {} -n {}", program_name(), quoted(condition));
    for (const std::string& letter : option.letters) lines += " -s " + letter;
    for (const std::string& name : option.names) lines += " -l " + name;
    if (option.has_value) lines += " -r";
    if (!option.values.empty()) lines += fmt::format(" -a '{}'", fmt::join(option.values, " "));
    lines += fmt::format(" -d {}\n", quoted(option.summary));
  }
  return lines;
}

std::string fish_script(const CLI::App& program, const std::vector<CompletedVerb>& verbs) {
  std::string script = fmt::format(
      "# Completes the command lines of {0} in fish; made by `{0} completion fish`.\n", program_name());
  script += fish_options("__fish_use_subcommand", completed(program));
  for (const CompletedVerb& verb : verbs) {
    const std::string condition = "__fish_seen_subcommand_from " + verb.name;
    script += fmt::format("complete -c {} -f -n __fish_use_subcommand -a {} -d {}\n", program_name(),
                          verb.name, quoted(verb.summary));
    script += fish_options(condition, verb);
    if (!verb.values.empty())
      script += fmt::format("complete -c {} -n {} -a '{}'\n", program_name(), quoted(condition),
                            fmt::join(verb.values, " "));
  }
  return script;
}

}  // namespace

Verb add_completion(CLI::App& program) {
  CLI::App* const verb = program.add_subcommand(
      "completion", "Writes what completes command lines in a shell; packages install it for all users.");
  const auto shell = std::make_shared<std::string>();
  verb->add_option("shell", *shell, "bash, zsh or fish")->required();
  add_examples(*verb, {{"completion bash >> ~/.bashrc", "in bash, from the next session on"},
                       {"completion fish > ~/.config/fish/completions/broadside.fish", "in fish"}});
  return [&program, shell] {
    const std::vector<CompletedVerb> verbs = completed_verbs(program);
    if (*shell == "bash")
      print(bash_script(program, verbs));
    else if (*shell == "zsh")
      print(zsh_script(program, verbs));
    else if (*shell == "fish")
      print(fish_script(program, verbs));
    else
      throw Unusable(fmt::format("shell is '{}'; expected bash, zsh or fish", *shell));
    return Exit::success;
  };
}

}  // namespace broadside::cli
