// What an experiment finds in tables made by hand.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "paper/experiments/results.hpp"

namespace broadside::lab {

inline Finding judged(const char* experiment, const std::vector<Table>& tables) {
  return judged(find_experiment(experiment), tables);
}

/// The verdict on one of the claim's statements, with its condition.
inline std::string verdict(const Finding& finding, const std::string& statement) {
  return finding.statement(statement).verdict_text();
}

/// The cells of a ratio whose interval is a hundredth on both sides.
inline std::vector<Cell> ratio(double median) { return {median, 0.99 * median, 1.01 * median}; }

inline double figure(const Finding& finding, const std::string& name) {
  const auto it = std::ranges::find(finding.figures, name, &Figure::name);
  if (it != finding.figures.end()) return it->value;
  ADD_FAILURE() << "no figure " << name;
  return 0;
}

}  // namespace broadside::lab
