// What measuring a search and measuring a history have in common: who is let in, and who is watching.
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

#include "lab/catalogue.hpp"
#include "lab/measure/allocation.hpp"
#include "lab/measure/estimate.hpp"
#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// Thrown between two samples once a comparison is to stop.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "the comparison was stopped"; }
};

/// Who follows a comparison while it runs. Both are called between samples, in the caller's thread.
struct Watch {
  std::function<bool()> stop{};                           ///< whether to stop; empty: never
  std::function<void(std::string_view what)> progress{};  ///< what is going on; empty: nobody asks

  /// Reports and asks. Throws Stopped.
  void at(std::string_view what) const;
};

/// Everything a case is measured with, but for its boxes.
struct Contest {
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

/// In which order `seats` contestants take their turn in a round: drawn anew for each, and the same in each
/// run. Who follows whom matters: what one leaves in the caches is cheap for the next.
std::vector<std::size_t> turns(std::size_t seats, std::size_t round);

/// A measurement with the contender's name in it and nothing measured.
Measurement entry_of(const Contender& contender);

/// Runs something of the contender's, which says what is wrong with what it did: that, or what it threw;
/// empty if nothing is. Lets Stopped through.
std::string fault_of(const Measurement& entry, const std::function<std::string()>& run);

/// Marks the contender as wrong. It keeps no time.
void fail(Measurement& entry, const std::string& fault);

/// Marks the contender as too slow for `budget` seconds, in which it would have to make `calls` calls. The
/// estimate is of all of them.
void skip(Measurement& entry, const Estimate& estimate, std::size_t calls, double budget);

/// Notes the memory that was counted, if it was and if all that `algorithm` takes could be counted.
void count_memory(Measurement& entry, const Algorithm& algorithm,
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
