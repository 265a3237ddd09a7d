// The one list of experiments.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "broadside/error.hpp"

#include "paper/experiments/descriptions.hpp"

namespace broadside::lab {

std::string_view name(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::holds:
      return "holds";
    case Verdict::holds_when:
      return "holds when";
    case Verdict::does_not_hold:
      return "does not hold";
  }
  return "";
}

std::string Finding::verdict_text() const {
  return std::string(name(verdict)) + (verdict == Verdict::holds_when ? " " + condition : "");
}

std::span<const Experiment> experiments() {
  static const std::vector<Experiment> list = {
      brute_force_tests(), overtaking(),      grid_memory(),       grid_spanning(),     grid_cell_size(),
      sweep_axis(),        quadtree_sizes(),  quadtree_capacity(), update_fraction(),   grid_translation(),
      grid_rebuilding(),   sweep_insertion(), sweep_reinsertion(), quadtree_siblings(), winners(),
  };
  return list;
}

const Experiment& find_experiment(std::string_view text) {
  std::vector<std::string> known;
  std::vector<std::string> names;
  for (const Experiment& experiment : experiments()) {
    if (experiment.name == text || std::to_string(experiment.number) == text) return experiment;
    known.push_back(fmt::format("{} {}", experiment.number, experiment.name));
    names.push_back(experiment.name);
  }
  throw InvalidSpec(fmt::format("no experiment '{}'{}; expected a name or number of: {}", text,
                                did_you_mean(text, names), fmt::join(known, ", ")));
}

}  // namespace broadside::lab
