// The one list of experiments.
#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "broadside/error.hpp"

#include "paper/experiments/descriptions.hpp"
#include "src/core/suggestion.hpp"

namespace broadside::lab {

std::string_view name(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::confirmed:
      return "confirmed";
    case Verdict::within_bounds:
      return "holds within bounds";
    case Verdict::refuted:
      return "refuted";
    case Verdict::not_testable:
      return "not testable";
  }
  return "";
}

std::string Statement::verdict_text() const {
  return std::string(lab::name(verdict)) + (condition.empty() ? "" : ": " + condition);
}

const Statement& Finding::statement(std::string_view wanted) const {
  const auto found = std::ranges::find(statements, wanted, &Statement::name);
  if (found == statements.end())
    throw std::invalid_argument(fmt::format("no statement '{}' in the claim", wanted));
  return *found;
}

std::string Experiment::label() const { return fmt::format("{}{}", is_own() ? "B" : "", number); }

std::string Experiment::label_of(const Finding& finding, std::size_t statement) const {
  return label() + (finding.statements.size() > 1 ? std::string(1, static_cast<char>('a' + statement)) : "");
}

std::span<const Experiment> experiments() {
  static const std::vector<Experiment> list = {
      brute_force_tests(), overtaking(),        grid_memory(),     grid_spanning(),
      grid_cell_size(),    sweep_axis(),        quadtree_sizes(),  quadtree_capacity(),
      update_fraction(),   grid_translation(),  grid_rebuilding(), sweep_insertion(),
      sweep_reinsertion(), quadtree_siblings(), winners(),         ablation(),
  };
  return list;
}

const Experiment& find_experiment(std::string_view text) {
  std::vector<std::string> known;
  std::vector<std::string> names;
  for (const Experiment& experiment : experiments()) {
    if (experiment.name == text || experiment.label() == text) return experiment;
    known.push_back(fmt::format("{} {}", experiment.label(), experiment.name));
    names.push_back(experiment.name);
  }
  throw InvalidSpec(fmt::format("no experiment '{}'{}; expected a name or number of: {}", text,
                                core::did_you_mean(text, names), fmt::join(known, ", ")));
}

}  // namespace broadside::lab
