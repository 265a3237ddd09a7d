// An experiment: a claim of the paper, what is measured to test it, and the verdict that the figures give.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "lab/measure/measurement.hpp"
#include "paper/experiments/laboratory.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {

/// What became of a statement.
enum class Verdict {
  confirmed,      ///< true wherever it was tested
  within_bounds,  ///< true in some of the tests, which its condition bounds
  refuted,        ///< false where it was tested
  not_testable    ///< no measurement could refute it: a tautology, a choice, a definition
};

/// "confirmed", "holds within bounds", "refuted" or "not testable".
std::string_view name(Verdict verdict) noexcept;

/// A number that an experiment came to: what its verdict rests on, and what a text about it may quote.
struct Figure {
  std::string name;  ///< lower case, digits and underscores; unique in the experiment
  double value = 0;  ///< finite
  std::string unit{};
  std::optional<Interval> interval{};  ///< 95 %, of what rests on times; empty for counts

  friend bool operator==(const Figure& a, const Figure& b) {
    const auto bounds = [](const Figure& figure) {
      const Interval known = figure.interval.value_or(Interval{});
      return std::tuple(figure.interval.has_value(), known.low, known.high);
    };
    return std::tie(a.name, a.value, a.unit) == std::tie(b.name, b.value, b.unit) && bounds(a) == bounds(b);
  }
};

/// One statement of a claim, and what the tables say of it. A claim that says several things has several.
struct Statement {
  std::string name;  ///< as a figure's; unique in the experiment
  std::string text;  ///< what the claim says here, in short
  Verdict verdict = Verdict::refuted;
  std::string condition{};              ///< of within_bounds: where it is true; of not_testable: why
  std::string threshold{};              ///< what was asked of the figures; empty: of not_testable
  std::vector<std::string> evidence{};  ///< the names of the figures that decided

  friend bool operator==(const Statement&, const Statement&) = default;

  /// The verdict and its condition.
  std::string verdict_text() const;
};

/// What an experiment's tables say of its claim.
struct Finding {
  std::vector<Statement> statements{};
  std::string reason;  ///< a sentence or two with the numbers that decided
  std::vector<Figure> figures{};

  friend bool operator==(const Finding&, const Finding&) = default;

  /// The one of that name. Throws std::invalid_argument if there is none.
  const Statement& statement(std::string_view name) const;
};

/// An experiment, described. A file in paper/experiments/ ends in one.
struct Experiment {
  int number = 0;        ///< from 1, in the order of the paper; our own claims are counted apart
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

  /// Whether the claim is our own and not the draft's.
  bool is_own() const { return section == "beyond"; }

  /// What the claim is called: "14", or "B1" if it is our own.
  std::string label() const;

  /// What one of the claim's statements is called: "14b", or as the claim if it is the only one.
  std::string label_of(const Finding& finding, std::size_t statement) const;
};

/// The experiments there are: the draft's claims by number, then our own. Thread-safe.
std::span<const Experiment> experiments();

/// The experiment that `text` names, by its name or its label. Throws InvalidSpec naming those there are.
const Experiment& find_experiment(std::string_view text);

}  // namespace broadside::lab
