// Common parts of measuring searches and histories: the entries, their limits, outcomes and clock.
#pragma once

#include <chrono>
#include <cstddef>
#include <exception>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "broadside/executor.hpp"

#include "lab/catalogue.hpp"
#include "lab/measure/measurement.hpp"
#include "lab/measure/memory.hpp"
#include "lab/measure/rounds.hpp"

namespace broadside::lab {

/// Thrown between two samples to stop a comparison.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "the comparison was stopped"; }
};

/// Observes a comparison while it runs. Both functions are called between samples, in the caller's thread.
/// `stop` is also called during searches that are long or not timed.
struct Watch {
  std::function<bool()> stop{};  ///< whether to stop; empty: never
  /// Called with the current step; empty: not called. The step is "SPEC, WHAT" while code of that algorithm
  /// runs, and has no comma otherwise.
  std::function<void(std::string_view what)> progress{};

  /// Reports the step and checks whether to stop. Throws Stopped.
  void at(std::string_view what) const;

  /// Makes a finder or tracker check whether to stop during a search; the search then throws Stopped. If
  /// `asks` is false, searches run undisturbed. This object must outlive the searches.
  template <typename Searching>
  void ask_within(Searching& searching, bool asks = true) const {
    Workers workers = searching.workers();
    workers.checkpoint = nullptr;
    if (asks && stop) workers.checkpoint = [this] { ask(); };
    searching.set_workers(workers);
  }

  /// Throws Stopped if the comparison should stop.
  void ask() const;
};

/// Timed calls of up to this length do not check whether to stop, so that the check does not disturb them.
inline constexpr double min_asking_ms = 500;

/// The parameters of a case's measurement, without its boxes.
struct Benchmark {
  std::span<const Entry> entries;
  std::span<const Algorithm> known;  ///< the algorithms to take references from
  Effort effort;
  Watch watch;
  MeasureOptions measure_options{};
};

/// Milliseconds since construction, with nanosecond resolution.
class Stopwatch {
 public:
  double milliseconds() const {
    const auto passed = std::chrono::steady_clock::now() - begin_;
    return static_cast<double>(std::chrono::duration_cast<std::chrono::nanoseconds>(passed).count()) / 1e6;
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// An empty measurement with the algorithm's name.
Measurement measurement_of(const Entry& entry);

/// Runs a check of an algorithm. Returns the fault that the check returns, or the text of an exception.
/// Stopped and std::bad_alloc, which are not the algorithm's fault, pass through.
std::string fault_of(const std::string& algorithm, const std::function<std::string()>& check);

/// Runs a step of a measurement; `step` returns the algorithm's fault. After a fault or an exception the
/// measurement has failed; if memory runs out, it is skipped. It then has a reason and no times. Returns
/// whether the step succeeded. Stopped passes through.
bool attempt(Measurement& measurement, const std::function<std::string()>& step);

/// Skips the algorithm as too slow: it cannot make `calls` calls within `budget` seconds. The estimate is for
/// all of them.
void skip(Measurement& measurement, const Estimate& estimate, std::size_t calls, double budget);

/// An explanation of the algorithm's time: its own report of its choices, or a note on the build of its
/// library; empty if there is neither.
std::string explanation_of(const Algorithm& algorithm, const std::string& of_this_call);

/// Stores the counted memory, if memory was counted and counting covers all that `algorithm` allocates.
void count_memory(Measurement& measurement, const Algorithm& algorithm,
                  const std::optional<Allocation>& allocation);

/// The properties of boxes to which an algorithm's declared limits apply; absent boxes do not count.
struct Extremes {
  bool infinite = false;  ///< whether any box reaches to infinity
  double largest = 0;     ///< the maximum magnitude of finite coordinates
  std::size_t boxes = 0;  ///< the maximum number of boxes at once

  /// Includes more boxes.
  template <int D, typename Real = float>
  void take(std::type_identity_t<std::span<const Box<D, Real>>> some);
};

/// Why the entry cannot search boxes of this dimension with these extremes; empty if it can.
std::string unfit(const Entry& entry, int dimension, const Extremes& extremes);

}  // namespace broadside::lab
