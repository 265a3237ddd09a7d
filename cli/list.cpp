// broadside list: the algorithms and the scenes there are, and what can be set.
#include <limits>
#include <span>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/verbs.hpp"
#include "lab/catalogue.hpp"
#include "lab/report/columns.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::cli {
namespace {

std::string values_of(const Tunable& tunable) {
  switch (tunable.type) {
    case Tunable::Type::choice:
      return fmt::format("{}", fmt::join(tunable.choices, " | "));
    case Tunable::Type::number:
    case Tunable::Type::integer:
      break;
  }
  const bool whole = tunable.type == Tunable::Type::integer;
  if (tunable.most == std::numeric_limits<double>::max())
    return fmt::format("{} from {:g}", whole ? "whole number" : "number", tunable.least);
  return fmt::format("{} from {:g} to {:g}", whole ? "whole number" : "number", tunable.least, tunable.most);
}

std::string dimensions_of(const auto& described) {
  const bool two = described.has_dimension(2);
  const bool three = described.has_dimension(3);
  return two && three ? "2D 3D" : two ? "2D" : three ? "   3D" : "";
}

void add_tunables(lab::Columns& columns, std::span<const Tunable> tunables) {
  for (const Tunable& tunable : tunables) {
    columns.add({"  :" + tunable.name + "=", "", "",
                 fmt::format("{} ({}; standard {})", tunable.summary, values_of(tunable), tunable.standard)});
  }
}

Exit run() {
  const lab::Catalogue catalogue;
  lab::Columns algorithms("<<<<");
  for (const Algorithm& algorithm : catalogue.algorithms()) {
    algorithms.add(
        {algorithm.name, std::string(name(algorithm.kind)), dimensions_of(algorithm), algorithm.summary});
    add_tunables(algorithms, algorithm.tunables);
  }
  lab::Columns scenes("<<<<");
  for (const lab::Scene& scene : lab::scenes()) {
    scenes.add({scene.name, std::string(name(scene.kind)), dimensions_of(scene), scene.summary});
    add_tunables(scenes, scene.tunables);
  }
  fmt::print("Algorithms\n{}\nScenes\n{}", algorithms.text("  "), scenes.text("  "));
  return Exit::fine;
}

}  // namespace

Verb add_list(CLI::App& program) {
  program.add_subcommand("list", "Lists the algorithms and the scenes, and what can be set in their specs.");
  return run;
}

}  // namespace broadside::cli
