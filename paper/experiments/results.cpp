// Does experiments, and tells a terminal of them.
#include "paper/experiments/results.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "broadside/executor.hpp"

#include "lab/numbers.hpp"
#include "lab/report/columns.hpp"

namespace broadside::lab {
namespace {

std::string cell_text(const Cell& cell) {
  if (const auto* const text = std::get_if<std::string>(&cell)) return *text;
  const auto* const number = std::get_if<double>(&cell);
  return number == nullptr ? "-" : rounded(*number);
}

std::string table_text(const Table& table) {
  std::string alignment;
  std::vector<std::string> head;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const Column& column = table.columns[i];
    bool any_text = false;
    for (const std::vector<Cell>& row : table.rows) any_text |= std::holds_alternative<std::string>(row[i]);
    alignment += any_text ? '<' : '>';
    head.push_back(column.unit.empty() ? column.name : fmt::format("{} ({})", column.name, column.unit));
  }
  Columns columns(alignment);
  columns.add(std::move(head));
  for (const std::vector<Cell>& row : table.rows) {
    std::vector<std::string> texts;
    for (const Cell& cell : row) texts.push_back(cell_text(cell));
    columns.add(std::move(texts));
  }
  return "\n" + table.title + "\n" + columns.text("  ");
}

std::string wrapped(std::string_view text) {
  constexpr std::size_t widest = 110;
  std::string lines;
  std::size_t column = 0;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    if (column > 0 && column + 1 + word.size() > widest) {
      lines += "\n";
      column = 0;
    }
    lines += fmt::format("{}{}", column > 0 ? " " : "", word);
    column += word.size() + (column > 0 ? 1 : 0);
  }
  return lines + "\n";
}

/// What the judge says; where it looks for a row that is not there, that is a matter of the tables too.
Finding judged_by(const Experiment& experiment, const std::vector<Table>& tables) {
  try {
    return experiment.judge(tables);
  } catch (const std::out_of_range&) {
    throw std::invalid_argument("a table has too few rows, or no texts or numbers where it should");
  }
}

void check_statements(const Finding& finding, const std::set<std::string>& figures) {
  if (finding.statements.empty()) throw std::invalid_argument("no statement; expected one at least");
  std::set<std::string> names;
  for (const Statement& statement : finding.statements) {
    if (!names.insert(statement.name).second)
      throw std::invalid_argument(fmt::format("statement '{}' twice; expected it once", statement.name));
    const bool has_condition =
        statement.verdict == Verdict::within_bounds || statement.verdict == Verdict::not_testable;
    if (statement.condition.empty() == has_condition)
      throw std::invalid_argument(fmt::format("statement '{}' is {} and its condition '{}'; expected {}",
                                              statement.name, name(statement.verdict), statement.condition,
                                              has_condition ? "one" : "none"));
    for (const std::string& figure : statement.evidence) {
      if (!figures.contains(figure))
        throw std::invalid_argument(fmt::format(
            "statement '{}' rests on the figure '{}'; expected one that there is", statement.name, figure));
    }
  }
}

}  // namespace

Finding judged(const Experiment& experiment, const std::vector<Table>& tables) {
  Finding finding = judged_by(experiment, tables);
  std::set<std::string> names;
  for (const Figure& figure : finding.figures) {
    const Interval interval = figure.interval.value_or(Interval{figure.value, figure.value});
    for (const double number : {figure.value, interval.low, interval.high}) {
      if (!std::isfinite(number))
        throw std::invalid_argument(
            fmt::format("figure '{}' comes to {}; expected a finite number", figure.name, number));
    }
    if (!names.insert(figure.name).second)
      throw std::invalid_argument(fmt::format("figure '{}' twice; expected it once", figure.name));
  }
  check_statements(finding, names);
  return finding;
}

ExperimentResults begin_results(std::span<const std::string> command, bool quick) {
  return {.machine = this_machine(),
          .build = this_build(),
          .target = instruction_set(),
          .date = today(),
          .command = {command.begin(), command.end()},
          .quick = quick};
}

void do_experiments(std::span<const Experiment* const> chosen, const Laboratory& laboratory,
                    ExperimentResults& results,
                    const std::function<void(const ExperimentResult&)>& finished) {
  try {
    for (const Experiment* const experiment : chosen) {
      laboratory.at(experiment->name);
      const Steadiness before = laboratory.steadiness();
      const Stopwatch watch;
      std::vector<Table> tables = experiment->measure(laboratory);
      const double seconds = watch.milliseconds() / 1e3;
      Steadiness steadiness = laboratory.steadiness();
      steadiness.measurements -= before.measurements;
      steadiness.unsteady -= before.unsteady;
      Finding finding = judged(*experiment, tables);
      results.results.push_back({experiment, std::move(tables), std::move(finding), seconds, steadiness});
      if (finished) finished(results.results.back());
    }
  } catch (const Stopped&) {
    results.stopped = true;
  }
}

std::string text_of(const ExperimentResult& result) {
  const Experiment& experiment = *result.experiment;
  std::string text = fmt::format("{}. {} ({}, {})\n", experiment.label(), experiment.title, experiment.name,
                                 experiment.is_own() ? "our own claim" : "section " + experiment.section);
  text += wrapped("Claim: " + experiment.claim) + wrapped("Measured: " + experiment.measured);
  for (const Table& table : result.tables) text += table_text(table);
  text += "\n";
  for (std::size_t i = 0; i < result.finding.statements.size(); ++i) {
    const Statement& statement = result.finding.statements[i];
    text += wrapped(fmt::format("Verdict {}, {}: {}.", experiment.label_of(result.finding, i), statement.text,
                                statement.verdict_text()));
  }
  return text + wrapped(result.finding.reason);
}

std::string summary_of(const ExperimentResults& results) {
  Columns columns("<<<>");
  double seconds = 0;
  Steadiness steadiness;
  for (const ExperimentResult& result : results.results) {
    for (std::size_t i = 0; i < result.finding.statements.size(); ++i) {
      const Statement& statement = result.finding.statements[i];
      columns.add({result.experiment->label_of(result.finding, i), result.experiment->name,
                   statement.verdict_text(), i == 0 ? duration(result.seconds) : ""});
    }
    seconds += result.seconds;
    steadiness.add(result.steadiness.value_or(Steadiness{}));
  }
  return columns.text("") +
         fmt::format("{} in {}{}\n", counted(results.results.size(), "experiment", "experiments"),
                     duration(seconds), results.stopped ? "; stopped before the end" : "") +
         hint_of(steadiness, results.quick ? "without --quick for more samples" : "");
}

}  // namespace broadside::lab
