// One algorithm on one input: time, tests, memory, and a hash of the pairs.
#include "bench/worst/measure.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <sys/resource.h>

#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "lab/measure/benchmark.hpp"
#include "lab/measure/memory.hpp"
#include "lab/measure/samples.hpp"
#include "lab/platform/child_process.hpp"

namespace broadside::bench {
namespace {

/// The beginning of a text, as Run::fault holds it.
FaultText fault_of(std::string_view text) {
  FaultText fault{};
  text.copy(fault.data(), fault.size() - 1);
  return fault;
}

/// Calls `run` in a child process and returns its result; too_slow after `seconds`, out_of_memory beyond
/// `max_bytes` of address space. Throws std::runtime_error if no process can be created.
MeasuredRun in_child(double seconds, std::uint64_t max_bytes, const std::function<MeasuredRun()>& run) {
  const auto work = [&](lab::platform::ChildNote&) {
    const rlimit limit{max_bytes, max_bytes};
    setrlimit(RLIMIT_AS, &limit);
    MeasuredRun result;
    try {
      result = run();
    } catch (const std::bad_alloc&) {
      result = {.end = MeasuredRun::End::out_of_memory};
    } catch (const std::exception& error) {
      result = {.end = MeasuredRun::End::failed, .fault = fault_of(error.what())};
    }
    return std::string(reinterpret_cast<const char*>(&result), sizeof result);
  };
  const lab::Stopwatch watch;
  const auto is_in_time = [&] { return watch.milliseconds() <= seconds * 1e3; };
  const auto end =
      lab::platform::run_in_child(work, [&](const lab::platform::ChildNote&) { return is_in_time(); });
  if (!end) throw std::runtime_error("worst: no process can be made");
  MeasuredRun result{.end = is_in_time() ? MeasuredRun::End::failed : MeasuredRun::End::too_slow,
                     .fault = fault_of(end->how)};
  if (end->result) std::memcpy(&result, end->result->data(), sizeof result);
  return result;
}

struct TooManyPairs : std::exception {};

/// Hashes pairs, and stops a search that finds too many.
class LimitedHasher final : public PairSink {
 public:
  explicit LimitedHasher(double max_count) : max_count_(max_count) {}

  std::uint64_t hash() const noexcept { return hash_; }
  std::uint64_t count() const noexcept { return count_; }

 private:
  void consume(std::span<const Pair> pairs) override {
    for (const Pair pair : pairs) hash_ += broadside::hash(pair);
    count_ += pairs.size();
    if (static_cast<double>(count_) > max_count_) throw TooManyPairs();
  }

  double max_count_;
  std::uint64_t hash_ = 0;
  std::uint64_t count_ = 0;
};

double tests_of(const std::optional<Statistics>& statistics) {
  return statistics ? static_cast<double>(statistics->tests) : -1;
}

double peak(const lab::AllocationMeter& meter) {
  const auto memory = meter.read();
  return memory ? static_cast<double>(memory->peak) : 0;
}

template <int D, typename Real>
class Measured {
 public:
  Measured(const lab::HardInput& input, const HuntEffort& effort)
      : effort_(effort),
        is_tracked_(input.call == lab::HardCall::track),
        left_count_(lab::left_count(input, effort.boxes)),
        history_(lab::make_input<D, Real>(input, effort.boxes, effort.frames)),
        max_pairs_(effort.max_pairs * static_cast<double>(effort.boxes)) {}

  MeasuredRun run(const lab::Entry& entry) const {
    MeasuredRun counted;
    try {
      counted = once(entry, true);
    } catch (const TooManyPairs&) {
      return {.end = MeasuredRun::End::too_many_pairs};
    }
    for (std::size_t round = 0; round < effort_.rounds; ++round) {
      const MeasuredRun timed = once(entry, false);
      if (timed.pairs != counted.pairs || timed.hash != counted.hash)
        throw std::runtime_error("found other pairs in another call; expected the same");
      if (round == 0 || timed.milliseconds < counted.milliseconds) {
        counted.milliseconds = timed.milliseconds;
        counted.worst_milliseconds = timed.worst_milliseconds;
      }
    }
    return counted;
  }

 private:
  MeasuredRun once(const lab::Entry& entry, bool count) const {
    return is_tracked_ ? track(entry, count) : find(entry, count);
  }

  MeasuredRun find(const lab::Entry& entry, bool count) const {
    LimitedHasher pairs(max_pairs_);
    std::optional<lab::AllocationMeter> meter;
    if (count) meter.emplace();
    const lab::Stopwatch watch;
    Finder<D, Real> finder(*entry.algorithm, entry.spec);
    const std::optional<Statistics> statistics = left_count_ > 0
                                                     ? finder.find_across(history_.boxes, left_count_, pairs)
                                                     : finder.find(history_.boxes, pairs);
    const double milliseconds = watch.milliseconds();
    return {.milliseconds = milliseconds,
            .worst_milliseconds = milliseconds,
            .tests = tests_of(statistics),
            .pairs = pairs.count(),
            .hash = pairs.hash(),
            .peak_bytes = meter ? peak(*meter) : 0};
  }

  MeasuredRun track(const lab::Entry& entry, bool count) const {
    std::vector<Box<D, Real>> boxes = history_.boxes;
    MeasuredRun run;
    std::vector<double> frames;
    std::vector<double> tests;
    std::optional<lab::AllocationMeter> meter;
    if (count) meter.emplace();
    Tracker<D, Real> tracker(*entry.algorithm, entry.spec);
    std::optional<Statistics> statistics;
    std::int64_t held = 0;
    const auto update = [&](std::span<const BoxId> changed, bool is_first) {
      // Allows for a hundred movers that each begin a pair with a giant box.
      const double max_events =
          is_first ? max_pairs_ : effort_.max_pairs * (100 + static_cast<double>(changed.size()));
      LimitedHasher begun(max_events);
      LimitedHasher ended(max_events);
      const lab::Stopwatch watch;
      statistics = tracker.update({boxes, changed}, begun, ended);
      const double milliseconds = watch.milliseconds();
      // The hash depends on the frame, and on whether a pair began or ended in it.
      constexpr std::uint64_t odd = 0x9e3779b97f4a7c15U;
      run.hash = (run.hash * odd + begun.hash()) * odd + ended.hash();
      (is_first ? run.pairs : run.events) += begun.count() + ended.count();
      held += static_cast<std::int64_t>(begun.count()) - static_cast<std::int64_t>(ended.count());
      if (static_cast<double>(held) > max_pairs_) throw TooManyPairs();
      return milliseconds;
    };
    update({}, true);
    for (const lab::Step<D, Real>& step : history_.steps) {
      lab::apply(step, boxes);
      frames.push_back(update(step.changed, false));
      tests.push_back(tests_of(statistics));
    }
    run.peak_bytes = meter ? peak(*meter) : 0;
    run.milliseconds = lab::median(frames);
    run.worst_milliseconds = std::ranges::max(frames);
    run.tests = lab::median(tests);
    return run;
  }

  HuntEffort effort_;
  bool is_tracked_;
  std::size_t left_count_;
  lab::History<D, Real> history_;
  double max_pairs_;
};

template <int D, typename Real>
RunAlgorithm prepare_in(const lab::HardInput& input, const HuntEffort& effort) {
  const auto measured = std::make_shared<const Measured<D, Real>>(input, effort);
  return [measured, max_bytes = effort.max_bytes](const lab::Entry& entry, double seconds) {
    return in_child(seconds, max_bytes, [&] { return measured->run(entry); });
  };
}

}  // namespace

RunAlgorithm prepare(const lab::HardInput& input, const HuntEffort& effort) {
  if (input.in_double)
    return input.dimension == 2 ? prepare_in<2, double>(input, effort) : prepare_in<3, double>(input, effort);
  return input.dimension == 2 ? prepare_in<2, float>(input, effort) : prepare_in<3, float>(input, effort);
}

}  // namespace broadside::bench
