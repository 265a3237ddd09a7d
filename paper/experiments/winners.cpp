// Beyond the paper: which algorithm wins where, what auto loses, and what SIMD, the BVH and threads add.
#include <algorithm>
#include <map>
#include <optional>
#include <random>
#include <stdexcept>

#include <fmt/format.h>

#include "lab/measure/paired_ratio.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/winners_measure.hpp"

namespace broadside::lab {
namespace {

/// What lies closer together than this is taken for equal.
constexpr double noise = 1.1;

std::vector<Table> measure(const Laboratory& laboratory) {
  return {measure_fields(laboratory), measure_instruction_sets(laboratory), measure_threads(laboratory)};
}

/// The times over the fastest of ours of one algorithm, auto or another, in the fields where it was measured.
struct Record {
  std::string name;
  std::vector<double> all{};
  std::vector<double> still{};
  std::vector<double> moving{};
  std::size_t wins = 0;  ///< among the single ones
  bool everywhere = true;
  std::string worst_field{};

  double mean() const { return geometric_mean(all); }
  double worst() const { return std::ranges::max(all); }
};

/// "density 2D, 1,000 boxes".
std::string name_of(const Table& fields, const std::vector<Cell>& row) {
  const auto* const map = std::get_if<std::string>(&row[fields.column("map")]);
  const auto* const boxes = std::get_if<double>(&row[fields.column("boxes")]);
  if (map == nullptr || boxes == nullptr)
    throw std::invalid_argument(
        fmt::format("table '{}': a row without map or boxes; expected both", fields.name));
  return fmt::format("{}, {} boxes", *map, rounded(*boxes));
}

/// The single algorithms that a table of fields has times of: its columns between auto's and the fastest's.
std::vector<std::string> single_algorithms_in(const Table& fields) {
  std::vector<std::string> names;
  for (std::size_t i = fields.column("auto") + 1; i < fields.column("fastest"); ++i)
    names.push_back(fields.columns[i].name);
  return names;
}

/// The records of auto and of each single algorithm, auto's first.
std::vector<Record> records_of(const Table& fields) {
  if (fields.rows.size() < 2)
    throw std::invalid_argument(
        fmt::format("table '{}' has {} rows; expected at least 2", fields.name, fields.rows.size()));
  std::vector<Record> records = {{.name = "auto"}};
  for (std::string& name : single_algorithms_in(fields)) records.push_back({.name = std::move(name)});
  const std::size_t moving = fields.column("moving");
  for (const std::vector<Cell>& row : fields.rows) {
    std::vector<std::optional<double>> times;
    std::optional<double> least;
    for (const Record& record : records) {
      const auto* const time = std::get_if<double>(&row[fields.column(record.name)]);
      times.push_back(time != nullptr && *time > 0 ? std::optional(*time) : std::nullopt);
      if (times.back()) least = std::min(least.value_or(*times.back()), *times.back());
    }
    const auto winner = std::ranges::min_element(times.begin() + 1, times.end(), {},
                                                 [](const auto& time) { return time.value_or(1e300); });
    for (std::size_t i = 0; i < records.size(); ++i) {
      records[i].everywhere = records[i].everywhere && times[i].has_value();
      if (!times[i]) continue;
      if (records[i].all.empty() || *times[i] / *least > records[i].worst())
        records[i].worst_field = name_of(fields, row);
      records[i].all.push_back(*times[i] / *least);
      const bool is_moving = std::holds_alternative<double>(row[moving]);
      (is_moving ? records[i].moving : records[i].still).push_back(*times[i] / *least);
      records[i].wins += times.begin() + static_cast<std::ptrdiff_t>(i) == winner ? 1 : 0;
    }
  }
  if (records[0].all.empty())
    throw std::invalid_argument(fmt::format("table '{}' has no time of auto; expected some", fields.name));
  return records;
}

/// In the fields that the BVH wins, the time of the best of the others over the BVH's.
std::vector<double> bvh_gains(const Table& fields) {
  const std::vector<std::string> names = single_algorithms_in(fields);
  std::vector<double> gains;
  for (const std::vector<Cell>& row : fields.rows) {
    const auto* const bvh = std::get_if<double>(&row[fields.column("bvh")]);
    std::optional<double> other;
    for (const std::string& name : names) {
      const auto* const time = std::get_if<double>(&row[fields.column(name)]);
      if (name != "bvh" && time != nullptr) other = std::min(other.value_or(*time), *time);
    }
    if (bvh != nullptr && other && *bvh < *other) gains.push_back(*other / *bvh);
  }
  return gains;
}

/// How many times as fast the peer's time is ours, in each field with a peer.
std::vector<double> peer_ratios(const Table& fields) {
  std::vector<double> ratios;
  for (const std::vector<Cell>& row : fields.rows) {
    const auto* const peer = std::get_if<double>(&row[fields.column("peer")]);
    const auto* const ours = std::get_if<double>(&row[fields.column("auto")]);
    if (peer != nullptr && ours != nullptr) ratios.push_back(*peer / *ours);
  }
  return ratios;
}

/// The time on the last instruction set over that on the first, by dimension and algorithm.
std::vector<double> simd_gains(const Table& table) {
  std::vector<double> gains;
  const std::vector<std::string> sets = table.distinct_texts("instruction set");
  if (sets.size() < 2) return gains;
  const Table best = table.where("instruction set", sets.front());
  const Table last = table.where("instruction set", sets.back());
  for (const std::string& dimension : table.distinct_texts("dimension")) {
    for (const std::string& name : table.distinct_texts("algorithm")) {
      const auto fast = best.where("dimension", dimension).where("algorithm", name).numbers("time");
      const auto slow = last.where("dimension", dimension).where("algorithm", name).numbers("time");
      if (fast.size() == 1 && slow.size() == 1) gains.push_back(slow[0] / fast[0]);
    }
  }
  return gains;
}

/// The time with one thread over that with the most, by dimension and algorithm.
std::vector<double> thread_gains(const Table& table, double most) {
  std::vector<double> gains;
  for (const std::string& dimension : table.distinct_texts("dimension")) {
    for (const std::string& name : table.distinct_texts("algorithm")) {
      const Table of = table.where("dimension", dimension).where("algorithm", name);
      const auto one = of.where("threads", 1.0).numbers("time");
      const auto many = of.where("threads", most).numbers("time");
      if (one.size() == 1 && many.size() == 1) gains.push_back(one[0] / many[0]);
    }
  }
  return gains;
}

/// The 95 % interval of the geometric mean of some ratios, by bootstrap: had there been other fields.
Interval interval_of_mean(const std::vector<double>& ratios) {
  std::mt19937_64 random(1);
  std::vector<double> means;
  std::vector<double> drawn(ratios.size());
  for (int i = 0; i < 1'000; ++i) {
    for (double& ratio : drawn) ratio = ratios[random() % ratios.size()];
    means.push_back(geometric_mean(drawn));
  }
  return middle_of(means);
}

/// Auto against the best single algorithm of those that were in all of some fields.
struct Choice {
  double automatic = 0;  ///< times over the fastest, the geometric mean
  double automatic_worst = 0;
  std::string single{};  ///< empty where there is none
  double single_mean = 0;
  double single_worst = 0;
  double over = 0;  ///< auto's over the single one's, field by field
  Interval over_interval{};

  bool is_better() const { return !single.empty() && over_interval.high < 1; }
};

Choice choice_of(const std::vector<Record>& records, std::vector<double> Record::*fields) {
  Choice choice;
  const std::vector<double>& of_auto = records[0].*fields;
  if (of_auto.empty()) return choice;
  choice.automatic = geometric_mean(of_auto);
  choice.automatic_worst = std::ranges::max(of_auto);
  for (const Record& record : std::span(records).subspan(1)) {
    const std::vector<double>& of_single = record.*fields;
    if (of_single.size() < of_auto.size()) continue;
    const double mean = geometric_mean(of_single);
    if (!choice.single.empty() && mean >= choice.single_mean) continue;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < of_auto.size(); ++i) ratios.push_back(of_auto[i] / of_single[i]);
    choice.single = record.name;
    choice.single_mean = mean;
    choice.single_worst = std::ranges::max(of_single);
    choice.over = geometric_mean(ratios);
    choice.over_interval = interval_of_mean(ratios);
  }
  return choice;
}

void add_choice(Finding& finding, const std::string& where, const Choice& choice, std::size_t fields) {
  if (choice.single.empty()) return;
  append(finding.figures, {{"fields_" + where, static_cast<double>(fields)},
                           {"auto_mean_" + where, choice.automatic},
                           {"auto_worst_" + where, choice.automatic_worst},
                           {"single_mean_" + where, choice.single_mean},
                           {"single_worst_" + where, choice.single_worst},
                           {"auto_over_single_" + where, choice.over, "", choice.over_interval}});
}

/// In how many fields the second of the single algorithms took less than 1.05 times the time of the first.
std::size_t near_ties(const Table& fields) {
  constexpr double close = 1.05;
  std::size_t ties = 0;
  for (const std::vector<Cell>& row : fields.rows) {
    std::vector<double> times;
    for (const std::string& name : single_algorithms_in(fields)) {
      if (const auto* const time = std::get_if<double>(&row[fields.column(name)])) times.push_back(*time);
    }
    std::ranges::sort(times);
    ties += times.size() > 1 && times[1] < close * times[0] ? 1 : 0;
  }
  return ties;
}

/// Adds the geometric mean, the least and the greatest of some ratios, if there are any.
void add_spread(Finding& finding, const std::string& name, const std::vector<double>& ratios) {
  if (ratios.empty()) return;
  finding.figures.push_back({name + "_mean", geometric_mean(ratios), "", interval_of_mean(ratios)});
  finding.figures.push_back({name + "_least", std::ranges::min(ratios)});
  finding.figures.push_back({name + "_most", std::ranges::max(ratios)});
}

void tell_parts(Finding& finding, const std::vector<Table>& tables) {
  const Table& fields = table_named(tables, "fields");
  const Table& sets = table_named(tables, "instruction_sets");
  const Table& threads = table_named(tables, "threads");

  const std::vector<double> bvh = bvh_gains(fields);
  add_spread(finding, "bvh_gain", bvh);
  if (!bvh.empty())
    finding.reason += fmt::format(" The BVH is up to {:.1f} times as fast as the best of the others.",
                                  std::ranges::max(bvh));
  const std::vector<double> simd = simd_gains(sets);
  add_spread(finding, "simd_gain", simd);
  if (!simd.empty()) {
    const std::vector<std::string> names = sets.distinct_texts("instruction set");
    finding.reason += fmt::format(" {} is {:.1f} to {:.1f} times as fast as {}.", names.front(),
                                  std::ranges::min(simd), std::ranges::max(simd), names.back());
  }
  const std::vector<double> counts = threads.distinct_numbers("threads");
  const double most = counts.empty() ? 1 : std::ranges::max(counts);
  const std::vector<double> gains = most > 1 ? thread_gains(threads, most) : std::vector<double>();
  finding.figures.push_back({"threads", most});
  add_spread(finding, "thread_gain", gains);
  if (!gains.empty())
    finding.reason += fmt::format(" {:.0f} threads are {:.2f} to {:.2f} times as fast as one.", most,
                                  std::ranges::min(gains), std::ranges::max(gains));
  const std::vector<double> peers = peer_ratios(fields);
  add_spread(finding, "peer_over_auto", peers);
  if (!peers.empty())
    finding.reason += fmt::format(" The fastest peer takes {:.1f} times as long as auto in the mean.",
                                  geometric_mean(peers));
}

Finding judge(const std::vector<Table>& tables) {
  const Table& fields = table_named(tables, "fields");
  const std::vector<Record> records = records_of(fields);
  const Record& automatic = records[0];

  const Record* safest =
      nullptr;  // of the single ones measured everywhere, the one that loses least in the mean
  bool any_everywhere_best = false;
  std::string wins;
  for (const Record& record : std::span(records).subspan(1)) {
    if (record.wins > 0)
      wins += fmt::format("{}{} in {}", wins.empty() ? "" : ", ", record.name, record.wins);
    if (!record.everywhere) continue;
    if (safest == nullptr || record.mean() < safest->mean()) safest = &record;
    any_everywhere_best = any_everywhere_best || record.worst() <= noise;
  }
  const Choice everywhere = choice_of(records, &Record::all);
  const Choice at_rest = choice_of(records, &Record::still);
  const Choice in_motion = choice_of(records, &Record::moving);

  Finding finding;
  Statement choice{
      .name = "choosing",
      .text = "looking at the boxes and choosing loses less than any single algorithm",
      .threshold =
          "auto's times over those of the best single algorithm, field by field: the "
          "interval of their mean is below 1, over all fields or over those at rest or in motion",
      .evidence = {"auto_mean", "auto_worst"}};
  if (everywhere.is_better()) {
    choice.verdict = Verdict::confirmed;
  } else if (at_rest.is_better() || in_motion.is_better()) {
    choice.verdict = Verdict::within_bounds;
    choice.condition = at_rest.is_better() ? "the boxes stand still" : "boxes move";
  }
  if (safest != nullptr) append(choice.evidence, {"single_mean", "single_worst"});
  finding.statements = {
      {.name = "no_best",
       .text = "no single algorithm is the fastest everywhere",
       .verdict = any_everywhere_best ? Verdict::refuted : Verdict::confirmed,
       .threshold = fmt::format("none stays within {} times the fastest in all fields", noise),
       .evidence = {}},
      choice};
  for (const Record& record : std::span(records).subspan(1)) {
    if (record.wins > 0) finding.statements[0].evidence.push_back("won_by_" + record.name);
  }
  finding.reason = fmt::format(
      "Of {} fields the fastest was {}. Auto took {:.2f} times the fastest of ours in the geometric mean and "
      "{:.2f} times at worst ({})",
      fields.rows.size(), wins, automatic.mean(), automatic.worst(), automatic.worst_field);
  std::vector<std::string> choice_evidence;
  finding.figures = {{"fields", static_cast<double>(fields.rows.size())},
                     {"most_boxes", std::ranges::max(fields.numbers("boxes")), "boxes"},
                     {"auto_mean", automatic.mean(), "", interval_of_mean(automatic.all)},
                     {"auto_worst", automatic.worst()}};
  if (safest != nullptr) {
    finding.reason += fmt::format("; the best single one, {}, took {:.2f} and {:.2f} times", safest->name,
                                  safest->mean(), safest->worst());
    finding.figures.push_back({"single_mean", safest->mean(), "", interval_of_mean(safest->all)});
    finding.figures.push_back({"single_worst", safest->worst()});
  }
  finding.reason += ".";
  if (!everywhere.single.empty()) {
    finding.figures.push_back({"auto_over_single", everywhere.over, "", everywhere.over_interval});
    choice_evidence.emplace_back("auto_over_single");
  }
  add_choice(finding, "still", at_rest, automatic.still.size());
  add_choice(finding, "moving", in_motion, automatic.moving.size());
  for (const auto& [where, compared] : {std::pair("still", at_rest), std::pair("moving", in_motion)}) {
    if (!compared.single.empty()) choice_evidence.push_back(fmt::format("auto_over_single_{}", where));
  }
  append(finding.statements[1].evidence, choice_evidence);
  finding.figures.push_back({"near_ties", static_cast<double>(near_ties(fields))});
  for (const Record& record : std::span(records).subspan(1))
    finding.figures.push_back({"won_by_" + record.name, static_cast<double>(record.wins)});
  tell_parts(finding, tables);
  return finding;
}

}  // namespace

Experiment winners() {
  return {.number = 1,
          .name = "winners",
          .title = "Which algorithm wins where",
          .claim =
              "No single algorithm is the fastest everywhere: how many boxes there are, how dense they "
              "stand, how their sizes differ and how many move decide. Looking at the boxes and choosing, as "
              "auto does, loses less than any single algorithm.",
          .section = "beyond",
          .measured =
              "Our algorithms and the peers in six maps: by the number of boxes and by overlaps a box, "
              "spread of sizes, clustering or the fraction that moves; and our algorithms by instruction set "
              "and by threads.",
          .measure = measure,
          .judge = judge};
}

}  // namespace broadside::lab
