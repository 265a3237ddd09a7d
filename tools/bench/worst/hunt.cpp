// The worst-case hunt: measures inputs with every algorithm, over uniform boxes and over the best algorithm.
#include "bench/worst/hunt.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace broadside::bench {
namespace {

constexpr double uniform_seconds = 120;

/// Keeps the shorter times of two runs with the same results.
void take_min(MeasuredRun& run, const MeasuredRun& again) {
  if (!again.finished()) return;
  if (!run.finished() || again.milliseconds < run.milliseconds) run = again;
}

bool is_auto(const std::string& algorithm) { return algorithm == "auto" || algorithm.starts_with("auto:"); }

}  // namespace

bool is_above(const Finding& finding, const InputResult& result, const Bounds& bounds) {
  if (!is_auto(finding.algorithm)) return finding.over_uniform > bounds.over_uniform;
  const bool searches = result.input.call != lab::HardCall::track;
  return finding.over_uniform > bounds.auto_over_uniform || finding.over_best > bounds.auto_over_best ||
         finding.run.end == MeasuredRun::End::too_slow ||
         finding.run.end == MeasuredRun::End::out_of_memory ||
         (searches && finding.run.peak_bytes > bounds.auto_bytes_per_box);
}

Hunter::Runs Hunter::run_all(const RunAlgorithm& run, bool is_uniform) const {
  Runs runs;
  double seconds = is_uniform ? uniform_seconds : hunt_.limit_seconds;
  for (const lab::Entry& entry : hunt_.algorithms) {
    runs.push_back(run(entry, seconds));
    if (runs.back().end == MeasuredRun::End::too_many_pairs) break;
    if (hunt_.judges_auto && !is_uniform && is_auto(entry.spec.text()) && runs.back().finished()) {
      const auto calls = static_cast<double>(hunt_.effort.rounds + 1);
      const double frames = runs.back().worst_milliseconds > runs.back().milliseconds
                                ? static_cast<double>(hunt_.effort.frames) + 10
                                : 1;
      // Anything slower than `auto` is not the best. The limit leaves time to start a process and for a
      // tracker's first frame.
      seconds = std::min(seconds, 0.3 + 2 * calls * frames * runs.back().milliseconds / 1e3);
    }
  }
  return runs;
}

const Hunter::Runs& Hunter::uniform(const lab::HardInput& input, bool again) {
  const lab::HardInput even = lab::uniform_for(input);
  const auto [found, is_new] = uniform_.try_emplace(even.text());
  Runs& runs = found->second;
  if (!is_new && !again) return runs;
  const RunAlgorithm run = prepare(even, hunt_.effort);
  for (int round = 0; round < (is_new ? 3 : 1); ++round) {
    const Runs more = run_all(run, true);
    for (std::size_t i = 0; i < more.size(); ++i) {
      if (!more[i].finished())
        throw std::runtime_error(fmt::format("{} on uniform boxes did not end: {}; expected a time",
                                             hunt_.algorithms[i].spec.text(), more[i].fault.data()));
    }
    if (runs.empty()) runs = more;
    for (std::size_t i = 0; i < more.size(); ++i) take_min(runs[i], more[i]);
  }
  return runs;
}

void Hunter::check(InputResult& result, const RunAlgorithm& run) const {
  const MeasuredRun* first = nullptr;
  const std::string* by = nullptr;
  std::size_t finished = 0;
  const auto differs = [&](const MeasuredRun& found, const std::string& name) {
    if (first == nullptr) {
      first = &found;
      by = &name;
    }
    ++finished;
    if (found.hash == first->hash && found.pairs == first->pairs) return;
    result.state = InputResult::State::differing;
    result.fault = fmt::format("{} found {} pairs, {} others: {}", name, found.pairs, *by, first->pairs);
  };
  for (const Finding& finding : result.findings) {
    if (finding.run.finished()) differs(finding.run, finding.algorithm);
    if (finding.run.end == MeasuredRun::End::failed)
      result.fault = fmt::format("{}: {}", finding.algorithm, finding.run.fault.data());
  }
  for (const lab::Entry& reference : hunt_.references) {
    if (finished != 1) break;
    const std::string name = reference.spec.text();
    if (name == *by) continue;
    const MeasuredRun again = run(reference, hunt_.reference_seconds);
    if (again.finished()) differs(again, name);
  }
  if (finished < 2 && result.state == InputResult::State::measured)
    result.state = InputResult::State::unverified;
}

InputResult Hunter::judged(const lab::HardInput& input, const Runs& runs, const Runs& uniform) const {
  InputResult result{.input = input};
  const auto boxes = static_cast<double>(hunt_.effort.boxes);
  double best = INFINITY;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    Finding finding{.algorithm = hunt_.algorithms[i].spec.text(), .run = runs[i]};
    finding.run.peak_bytes /= boxes;
    finding.run.tests /= boxes;
    if (runs[i].finished()) {
      result.pairs = static_cast<double>(runs[i].pairs) / boxes;
      result.events = static_cast<double>(runs[i].events) / boxes / static_cast<double>(hunt_.effort.frames);
      finding.over_uniform = runs[i].milliseconds / uniform[i].milliseconds;
      if (runs[i].tests >= 0 && uniform[i].tests > 0)
        finding.tests_over_uniform = runs[i].tests / uniform[i].tests;
      if (runs[i].milliseconds < best) {
        best = runs[i].milliseconds;
        result.best = finding.algorithm;
      }
    } else if (runs[i].end == MeasuredRun::End::too_slow && !(hunt_.judges_auto && i > 0)) {
      // A lower bound: at least one of the calls has not ended.
      const double calls =
          input.call == lab::HardCall::track ? static_cast<double>(hunt_.effort.frames + 1) : 1;
      finding.over_uniform = hunt_.limit_seconds * 1e3 / static_cast<double>(hunt_.effort.rounds + 1) /
                             calls / uniform[i].milliseconds;
    }
    result.findings.push_back(std::move(finding));
  }
  for (Finding& finding : result.findings)
    finding.over_best = finding.run.finished() ? finding.run.milliseconds / best : 0;
  return result;
}

InputResult Hunter::measure(const lab::HardInput& input) {
  const RunAlgorithm run = prepare(input, hunt_.effort);
  Runs runs = run_all(run, false);
  if (runs.back().end == MeasuredRun::End::too_many_pairs)
    return {.input = input, .state = InputResult::State::too_many_pairs};
  InputResult result = judged(input, runs, uniform(input, false));
  const auto above = [&](const Finding& finding) {
    return finding.run.finished() && is_above(finding, result, hunt_.bounds);
  };
  if (std::ranges::any_of(result.findings, above)) {
    const Runs again = run_all(run, false);
    for (std::size_t i = 0; i < std::min(runs.size(), again.size()); ++i) take_min(runs[i], again[i]);
    result = judged(input, runs, uniform(input, true));
  }
  check(result, run);
  return result;
}

}  // namespace broadside::bench
