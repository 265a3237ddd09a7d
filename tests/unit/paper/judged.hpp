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

inline Verdict verdict(const char* experiment, const std::vector<Table>& tables) {
  return judged(experiment, tables).verdict;
}

inline double figure(const Finding& finding, const std::string& name) {
  const auto it = std::ranges::find(finding.figures, name, &Figure::name);
  if (it != finding.figures.end()) return it->value;
  ADD_FAILURE() << "no figure " << name;
  return 0;
}

}  // namespace broadside::lab
