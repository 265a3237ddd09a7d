// Measures a case in a child process. An algorithm that ends the process or never returns has failed, and the
// comparison goes on.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <new>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "lab/measure/cases.hpp"
#include "lab/numbers.hpp"
#include "lab/platform/child_process.hpp"

namespace broadside::lab {
namespace {

/// Serializes values for another process of the same program: writes them, or reads them back.
class ValueBytes {
 public:
  ValueBytes() = default;
  explicit ValueBytes(std::string_view bytes) : bytes_(bytes), reads_(true) {}

  const std::string& bytes() const { return bytes_; }

  template <typename... Value>
  void pass(Value&... values) {
    (pass_one(values), ...);
  }

 private:
  void copy(void* value, std::size_t size) {
    if (reads_)
      bytes_.copy(static_cast<char*>(value), size, at_);
    else
      bytes_.append(static_cast<const char*>(value), size);
    at_ += size;
  }

  template <typename Value>
  void pass_one(Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    copy(&value, sizeof value);
  }

  template <typename Values>
  void pass_all(Values& values) {
    std::size_t size = values.size();
    pass_one(size);
    values.resize(size);
    copy(values.data(), size * sizeof *values.data());
  }
  void pass_one(std::string& text) { pass_all(text); }
  template <typename Value>
  void pass_one(std::vector<Value>& values) {
    static_assert(std::is_trivially_copyable_v<Value>);
    pass_all(values);
  }

  std::string bytes_;
  bool reads_ = false;
  std::size_t at_ = 0;
};

/// Passes all fields but the ratios, which are added after the measurement.
void pass(ValueBytes& bytes, Measurement& measurement) {
  // Names every field, so that a new one cannot be forgotten.
  auto& [algorithm, version, kind, threads, target, outcome, evidence, reason, estimated_ms, samples_ms,
         samples_per_round, build_ms, pairs, pair_hash, statistics, statistics_by_seed, phases, explanation,
         own_bytes, peak_bytes, to_fastest, to_best_own, to_fastest_peer] = measurement;
  bytes.pass(algorithm, version, kind, threads, target, outcome, evidence, reason, estimated_ms, samples_ms,
             samples_per_round, build_ms, pairs, pair_hash, statistics, statistics_by_seed, phases,
             explanation, own_bytes, peak_bytes);
}

void pass(ValueBytes& bytes, std::vector<Measurement>& measurements, std::vector<double>& floor_ms) {
  for (Measurement& measurement : measurements) pass(bytes, measurement);
  bytes.pass(floor_ms);
}

/// What a child process sends, as its first byte.
enum class Sent : char { result = 'r', exception = 'e', out_of_memory = 'm' };

std::string sent(Sent what, std::string_view bytes = {}) {
  return std::string(1, static_cast<char>(what)).append(bytes);
}

/// The last two lines of a text, in one line.
std::string last_lines(std::string_view text) {
  constexpr std::string_view space = " \t\r\n";
  std::string lines;
  for (int line = 0; line < 2 && text.find_last_not_of(space) != text.npos; ++line) {
    text = text.substr(0, text.find_last_not_of(space) + 1);
    const std::size_t begin = text.rfind('\n') + 1;  // 0 if there is no other line
    const std::string_view last = text.substr(begin);
    lines = std::string(last.substr(last.find_first_not_of(space))) + (lines.empty() ? "" : "; ") + lines;
    text = text.substr(0, begin);
  }
  return lines;
}

/// The name of the algorithm whose code this step runs; empty if the step runs no algorithm.
std::string_view algorithm_of(std::string_view step) {
  const std::size_t comma = step.find(", ");
  return comma == step.npos ? std::string_view() : step.substr(0, comma);
}

/// Watches a child process that measures.
class ChildWatch {
 public:
  ChildWatch(const Watch& watch, double limit_seconds) : watch_(watch), limit_seconds_(limit_seconds) {}

  /// Whether the child may go on. Called ten times a second.
  bool goes_on(const platform::ChildNote& note) {
    const std::string step = note.text();
    if (!step.empty()) watch_.at(step);
    ticks_ = note.changes() == changes_ && !algorithm_of(step).empty() ? ticks_ + 1 : 0;
    changes_ = note.changes();
    hangs_ = hangs_ || ticks_ > 10 * limit_seconds_;
    return !hangs_;
  }

  bool hangs() const { return hangs_; }

 private:
  const Watch& watch_;
  double limit_seconds_;
  std::uint32_t changes_ = 0;
  double ticks_ = 0;  // during which the step has not changed
  bool hangs_ = false;
};

/// Measures some of a benchmark's entries.
using MeasureEntries = std::function<CaseResult(const Benchmark&)>;

/// What the child process sends: the measurements of all of the benchmark's entries, or an exception.
std::string measure_in_child(Benchmark benchmark, platform::ChildNote& note, const MeasureEntries& measure) {
  benchmark.watch = {{}, [&note](std::string_view step) { note.write(step); }};
  try {
    CaseResult result = measure(benchmark);
    ValueBytes bytes;
    pass(bytes, result.measurements, result.floor_ms);
    return sent(Sent::result, bytes.bytes());
  } catch (const std::bad_alloc&) {
    return sent(Sent::out_of_memory);
  } catch (const std::exception& thrown) {
    return sent(Sent::exception, thrown.what());
  }
}

/// Stores the measurements of those entries that have no reason yet.
void fill(CaseResult& result, std::vector<Measurement> measured) {
  std::size_t next = 0;
  for (Measurement& measurement : result.measurements) {
    if (measurement.reason.empty()) measurement = std::move(measured[next++]);
  }
}

/// Stores what the child process sent in the result's measurements that have no reason yet.
void receive(std::string_view what, CaseResult& result) {
  const std::string_view bytes = what.substr(1);
  if (Sent(what[0]) == Sent::out_of_memory) throw std::bad_alloc();
  if (Sent(what[0]) == Sent::exception) throw std::runtime_error(std::string(bytes));
  std::vector<Measurement> received(
      static_cast<std::size_t>(std::ranges::count(result.measurements, "", &Measurement::reason)));
  ValueBytes values(bytes);
  pass(values, received, result.floor_ms);
  fill(result, std::move(received));
}

CaseResult measure_guarded(const Case& measured, const Benchmark& benchmark, std::vector<std::string>& hung,
                           const MeasureEntries& measure) {
  CaseResult result{measured, {}};
  for (const Entry& entry : benchmark.entries) {
    result.measurements.push_back(measurement_of(entry));
    if (std::ranges::find(hung, result.measurements.back().algorithm) != hung.end())
      result.measurements.back().reason = "did not return in an earlier case";
  }
  const Effort& effort = benchmark.effort;
  const double budget = measured.mode == Mode::find ? effort.budget_seconds : effort.history_seconds;
  const double limit_seconds = std::max(effort.limit_seconds, 10 * budget);
  while (true) {
    std::vector<Entry> entries;  // that have not failed
    for (std::size_t i = 0; i < benchmark.entries.size(); ++i) {
      if (result.measurements[i].reason.empty()) entries.push_back(benchmark.entries[i]);
    }
    Benchmark some = benchmark;
    some.entries = entries;
    ChildWatch watch(benchmark.watch, limit_seconds);
    const std::optional<platform::ChildEnd> end = platform::run_in_child(
        [&](platform::ChildNote& note) { return measure_in_child(some, note, measure); },
        [&](const platform::ChildNote& note) { return watch.goes_on(note); });
    benchmark.watch.ask();  // Ctrl-C ends the child as well
    if (!end) {
      CaseResult rest = measure(some);
      result.floor_ms = std::move(rest.floor_ms);
      fill(result, std::move(rest.measurements));
      return result;
    }
    if (end->result) {
      std::fputs(end->output.c_str(), stderr);  // warnings, for example
      receive(*end->result, result);
      return result;
    }
    const std::string algorithm(algorithm_of(end->last_step));
    const std::string text = last_lines(end->output);
    const std::string ended = end->how + (text.empty() ? "" : ": ") + text;
    const std::string how = watch.hangs() ? fmt::format("did not return within {}", duration(limit_seconds))
                                          : "ended the process: " + ended;
    const auto culprit = std::ranges::find(result.measurements, algorithm, &Measurement::algorithm);
    if (culprit == result.measurements.end()) {
      for (Measurement& measurement : result.measurements) {
        if (!measurement.reason.empty()) continue;
        measurement.outcome = Outcome::failed;
        measurement.reason = fmt::format("the measuring process ended at '{}': {}", end->last_step, ended);
      }
      return result;
    }
    culprit->outcome = Outcome::failed;
    culprit->reason = fmt::format("{} {} (in '{}')", algorithm, how, end->last_step);
    if (watch.hangs()) hung.push_back(algorithm);
  }
}

}  // namespace

template <int D, typename Real>
CaseResult measure_case(const Case& measured, Histories<D, Real> inputs, const Benchmark& benchmark,
                        std::vector<std::string>& hung) {
  const MeasureEntries measure = [&](const Benchmark& some) {
    if (measured.mode == Mode::find) return measure_find<D, Real>(measured, inputs, some);
    return CaseResult{measured, measure_track<D, Real>(measured, inputs, some)};
  };
  // Threads that the parent had started would be missing in a later child.
  const auto needs_child = [](const Entry& entry) {
    return entry.algorithm->kind == AlgorithmKind::peer || measurement_of(entry).threads != 1;
  };
  return std::ranges::any_of(benchmark.entries, needs_child)
             ? measure_guarded(measured, benchmark, hung, measure)
             : measure(benchmark);
}

template CaseResult measure_case<2, float>(const Case&, Histories<2, float>, const Benchmark&,
                                           std::vector<std::string>&);
template CaseResult measure_case<3, float>(const Case&, Histories<3, float>, const Benchmark&,
                                           std::vector<std::string>&);
template CaseResult measure_case<2, double>(const Case&, Histories<2, double>, const Benchmark&,
                                            std::vector<std::string>&);
template CaseResult measure_case<3, double>(const Case&, Histories<3, double>, const Benchmark&,
                                            std::vector<std::string>&);

}  // namespace broadside::lab
