// What measuring a search and measuring a history have in common: which algorithms take part, in which
// rounds, and what is called on the way.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "lab/catalogue.hpp"
#include "lab/measure/allocation.hpp"
#include "lab/measure/estimate.hpp"
#include "lab/measure/measurement.hpp"
#include "lab/measure/paired_ratio.hpp"

namespace broadside::lab {

/// Thrown between two samples once a comparison is to stop.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "the comparison was stopped"; }
};

/// Who follows a comparison while it runs. Both are called between samples, in the caller's thread.
struct Watch {
  std::function<bool()> stop{};                           ///< whether to stop; empty: never
  std::function<void(std::string_view what)> progress{};  ///< what is going on; empty: nothing is called

  /// Reports and asks. Throws Stopped.
  void at(std::string_view what) const;
};

/// What a case is measured with, but for its boxes.
struct Benchmark {
  std::span<const Contender> contenders;
  std::span<const Algorithm> known;  ///< where references are taken from
  Effort effort;
  Watch watch;
};

/// Milliseconds since it was made, to the nanosecond.
class Stopwatch {
 public:
  double milliseconds() const {
    const auto passed = std::chrono::steady_clock::now() - begin_;
    return static_cast<double>(std::chrono::duration_cast<std::chrono::nanoseconds>(passed).count()) / 1e6;
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// The order in which `entries` entries take their turn in a round: drawn anew for each round, and the same
/// in each run. No entry always runs after the same other one.
std::vector<std::size_t> turns(std::size_t entries, std::size_t round);

/// In which rounds of a case an entry takes part: the first ones, all without a gap, so that round r of any
/// two entries is on the same boxes.
class Participation {
 public:
  /// Counts a round and the time it took.
  void add(double milliseconds);

  /// Sets the number of rounds, whatever time they take.
  void limit(std::size_t rounds) noexcept { limit_ = rounds; }

  /// It failed.
  void end() noexcept { has_ended_ = true; }

  /// Whether it takes part in another round.
  bool goes_on(const Effort& effort) const noexcept;

 private:
  std::size_t rounds_ = 0;
  double spent_ms_ = 0;
  std::optional<std::size_t> limit_{};
  bool has_ended_ = false;
};

/// After the first round: limits the rounds of the entries whose round took longer than `slow_seconds`, or
/// than effort.far_ratio times the fastest other library's and our fastest. Readers need the ratio of what is
/// close, and the rounds are for that. An Entry has `measurement` and `participation`.
template <typename Entry>
void limit_rounds(std::vector<Entry>& entries, const Effort& effort, double slow_seconds) {
  const auto fastest_of_kind = [&](AlgorithmKind kind) {
    double fastest = std::numeric_limits<double>::infinity();
    for (const Entry& entry : entries) {
      if (entry.measurement->kind == kind && !entry.measurement->samples_ms.empty())
        fastest = std::min(fastest, round_times(*entry.measurement)[0]);
    }
    return fastest;
  };
  // Where there are no peers nothing is far behind them.
  double close = std::max(far_from_seconds * 1e3, effort.far_ratio * fastest_of_kind(AlgorithmKind::peer));
  if (const double own = fastest_of_kind(AlgorithmKind::own); std::isfinite(own))
    close = std::max(close, effort.far_ratio * own);
  for (Entry& entry : entries) {
    if (entry.measurement->samples_ms.empty()) continue;
    const std::vector<double>& samples = entry.measurement->samples_ms;
    if (round_times(*entry.measurement)[0] > close)
      entry.participation.limit(effort.far_rounds);
    else if (std::accumulate(samples.begin(), samples.end(), 0.0) > slow_seconds * 1e3)
      entry.participation.limit(effort.slow_rounds);
  }
}

/// Whether a round is still to be played: the first two, and others while the case has time.
bool has_time(const Effort& effort, std::size_t round, const Stopwatch& of_case);

/// Has the process keep memory that is freed. An allocation that was made before then costs no page faults,
/// whichever algorithm made it: without this, the first to need memory pays for all that follow. Where the C
/// library is not glibc it does nothing.
void keep_freed_memory();

/// Brings the processor's caches into the same state before each sample, whatever ran before.
class CacheState {
 public:
  CacheState();

  /// Empties the first two levels, as the rest of an engine's frame does, and reads `input`, which an engine
  /// has just written.
  void settle(std::span<const std::byte> input);

 private:
  std::vector<std::uint64_t> memory_;  // more than the second level holds
};

/// A measurement with the algorithm's name in it and nothing measured.
Measurement measurement_of(const Contender& contender);

/// Runs `run`, which calls the algorithm and returns what is wrong with its result: returns that, or what the
/// algorithm threw; empty if nothing is wrong. Lets Stopped through.
std::string fault_of(const Measurement& measurement, const std::function<std::string()>& run);

/// Marks the algorithm as wrong. It keeps no time.
void fail(Measurement& measurement, const std::string& fault);

/// Marks the algorithm as too slow for `budget` seconds, in which it would have to make `calls` calls. The
/// estimate is of all of them.
void skip(Measurement& measurement, const Estimate& estimate, std::size_t calls, double budget);

/// Notes the memory that was counted, if it was and if all that `algorithm` takes could be counted.
void count_memory(Measurement& measurement, const Algorithm& algorithm,
                  const std::optional<Allocation>& allocation);

/// What boxes have that may be beyond an algorithm's declared limits, absent ones aside.
struct Extremes {
  bool infinite = false;  ///< whether any of them reaches to infinity
  double largest = 0;     ///< the greatest magnitude of their finite coordinates
  std::size_t boxes = 0;  ///< the most there are at once

  /// Takes in more boxes.
  template <int D, typename Real = float>
  void take(std::type_identity_t<std::span<const Box<D, Real>>> some);
};

/// Why the contender cannot take boxes of this dimension and with these extremes; empty if it can.
std::string unfit(const Contender& contender, int dimension, const Extremes& extremes);

}  // namespace broadside::lab
