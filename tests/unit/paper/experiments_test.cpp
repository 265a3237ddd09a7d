// The list of experiments, and their judges on what a machine has measured.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/error.hpp"

#include "paper/experiments/results.hpp"
#include "tests/support/message.hpp"
#include "tests/support/text_of.hpp"

namespace broadside::lab {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::UnorderedElementsAreArray;

const fs::path folder = fs::path(BROADSIDE_SOURCE_DIR) / "paper" / "experiments";
const fs::path committed = fs::path(BROADSIDE_SOURCE_DIR) / "paper" / "results" / "experiments.json";

/// Lower case, digits and underscores.
bool is_name(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
    return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '_';
  });
}

TEST(Experiments, AreThoseWhoseFilesEndInADescription) {
  const std::regex description(R"(\nExperiment ([a-z_0-9]+)\(\) \{\n)");
  std::vector<std::string> described;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = broadside::text_of(entry.path());
    for (std::sregex_iterator match(text.begin(), text.end(), description), end; match != end; ++match) {
      described.push_back((*match)[1]);
      EXPECT_EQ(entry.path().stem().string(), described.back());
    }
  }
  std::vector<std::string> listed;
  for (const Experiment& experiment : experiments()) listed.push_back(experiment.name);
  EXPECT_THAT(listed, UnorderedElementsAreArray(described));
}

TEST(Experiments, AreDescribedFullyAndOnceAndNumberedWithoutGapsOurOwnClaimsApart) {
  int last = 0;
  bool was_own = false;
  std::set<std::string> names;
  std::set<std::string> titles;
  for (const Experiment& experiment : experiments()) {
    SCOPED_TRACE(experiment.name);
    if (experiment.is_own() && !was_own) last = 0;
    EXPECT_GE(experiment.is_own(), was_own) << "the draft's claims come first";
    was_own = experiment.is_own();
    EXPECT_EQ(experiment.number, ++last);
    EXPECT_TRUE(is_name(experiment.name));
    EXPECT_TRUE(names.insert(experiment.name).second);
    EXPECT_TRUE(titles.insert(experiment.title).second);
    EXPECT_FALSE(experiment.title.empty());
    EXPECT_FALSE(experiment.title.ends_with('.'));
    EXPECT_GT(experiment.claim.size(), 20u);
    EXPECT_TRUE(experiment.claim.ends_with('.')) << experiment.claim;
    EXPECT_GT(experiment.measured.size(), 20u);
    EXPECT_TRUE(experiment.measured.ends_with('.')) << experiment.measured;
    EXPECT_THAT(experiment.section, testing::MatchesRegex("II|III|IV|V|VI|VI-[ABCD]|beyond"));
    EXPECT_TRUE(experiment.measure && experiment.judge);
  }
}

TEST(Experiments, AreFoundByNameAndByLabel) {
  for (const Experiment& experiment : experiments()) {
    EXPECT_EQ(&find_experiment(experiment.name), &experiment);
    EXPECT_EQ(&find_experiment(experiment.label()), &experiment);
  }
  EXPECT_EQ(find_experiment("B1").name, "winners");
  for (const char* const text :
       {"", "0", "01", "-1", "1.0", "15", "b1", "brute", "brute_force_tests ", "WINNERS"})
    EXPECT_THAT(message_of<InvalidSpec>([&] { find_experiment(text); }),
                AllOf(HasSubstr(std::string("'") + text + "'"), HasSubstr("1 brute_force_tests"),
                      HasSubstr("B1 winners")));
}

TEST(Experiments, LabelTheStatementsOfAClaimThatHasSeveral) {
  const Experiment& experiment = find_experiment("14");
  Finding finding{.statements = std::vector<Statement>(1), .reason = {}};
  EXPECT_EQ(experiment.label_of(finding, 0), "14");
  finding.statements.resize(2);
  EXPECT_EQ(experiment.label_of(finding, 1), "14b");
}

TEST(Experiments, RefuseNoTablesAndEmptyOnes) {
  for (const Experiment& experiment : experiments()) {
    EXPECT_THROW(experiment.judge({}), std::invalid_argument) << experiment.name;
    EXPECT_THROW(experiment.judge({Table{}}), std::invalid_argument) << experiment.name;
  }
}

/// The results in the repository, which a named machine has measured.
class CommittedResults : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(fs::exists(committed)) << committed;
    results_ = read_experiments(broadside::text_of(committed), committed.string());
  }

  ExperimentResults results_;
};

TEST_F(CommittedResults, AreOfEveryExperimentAndOfAWholeRun) {
  EXPECT_FALSE(results_.stopped);
  EXPECT_FALSE(results_.quick);
  ASSERT_EQ(results_.results.size(), experiments().size());
  for (std::size_t i = 0; i < experiments().size(); ++i)
    EXPECT_EQ(results_.results[i].experiment, &experiments()[i]);
}

TEST_F(CommittedResults, GiveFindingsWithAReasonAndFigures) {
  for (const ExperimentResult& result : results_.results) {
    SCOPED_TRACE(result.experiment->name);
    EXPECT_THAT(result.finding.reason, testing::ContainsRegex("[0-9]"));
    EXPECT_TRUE(result.finding.reason.ends_with('.')) << result.finding.reason;
    for (const Statement& statement : result.finding.statements) {
      EXPECT_TRUE(is_name(statement.name)) << statement.name;
      EXPECT_FALSE(statement.text.empty() || statement.text.ends_with('.')) << statement.text;
      EXPECT_FALSE(statement.evidence.empty()) << statement.name;
    }
    EXPECT_FALSE(result.finding.figures.empty());
    for (const Figure& figure : result.finding.figures) EXPECT_TRUE(is_name(figure.name)) << figure.name;
    EXPECT_EQ(judged(*result.experiment, result.tables), result.finding) << "another finding the second time";
  }
}

TEST_F(CommittedResults, HaveChartsWithRowsToShow) {
  for (const ExperimentResult& result : results_.results) {
    for (const Table& table : result.tables) {
      for (const Chart& chart : table.charts) {
        Table shown = table;
        for (const auto& [column, text] : chart.where) shown = shown.where(column, text);
        EXPECT_GE(shown.rows.size(), 2u) << result.experiment->name << ": " << chart.title;
        EXPECT_EQ(chart.kind == ChartKind::map, !chart.value.empty()) << chart.title;
      }
    }
  }
}

/// Whether the experiment finds something or refuses the tables, as it must; anything else goes through.
bool is_judged_or_refused(const Experiment& experiment, const std::vector<Table>& tables) {
  try {
    const Finding finding = judged(experiment, tables);
    return !finding.reason.empty();
  } catch (const std::invalid_argument&) {
    return true;
  }
}

TEST_F(CommittedResults, AreJudgedOrRefusedWithoutAnyOneColumn) {
  for (const ExperimentResult& result : results_.results) {
    for (std::size_t which = 0; which < result.tables.size(); ++which) {
      for (std::size_t column = 0; column < result.tables[which].columns.size(); ++column) {
        std::vector<Table> tables = result.tables;
        tables[which].columns[column].name += "?";
        EXPECT_TRUE(is_judged_or_refused(*result.experiment, tables))
            << result.experiment->name << ": " << tables[which].columns[column].name;
      }
    }
  }
}

/// The tables with one column of one of them replaced, cell by cell.
std::vector<Table> with_column(std::vector<Table> tables, std::size_t which, std::size_t column,
                               const std::function<Cell(const Cell&)>& changed) {
  for (std::vector<Cell>& row : tables[which].rows) row[column] = changed(row[column]);
  return tables;
}

TEST_F(CommittedResults, AreJudgedOrRefusedHoweverTheyAreDamaged) {
  const std::vector<std::function<Cell(const Cell&)>> damages = {
      [](const Cell&) { return Cell(); },
      [](const Cell&) { return Cell(0.0); },
      [](const Cell&) { return Cell(-1.0); },
      [](const Cell&) { return Cell("else"); },
      [](const Cell& cell) { return std::holds_alternative<double>(cell) ? Cell(1e300) : cell; },
  };
  for (const ExperimentResult& result : results_.results) {
    for (std::size_t which = 0; which < result.tables.size(); ++which) {
      const Table& table = result.tables[which];
      SCOPED_TRACE(result.experiment->name + ", " + table.name);
      for (const std::size_t rows : {0, 1, 2}) {
        std::vector<Table> tables = result.tables;
        tables[which].rows.resize(std::min(rows, table.rows.size()));
        EXPECT_TRUE(is_judged_or_refused(*result.experiment, tables)) << rows << " rows";
      }
      for (std::size_t column = 0; column < table.columns.size(); ++column) {
        for (const auto& damage : damages) {
          EXPECT_TRUE(
              is_judged_or_refused(*result.experiment, with_column(result.tables, which, column, damage)))
              << table.columns[column].name;
        }
      }
    }
  }
}

}  // namespace
}  // namespace broadside::lab
