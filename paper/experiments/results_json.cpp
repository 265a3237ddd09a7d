// Experiments as JSON, and back.
#include <algorithm>
#include <cmath>
#include <type_traits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lab/formats/format.hpp"
#include "lab/measure/steadiness.hpp"
#include "lab/report/machine.hpp"
#include "paper/experiments/results.hpp"

namespace broadside::lab {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view schema = "broadside.experiments/2";

/// Its tables are as today's, and findings are made anew from those.

Json json_of(const Cell& cell) {
  if (const auto* const number = std::get_if<double>(&cell)) return *number;
  if (const auto* const text = std::get_if<std::string>(&cell)) return *text;
  return nullptr;
}

Json json_of(const Chart& chart) {
  Json where = Json::array();
  for (const auto& [column, text] : chart.where) where.push_back({column, text});
  return {{"title", chart.title}, {"kind", name(chart.kind)}, {"x", chart.x},
          {"y", chart.y},         {"series", chart.series},   {"value", chart.value},
          {"log_x", chart.log_x}, {"log_y", chart.log_y},     {"where", std::move(where)}};
}

/// One row a line: short, and readable where two results are compared.
std::string text_of(const Table& table) {
  Json columns = Json::array();
  for (const Column& column : table.columns)
    columns.push_back({{"name", column.name}, {"unit", column.unit}});
  Json charts = Json::array();
  for (const Chart& chart : table.charts) charts.push_back(json_of(chart));
  std::string text =
      fmt::format("{{\"name\": {}, \"title\": {},\n\"columns\": {},\n\"charts\": {},\n\"rows\": [",
                  json_text(table.name), json_text(table.title), json_text(columns), json_text(charts));
  std::string_view separator = "\n";
  for (const std::vector<Cell>& cells : table.rows) {
    Json row = Json::array();
    for (const Cell& cell : cells) row.push_back(json_of(cell));
    text += fmt::format("{}{}", separator, json_text(row));
    separator = ",\n";
  }
  return text + "\n]}";
}

std::string json_text_of(const ExperimentResult& result) {
  const Experiment& experiment = *result.experiment;
  const Finding& finding = result.finding;
  Json figures = Json::object();
  for (const Figure& figure : finding.figures) {
    figures[figure.name] = {{"value", figure.value},
                            {"unit", figure.unit},
                            {"low", figure.interval ? Json(figure.interval->low) : Json()},
                            {"high", figure.interval ? Json(figure.interval->high) : Json()}};
  }
  Json statements = Json::array();
  for (std::size_t i = 0; i < finding.statements.size(); ++i) {
    const Statement& statement = finding.statements[i];
    statements.push_back({{"label", experiment.label_of(finding, i)},
                          {"name", statement.name},
                          {"text", statement.text},
                          {"verdict", name(statement.verdict)},
                          {"condition", statement.condition},
                          {"threshold", statement.threshold},
                          {"evidence", statement.evidence}});
  }
  Json head = {{"label", experiment.label()},   {"name", experiment.name},
               {"title", experiment.title},     {"claim", experiment.claim},
               {"section", experiment.section}, {"measured", experiment.measured},
               {"seconds", result.seconds},     {"statements", std::move(statements)},
               {"reason", finding.reason},      {"figures", std::move(figures)}};
  if (result.steadiness)
    head["steadiness"] = {{"measurements", result.steadiness->measurements},
                          {"unsteady", result.steadiness->unsteady}};
  std::string text = json_text(head);
  text.pop_back();  // its brace, behind the tables
  text += ",\n\"tables\": [";
  std::string_view separator = "\n";
  for (const Table& table : result.tables) {
    text += fmt::format("{}{}", separator, text_of(table));
    separator = ",\n";
  }
  return text + "\n]}";
}

/// Reads values out of an object, and says where one is not what it should be.
class Reader {
 public:
  Reader(const Json& json, std::string where) : json_(json), where_(std::move(where)) {
    if (!json_.is_object()) fail("", json_, "an object");
  }

  template <typename Value>
  Value get(const char* key, std::string_view expected) const {
    const Json& value = at(key, expected);
    // The library would take true for 1.
    if (std::is_same_v<Value, double> && !value.is_number()) fail(key, value, expected);
    try {
      return value.get<Value>();
    } catch (const Json::exception&) {
      fail(key, value, expected);
    }
  }

  const Json& list(const char* key) const {
    const Json& value = at(key, "a list");
    if (!value.is_array()) fail(key, value, "a list");
    return value;
  }

  const Json& object(const char* key) const {
    const Json& value = at(key, "an object");
    if (!value.is_object()) fail(key, value, "an object");
    return value;
  }

  const Json& at(const char* key, std::string_view expected) const {
    const auto found = json_.find(key);
    if (found == json_.end()) throw FileError(fmt::format("{}: no '{}'; expected {}", where_, key, expected));
    return *found;
  }

  [[noreturn]] void fail(std::string_view key, const Json& found, std::string_view expected) const {
    throw FileError(fmt::format("{}{}{}: {}; expected {}", where_, key.empty() ? "" : ", ", key,
                                found.dump().substr(0, 40), expected));
  }

 private:
  const Json& json_;
  std::string where_;
};

Chart read_chart(const Json& json, const std::string& where) {
  const Reader reader(json, where);
  Chart chart{.title = reader.get<std::string>("title", "a text"),
              .x = reader.get<std::string>("x", "a text"),
              .y = reader.get<std::string>("y", "a text"),
              .series = reader.get<std::string>("series", "a text"),
              .value = reader.get<std::string>("value", "a text"),
              .log_x = reader.get<bool>("log_x", "true or false"),
              .log_y = reader.get<bool>("log_y", "true or false"),
              .where = reader.get<decltype(Chart::where)>("where", "a list of column and text")};
  const auto kind = reader.get<std::string>("kind", "a text");
  for (const ChartKind known : {ChartKind::lines, ChartKind::bars, ChartKind::map}) {
    chart.kind = known;
    if (name(known) == kind) return chart;
  }
  reader.fail("kind", kind, "lines, bars or map");
}

/// Refuses a chart of columns that are not there.
void check_columns(const Chart& chart, const Table& table, const std::string& where) {
  std::vector<std::string> columns = {chart.x, chart.y};
  for (const std::string& column : {chart.series, chart.value}) {
    if (!column.empty()) columns.push_back(column);
  }
  for (const auto& [column, text] : chart.where) columns.push_back(column);
  try {
    for (const std::string& column : columns) table.column(column);
  } catch (const std::invalid_argument& missing) {
    throw FileError(fmt::format("{}, chart '{}': {}", where, chart.title, missing.what()));
  }
}

Cell read_cell(const Json& json, const std::string& where) {
  if (json.is_null()) return {};
  if (json.is_string()) return json.get<std::string>();
  if (json.is_number() && std::isfinite(json.get<double>())) return json.get<double>();
  throw FileError(
      fmt::format("{}: {}; expected a finite number, a text or null", where, json.dump().substr(0, 40)));
}

/// A column is of numbers or of texts: a judge by numbers would not see that one is missing.
void check_kinds(const Table& table, const std::string& where) {
  for (const Column& column : table.columns) {
    if (table.numbers(column.name).empty() || table.texts(column.name).empty()) continue;
    throw FileError(fmt::format("{}, column '{}': numbers and the text '{}'; expected either", where,
                                column.name, table.texts(column.name).front()));
  }
}

Table read_table(const Json& json, const std::string& where_all) {
  const Reader reader(json, where_all);
  Table table{.name = reader.get<std::string>("name", "a text"),
              .title = reader.get<std::string>("title", "a text"),
              .columns = {}};
  const std::string where = fmt::format("{}, table '{}'", where_all, table.name);
  for (const Json& json_column : reader.list("columns")) {
    const Reader fields(json_column, where + ", columns");
    Column column{fields.get<std::string>("name", "a text"), fields.get<std::string>("unit", "a text")};
    if (std::ranges::find(table.columns, column.name, &Column::name) != table.columns.end())
      throw FileError(fmt::format("{}: column '{}' twice; expected it once", where, column.name));
    table.columns.push_back(std::move(column));
  }
  for (const Json& chart : reader.list("charts")) {
    table.charts.push_back(read_chart(chart, where + ", charts"));
    check_columns(table.charts.back(), table, where);
  }
  for (const Json& row : reader.list("rows")) {
    const std::string where_row = fmt::format("{}, row {}", where, table.rows.size() + 1);
    if (!row.is_array() || row.size() != table.columns.size())
      throw FileError(fmt::format("{}: {} cells; expected {}, one a column", where_row,
                                  row.is_array() ? row.size() : 0, table.columns.size()));
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < row.size(); ++i)
      cells.push_back(read_cell(row[i], fmt::format("{}, column '{}'", where_row, table.columns[i].name)));
    table.add(std::move(cells));
  }
  check_kinds(table, where);
  return table;
}

ExperimentResult read_result(const Json& json, const std::string& name) {
  const Reader reader(json, name + ": experiments");
  const auto experiment_name = reader.get<std::string>("name", "the name of an experiment");
  const std::string where = fmt::format("{}: experiment '{}'", name, experiment_name);
  ExperimentResult result{};
  try {
    result.experiment = &find_experiment(experiment_name);
  } catch (const std::exception& unknown) {
    throw FileError(fmt::format("{}: {}", name, unknown.what()));
  }
  result.seconds = reader.get<double>("seconds", "a number");
  if (json.contains("steadiness")) {
    const Reader counts(json["steadiness"], where + ", steadiness");
    const auto count = [&](const char* key) {
      const auto number = counts.get<double>(key, "a whole number from 0");
      if (!(number >= 0 && number <= 1e15) || number != std::floor(number))
        counts.fail(key, number, "a whole number from 0");
      return static_cast<std::size_t>(number);
    };
    result.steadiness = Steadiness{count("measurements"), count("unsteady")};
  }
  for (const Json& json_table : reader.list("tables")) {
    Table table = read_table(json_table, where);
    for (const Table& earlier : result.tables) {
      if (earlier.name == table.name)
        throw FileError(fmt::format("{}: table '{}' twice; expected it once", where, table.name));
    }
    result.tables.push_back(std::move(table));
  }
  try {
    result.finding = judged(*result.experiment, result.tables);
  } catch (const std::invalid_argument& unfit) {
    throw FileError(fmt::format("{}: {}", where, unfit.what()));
  }
  return result;
}

Json parsed(std::string_view text, const std::string& name) {
  try {
    return Json::parse(text);
  } catch (const Json::exception& error) {
    throw FileError(
        fmt::format("{}: {}; expected JSON as broadside experiment --json writes it", name, error.what()));
  }
}

/// The machine or the build, whose fields may be null or missing but not of another kind.
template <typename Part>
Part read_part(const Reader& reader, const char* key, Part (*read)(const Json&)) {
  const Json& json = reader.object(key);
  try {
    return read(json);
  } catch (const Json::exception&) {
    reader.fail(key, json, std::string("the ") + key + " as this program writes it");
  }
}

}  // namespace

std::string json_of(const ExperimentResults& results) {
  std::string text = fmt::format(
      "{{\n\"schema\": {},\n\"machine\": {},\n\"build\": {},\n\"target\": {},\n\"date\": {},\n"
      "\"command\": {},\n\"quick\": {},\n\"stopped\": {},\n",
      json_text(schema), json_text(json_of(results.machine)), json_text(json_of(results.build)),
      json_text(results.target), json_text(results.date), json_text(results.command), results.quick,
      results.stopped);
  if (results.processor_share)
    text += fmt::format("\"processor_share\": {},\n\"busy\": {},\n", json_text(*results.processor_share),
                        !busy_hint(*results.processor_share).empty());
  text += "\"experiments\": [";
  std::string_view separator = "\n";
  for (const ExperimentResult& result : results.results) {
    text += fmt::format("{}{}", separator, json_text_of(result));
    separator = ",\n";
  }
  return text + "\n]\n}\n";
}

ExperimentResults read_experiments(std::string_view text, const std::string& name) {
  const Json json = parsed(text, name);
  const Reader reader(json, name);
  if (const auto found = reader.get<std::string>("schema", schema); found != schema)
    throw FileError(fmt::format("{}: schema '{}'; expected '{}'", name, found, schema));
  ExperimentResults results{
      .machine = read_part(reader, "machine", read_machine),
      .build = read_part(reader, "build", read_build),
      .target = reader.get<std::string>("target", "a text"),
      .date = reader.get<std::string>("date", "a text"),
      .command = reader.get<std::vector<std::string>>("command", "a list of texts"),
      .quick = reader.get<bool>("quick", "true or false"),
      .stopped = reader.get<bool>("stopped", "true or false"),
  };
  if (json.contains("processor_share"))
    results.processor_share = reader.get<double>("processor_share", "a number");
  for (const Json& experiment : reader.list("experiments")) {
    ExperimentResult result = read_result(experiment, name);
    for (const ExperimentResult& earlier : results.results) {
      if (earlier.experiment == result.experiment)
        throw FileError(
            fmt::format("{}: experiment '{}' twice; expected it once", name, result.experiment->name));
    }
    results.results.push_back(std::move(result));
  }
  if (results.results.empty())
    throw FileError(fmt::format("{}: 0 experiments; expected results of at least one", name));
  return results;
}

}  // namespace broadside::lab
