// Output of the worst-case hunt, printed and written.
#include "bench/worst/report.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/numbers.hpp"
#include "lab/report/aligned_columns.hpp"

namespace broadside::bench {
namespace {

using Json = nlohmann::json;

/// A finding and its input's result.
struct Line {
  const InputResult* result;
  const Finding* finding;
};

std::vector<Line> lines_of(std::span<const InputResult> results, const std::string& algorithm) {
  std::vector<Line> lines;
  for (const InputResult& result : results) {
    for (const Finding& finding : result.findings) {
      if (finding.algorithm == algorithm) lines.push_back({&result, &finding});
    }
  }
  return lines;
}

std::string_view name(MeasuredRun::End end) {
  constexpr std::array<std::string_view, 5> names = {"finished", "too slow", "out of memory",
                                                     "too many pairs", "failed"};
  return names[static_cast<std::size_t>(end)];
}

std::string_view name(InputResult::State state) {
  constexpr std::array<std::string_view, 4> names = {"measured", "too many pairs", "unverified", "differing"};
  return names[static_cast<std::size_t>(state)];
}

template <typename Key>
std::string worst(std::vector<Line> lines, std::size_t max_lines, const Key& key) {
  std::ranges::stable_sort(lines, std::ranges::greater(), key);
  lines.resize(std::min(lines.size(), max_lines));
  lab::AlignedColumns columns(">>>>>>><<");
  columns.add({"over uniform", "over best", "ms", "tests/box", "over uniform", "bytes/box", "pairs/box",
               "best", "input"});
  for (const Line& line : lines) {
    const MeasuredRun& run = line.finding->run;
    const bool finished = run.finished();
    columns.add(
        {(finished ? "" : ">") + lab::ratio_text(line.finding->over_uniform),
         finished ? lab::ratio_text(line.finding->over_best) : "-",
         finished ? lab::rounded(run.milliseconds) : std::string(name(run.end)),
         finished && run.tests >= 0 ? lab::rounded(run.tests) : "-",
         line.finding->tests_over_uniform > 0 ? lab::ratio_text(line.finding->tests_over_uniform) : "-",
         finished ? lab::whole(run.peak_bytes) : "-", lab::rounded(line.result->pairs), line.result->best,
         line.result->input.text()});
  }
  return columns.text("  ");
}

}  // namespace

std::string table(std::span<const InputResult> results, const Hunt& hunt, std::size_t max_lines) {
  std::string text;
  for (const lab::Entry& entry : hunt.algorithms) {
    const std::string algorithm = entry.spec.text();
    const std::vector<Line> lines = lines_of(results, algorithm);
    if (lines.empty()) continue;
    text += algorithm + ", its worst over uniform boxes\n";
    text += worst(lines, max_lines, [](const Line& line) { return line.finding->over_uniform; });
    if (entry.spec.name == "auto") {
      text += algorithm + ", its worst over the best of all\n";
      text += worst(lines, max_lines, [](const Line& line) { return line.finding->over_best; });
      text += algorithm + ", where it takes most memory\n";
      text += worst(lines, 3, [](const Line& line) { return line.finding->run.peak_bytes; });
    }
    text += "\n";
  }
  return text;
}

std::string above_text(const InputResult& result, const Bounds& bounds) {
  std::string text;
  for (const Finding& finding : result.findings) {
    if (!is_above(finding, result, bounds)) continue;
    const MeasuredRun& run = finding.run;
    text += fmt::format("{}: {}{} times uniform, {} times {}, {} ms, {} bytes a box: {}\n", finding.algorithm,
                        run.finished() ? "" : "above ", lab::ratio_text(finding.over_uniform),
                        run.finished() ? lab::ratio_text(finding.over_best) : "?", result.best,
                        run.finished() ? lab::rounded(run.milliseconds) : std::string(name(run.end)),
                        lab::whole(run.peak_bytes), result.input.text());
  }
  return text;
}

std::string summary(std::span<const InputResult> results, const Hunt& hunt) {
  const auto in_state = [&](InputResult::State state) {
    return std::ranges::count(results, state, &InputResult::state);
  };
  std::string text =
      fmt::format("{} of {} boxes, {} above the limit of pairs, {} unverified, {} with different pairs\n",
                  lab::counted(results.size(), "input", "inputs"), lab::grouped(hunt.effort.boxes),
                  in_state(InputResult::State::too_many_pairs), in_state(InputResult::State::unverified),
                  in_state(InputResult::State::differing));
  for (const InputResult& result : results) {
    if (!result.fault.empty()) text += fmt::format("  {}\n    {}\n", result.fault, result.input.text());
    if (result.state == InputResult::State::unverified)
      text += fmt::format("  unverified: {}\n", result.input.text());
  }
  for (const lab::Entry& entry : hunt.algorithms) {
    std::size_t above = 0;
    std::size_t unfinished = 0;
    for (const Line& line : lines_of(results, entry.spec.text())) {
      above += is_above(*line.finding, *line.result, hunt.bounds) ? 1 : 0;
      unfinished += line.finding->run.finished() ? 0 : 1;
    }
    text += fmt::format(
        "  {:<20} {} above {}, {} not finished\n", entry.spec.text(), lab::counted(above, "input", "inputs"),
        entry.spec.name == "auto" ? fmt::format("{} times uniform, {} times the best or {} bytes a box",
                                                hunt.bounds.auto_over_uniform, hunt.bounds.auto_over_best,
                                                hunt.bounds.auto_bytes_per_box)
                                  : fmt::format("{} times uniform", hunt.bounds.over_uniform),
        unfinished);
  }
  return text;
}

Json to_json(std::span<const InputResult> results, const Hunt& hunt) {
  Json list = Json::array();
  for (const InputResult& result : results) {
    Json findings = Json::array();
    for (const Finding& finding : result.findings) {
      const MeasuredRun& run = finding.run;
      findings.push_back({{"algorithm", finding.algorithm},
                          {"end", name(run.end)},
                          {"ms", run.milliseconds},
                          {"worst_ms", run.worst_milliseconds},
                          {"over_uniform", finding.over_uniform},
                          {"over_best", finding.over_best},
                          {"tests_per_box", run.tests},
                          {"tests_over_uniform", finding.tests_over_uniform},
                          {"bytes_per_box", run.peak_bytes},
                          {"above_bounds", is_above(finding, result, hunt.bounds)}});
    }
    list.push_back({{"input", result.input.text()},
                    {"state", name(result.state)},
                    {"fault", result.fault},
                    {"pairs_per_box", result.pairs},
                    {"events_per_box", result.events},
                    {"best", result.best},
                    {"algorithms", std::move(findings)}});
  }
  return {{"boxes", hunt.effort.boxes}, {"limit_seconds", hunt.limit_seconds}, {"inputs", std::move(list)}};
}

std::size_t above_bounds(std::span<const InputResult> results, const Bounds& bounds) {
  std::size_t above = 0;
  for (const InputResult& result : results) {
    above += std::ranges::any_of(result.findings,
                                 [&](const Finding& finding) {
                                   return finding.algorithm == "auto" && is_above(finding, result, bounds);
                                 })
                 ? 1
                 : 0;
  }
  return above;
}

bool has_fault(std::span<const InputResult> results) {
  return std::ranges::any_of(results, [](const InputResult& result) { return !result.fault.empty(); });
}

}  // namespace broadside::bench
