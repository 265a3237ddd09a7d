// broadside list: the algorithms, scenes and file formats, and their settings.
#include <algorithm>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/help.hpp"
#include "cli/message.hpp"
#include "cli/verbs.hpp"
#include "lab/catalogue.hpp"
#include "lab/formats/format.hpp"
#include "lab/peers/peers.hpp"
#include "lab/report/fold.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::cli {
namespace {

std::string range_of(const Tunable& tunable) {
  const std::string min = fmt::format("from {:g}", tunable.min);
  // Bounds that only keep a value within a float are of no use to readers.
  constexpr double largest = std::numeric_limits<float>::max();
  constexpr double smallest = std::numeric_limits<float>::min();
  std::string range = tunable.min <= -largest ? "" : tunable.min == smallest ? "above 0" : min;
  if (tunable.max < largest) range += fmt::format(" to {:g}", tunable.max);
  return range;
}

std::string values_of(const Tunable& tunable) {
  if (tunable.type == Tunable::Type::choice) return fmt::format("{}", fmt::join(tunable.choices, ", "));
  const std::string kind = tunable.type == Tunable::Type::integer ? "whole number" : "number";
  const std::string range = range_of(tunable);
  return range.empty() ? kind : kind + " " + range;
}

/// Prints `begin` and then the text, wrapped for a terminal of usual width. Each line of the text is aligned
/// with its first.
void print_wrapped(const std::string& begin, std::string_view text) {
  const std::size_t width = std::min<std::size_t>(output_width(), 110);
  print(begin + lab::wrapped(text, width, begin.size(), begin.size()) + "\n");
}

/// An algorithm or scene: one line for itself and one for each of its tunables.
struct ListedItem {
  std::string name;
  std::string kind;
  std::string dimensions;
  std::string summary;
  std::span<const Tunable> tunables;
};

ListedItem listed(const auto& described) {
  const bool two = described.has_dimension(2);
  const bool three = described.has_dimension(3);
  return {described.name, std::string(name(described.kind)),
          two && three ? "2D 3D"
          : two        ? "2D"
          : three      ? "   3D"
                       : "",
          described.summary, described.tunables};
}

void print_list(std::string_view title, const std::vector<ListedItem>& list) {
  std::size_t name_width = 0;
  std::size_t kind_width = 0;
  for (const ListedItem& item : list) {
    name_width = std::max(name_width, item.name.size());
    kind_width = std::max(kind_width, item.kind.size());
  }
  print(fmt::format("{}\n", title));
  for (const ListedItem& item : list) {
    print_wrapped(fmt::format("  {:<{}}  {:<{}}  {:<5}  ", item.name, name_width, item.kind, kind_width,
                              item.dimensions),
                  item.summary);
    for (const Tunable& tunable : item.tunables) {
      print_wrapped(
          fmt::format("      :{}=  ", tunable.name),
          fmt::format("{} ({}; default {})", tunable.summary, values_of(tunable), tunable.default_value));
    }
  }
  print("\n");
}

Exit run(const lab::Catalogue& catalogue) {
  std::vector<ListedItem> algorithms;
  for (const Algorithm& algorithm : catalogue.algorithms()) algorithms.push_back(listed(algorithm));
  for (const lab::peers::MissingPeer& peer : lab::peers::missing_peers())
    algorithms.push_back(
        {peer.name, std::string(name(AlgorithmKind::peer)), "", "not there: " + peer.reason, {}});
  print_list("Algorithms (tunables follow the name, each after a colon: grid:cell=2.5:threads=2)",
             algorithms);

  std::vector<ListedItem> scenes;
  for (const lab::Scene& scene : lab::scenes()) scenes.push_back(listed(scene));
  for (const lab::Scene& scene : lab::missing_scenes())
    scenes.push_back({scene.name, std::string(name(scene.kind)), "", "not there: " + scene.missing, {}});
  print_list("Scenes", scenes);

  print("File formats\n");
  for (const lab::Format& format : lab::formats()) {
    const std::string_view access = !format.create ? "read" : !format.open ? "written" : "read, written";
    print_wrapped(
        fmt::format("  {:<10} {:<13}  ", format.name, access),
        fmt::format("{} ({})", format.missing.empty() ? format.summary : "not there: " + format.missing,
                    fmt::join(format.extensions, " ")));
    std::string_view suffix = "; default";
    for (const lab::ElementKind& part : format.parts) {
      print_wrapped(fmt::format("      --boxes {}  ", part.name), fmt::format("{}{}", part.summary, suffix));
      suffix = "";
    }
  }
  return Exit::success;
}

}  // namespace

Verb add_list(CLI::App& program, const lab::Catalogue& catalogue) {
  CLI::App* const verb = program.add_subcommand(
      "list", "Lists the algorithms, the scenes and what can be set in their specs, and the file formats.");
  add_examples(*verb, {{"list", "everything that has a name"}, {"list | less", "a page at a time"}});
  return [&catalogue] { return run(catalogue); };
}

}  // namespace broadside::cli
