// An experiment: a claim of the paper, what is measured to test it, and the verdict that the figures give.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "paper/experiments/laboratory.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {

/// What became of a claim.
enum class Verdict { holds, holds_when, does_not_hold };

/// "holds", "holds when" or "does not hold".
std::string_view name(Verdict verdict) noexcept;

/// A number that an experiment came to: what its verdict rests on, and what a text about it may quote.
struct Figure {
  std::string name;  ///< lower case, digits and underscores; unique in the experiment
  double value = 0;  ///< finite
  std::string unit{};

  friend bool operator==(const Figure&, const Figure&) = default;
};

/// What an experiment's tables say of its claim.
struct Finding {
  Verdict verdict = Verdict::does_not_hold;
  std::string condition{};  ///< of holds_when: what goes on after these words ("less than a third moves")
  std::string reason;       ///< a sentence or two with the numbers that decided
  std::vector<Figure> figures{};

  friend bool operator==(const Finding&, const Finding&) = default;

  /// The verdict and its condition.
  std::string verdict_text() const;
};

/// An experiment, described. A file in paper/experiments/ ends in one.
struct Experiment {
  int number = 0;        ///< from 1, in the order of the paper
  std::string name;      ///< lower case, digits and underscores
  std::string title;     ///< a few words
  std::string claim;     ///< the sentence under test: the paper's own, or a list of it in short
  std::string section;   ///< where it stands in the paper: "II", "VI-A"; "beyond" for what goes beyond it
  std::string measured;  ///< what is measured, on what, in a sentence or two

  /// Measures. Every time in the tables is of calls whose pairs were checked. Throws Stopped.
  std::function<std::vector<Table>(const Laboratory&)> measure;

  /// Judges by the tables alone: the same tables, the same finding; no clock, no machine. Throws
  /// std::invalid_argument if a table or column that it needs is missing or has too few rows.
  std::function<Finding(const std::vector<Table>&)> judge;
};

/// The experiments there are, by number. Thread-safe.
std::span<const Experiment> experiments();

/// The experiment that `text` names, by its name or its number. Throws InvalidSpec naming those there are.
const Experiment& find_experiment(std::string_view text);

}  // namespace broadside::lab
