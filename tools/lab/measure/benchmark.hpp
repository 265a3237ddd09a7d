// What measurements of searches and of histories share: the entries, their limits, outcomes and clock.
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

/// Thrown between two samples when a comparison should stop.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "the comparison was stopped"; }
};

/// Watches a comparison while it runs. Both functions are called between samples, in the caller's thread.
/// `stop` is also called during searches that are long or not timed.
struct Watch {
  std::function<bool()> stop{};                           ///< whether to stop; empty: never
  std::function<void(std::string_view what)> progress{};  ///< called with the current step; empty: not called

  /// Reports and asks. Throws Stopped.
  void at(std::string_view what) const;

  /// Makes a finder or a tracker check during a search whether to stop; the search then throws Stopped. If
  /// `asks` is false, searches run undisturbed. This object must outlive the searches.
  template <typename Searching>
  void ask_within(Searching& searching, bool asks = true) const {
    Workers workers = searching.workers();
    workers.checkpoint = nullptr;
    if (asks && stop) workers.checkpoint = [this] { ask(); };
    searching.set_workers(workers);
  }

  /// Throws Stopped if it should.
  void ask() const;
};

/// A timed call up to this long does not check whether to stop, so that the check does not disturb it.
inline constexpr double min_asking_ms = 500;

/// Everything a case is measured with except its boxes.
struct Benchmark {
  std::span<const Entry> entries;
  std::span<const Algorithm> known;  ///< where references are taken from
  Effort effort;
  Watch watch;
  MeasureOptions measure_options{};
};

/// Milliseconds since construction, to the nanosecond.
class Stopwatch {
 public:
  double milliseconds() const {
    const auto passed = std::chrono::steady_clock::now() - begin_;
    return static_cast<double>(std::chrono::duration_cast<std::chrono::nanoseconds>(passed).count()) / 1e6;
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// A measurement with the algorithm's name in it and nothing measured.
Measurement measurement_of(const Entry& entry);

/// Runs a check of an algorithm and returns the fault that it returns, or what the algorithm threw. Lets
/// Stopped and std::bad_alloc through, which are not the algorithm's fault.
std::string fault_of(const std::string& algorithm, const std::function<std::string()>& check);

/// Runs a step of a measurement, which returns the algorithm's fault. With a fault, or if the algorithm
/// throws, the measurement has failed; if memory runs out, it is skipped. It then has a reason and no times.
/// Returns whether all is well. Lets Stopped through.
bool attempt(Measurement& measurement, const std::function<std::string()>& step);

/// Marks the algorithm as too slow for `budget` seconds, in which it would have to make `calls` calls. The
/// estimate is of all of them.
void skip(Measurement& measurement, const Estimate& estimate, std::size_t calls, double budget);

/// What a reader should know about the algorithm's time: its own explanation of what it did, or a note on the
/// build of the library behind it; empty where there is neither.
std::string explanation_of(const Algorithm& algorithm, const std::string& of_this_call);

/// Notes the memory that was counted, if it was and if all that `algorithm` takes could be counted.
void count_memory(Measurement& measurement, const Algorithm& algorithm,
                  const std::optional<Allocation>& allocation);

/// The properties of boxes that an algorithm's declared limits concern; absent boxes do not count.
struct Extremes {
  bool infinite = false;  ///< whether any of them reaches to infinity
  double largest = 0;     ///< the greatest magnitude of their finite coordinates
  std::size_t boxes = 0;  ///< the most there are at once

  /// Takes in more boxes.
  template <int D, typename Real = float>
  void take(std::type_identity_t<std::span<const Box<D, Real>>> some);
};

/// Why the entry cannot take boxes of this dimension and with these extremes; empty if it can.
std::string unfit(const Entry& entry, int dimension, const Extremes& extremes);

}  // namespace broadside::lab
