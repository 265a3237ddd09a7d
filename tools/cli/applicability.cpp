// Checks whether the given options apply to the scenes and files they were given with.
#include "cli/applicability.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "cli/message.hpp"

namespace broadside::cli {
namespace {

bool is_read_from_file(const lab::Scene& scene) { return scene.kind == lab::SceneKind::file; }
bool has_count(const lab::Scene& scene) { return !scene.fixed_count; }
bool has_seed(const lab::Scene& scene) { return !scene.fixed_seed; }
bool moves_by_itself(const lab::Scene& scene) { return scene.history_2d || scene.history_3d; }
bool is_still(const lab::Scene& scene) { return !moves_by_itself(scene); }

/// An option, the scenes it applies to, and the messages about one scene and about several that it does not
/// apply to.
struct Rule {
  std::string_view option;
  bool (*applies)(const lab::Scene&);
  std::string_view one;
  std::string_view several;
};

constexpr std::string_view no_file = "is no file";
constexpr std::string_view no_files = "are no files";
constexpr std::string_view mover = "moves by itself";
constexpr std::string_view movers = "move by themselves";

constexpr std::array rules = {
    Rule{"--format", is_read_from_file, no_file, no_files},
    Rule{"--boxes", is_read_from_file, no_file, no_files},
    Rule{"--array", is_read_from_file, no_file, no_files},
    Rule{"--columns", is_read_from_file, no_file, no_files},
    Rule{"--skip-invalid", is_read_from_file, no_file, no_files},
    Rule{"--precision", is_read_from_file, "is of floats and no file", "are of floats and no files"},
    Rule{"-n", has_count, "has a number of boxes of its own", "have numbers of boxes of their own"},
    Rule{"--seed", has_seed, "is the same for every seed", "are the same for every seed"},
    Rule{"--moving", is_still, mover, movers},
    Rule{"--drift", is_still, mover, movers},
    Rule{"--teleport", is_still, mover, movers},
};

/// The text of an option's value; empty if it was not given, or the verb does not have it.
std::optional<std::string> value_of(const CLI::App& verb, std::string_view option) {
  const CLI::Option* const found = verb.get_option_no_throw(std::string(option));
  if (found == nullptr || found->count() == 0) return std::nullopt;
  return fmt::format("{}", fmt::join(found->results(), ","));
}

bool is_flag(const CLI::App& verb, std::string_view option) {
  return verb.get_option(std::string(option))->get_expected_max() == 0;
}

/// "scene 'a'", "scenes 'a', 'b' and 'c'", "scenes 'a', 'b', 'c' and 9 others".
std::string names_of(std::span<const lab::NamedScene> scenes) {
  constexpr std::size_t max_names = 3;
  if (scenes.size() == 1)
    return fmt::format("{} '{}'", is_read_from_file(scenes[0].scene) ? "file" : "scene", scenes[0].spec.name);
  std::string names = "scenes ";
  for (std::size_t i = 0; i < std::min(scenes.size(), max_names); ++i) {
    const bool is_last = i + 1 == scenes.size();
    names += fmt::format("{}'{}'", i == 0 ? "" : is_last ? " and " : ", ", scenes[i].spec.name);
  }
  return scenes.size() > max_names ? fmt::format("{} and {} others", names, scenes.size() - max_names)
                                   : names;
}

bool is_number(std::string_view text) {
  double number = 0;
  return std::from_chars(text.data(), text.data() + text.size(), number).ec == std::errc();
}

std::string expected_for(const CLI::App& verb, const Rule& rule, const std::string& value) {
  if (rule.applies != is_read_from_file) return "none";
  const bool is_count =
      rule.option == "--boxes" && is_number(value) && verb.get_option_no_throw("-n") != nullptr;
  return is_count ? fmt::format("a file, or -n {} for the number of boxes", value) : "a file, or none";
}

}  // namespace

lab::NamedScene unread_file(const std::string& path) {
  return {{.name = path,
           .summary = {},
           .source = {},
           .kind = lab::SceneKind::file,
           .fixed_count = true,
           .fixed_seed = true},
          Spec{path, {}}};
}

std::vector<std::string> check_options(const CLI::App& verb, std::span<const lab::NamedScene> scenes,
                                       std::initializer_list<std::string_view> taken) {
  std::vector<std::string> remarks;
  for (const Rule& rule : rules) {
    const std::optional<std::string> value = value_of(verb, rule.option);
    if (!value || std::ranges::find(taken, rule.option) != taken.end()) continue;
    const auto applies = [&rule](const lab::NamedScene& named) { return rule.applies(named.scene); };
    if (std::ranges::none_of(scenes, applies))
      throw Unusable(fmt::format("{}{} for {}, which {}; expected {}", rule.option,
                                 is_flag(verb, rule.option) ? "" : fmt::format(" is '{}'", *value),
                                 names_of(scenes), scenes.size() == 1 ? rule.one : rule.several,
                                 expected_for(verb, rule, *value)));
    if (rule.applies == is_read_from_file) continue;
    for (const lab::NamedScene& named : scenes) {
      if (!applies(named))
        remarks.push_back(
            fmt::format("{} is ignored by scene '{}', which {}", rule.option, named.spec.name, rule.one));
    }
  }
  return remarks;
}

void check_moves(const CLI::App& verb, std::span<const lab::NamedScene> scenes) {
  const CLI::Option* const moving = verb.get_option_no_throw("--moving");
  if (moving == nullptr || moving->count() == 0) return;
  const auto is_zero = [](const std::string& text) {
    double fraction = 1;
    std::from_chars(text.data(), text.data() + text.size(), fraction);
    return fraction == 0;
  };
  const auto moves = [](const lab::NamedScene& named) { return moves_by_itself(named.scene); };
  if (std::ranges::all_of(moving->results(), is_zero) && std::ranges::none_of(scenes, moves))
    check_alone(verb, "--moving", {"--frames", "--drift", "--teleport"}, "so that no box moves");
}

void check_alone(const CLI::App& verb, const std::string& option, std::initializer_list<const char*> others,
                 std::string_view why) {
  const std::optional<std::string> value = value_of(verb, option);
  if (!value) return;
  const auto shown = [&verb](const std::string& name, const std::string& text) {
    return is_flag(verb, name) ? name : fmt::format("{} {}", name, text);
  };
  for (const char* const other : others) {
    if (const std::optional<std::string> found = value_of(verb, other))
      throw Unusable(fmt::format("{} with {}, {}; expected one or the other", shown(other, *found),
                                 shown(option, *value), why));
  }
}

}  // namespace broadside::cli
