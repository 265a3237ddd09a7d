// Common parts of measuring searches and measuring histories.
#include "lab/measure/benchmark.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>

#include <fmt/format.h>

#include "broadside/error.hpp"
#include "broadside/executor.hpp"
#include "broadside/finder.hpp"
#include "broadside/version.hpp"

#include "lab/numbers.hpp"
#include "lab/peers/peers.hpp"

namespace broadside::lab {

void Watch::at(std::string_view what) const {
  ask();
  if (progress) progress(what);
}

void Watch::ask() const {
  if (stop && stop()) throw Stopped();
}

Measurement measurement_of(const Entry& entry) {
  const Algorithm& algorithm = *entry.algorithm;
  Measurement measurement;
  measurement.algorithm = entry.spec.text();
  measurement.version = algorithm.version.empty() ? BROADSIDE_VERSION : algorithm.version;
  measurement.kind = algorithm.kind;
  measurement.threads = threads_of(entry);
  if (algorithm.kind == AlgorithmKind::own) measurement.target = instruction_set();
  return measurement;
}

std::string fault_of(const std::string& algorithm, const std::function<std::string()>& check) {
  try {
    return check();
  } catch (const Stopped&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;  // not the algorithm's fault
  } catch (const std::exception& thrown) {
    return fmt::format("{} threw: {}", algorithm, thrown.what());
  }
}

bool attempt(Measurement& measurement, const std::function<std::string()>& step) {
  std::string fault;
  Outcome outcome = Outcome::failed;
  try {
    fault = fault_of(measurement.algorithm, step);
  } catch (const std::bad_alloc&) {
    fault = "out of memory; expected fewer boxes or pairs";
    outcome = Outcome::skipped;
  }
  if (fault.empty()) return true;
  measurement.outcome = outcome;
  measurement.reason = fault;
  measurement.samples_ms.clear();
  return false;
}

void skip(Measurement& measurement, const Estimate& estimate, std::size_t calls, double budget) {
  measurement.outcome = Outcome::skipped;
  measurement.reason = text(estimate);
  if (calls > 1) measurement.reason += fmt::format(", for {} frames", grouped(calls));
  measurement.reason += fmt::format("; budget {:g} s", budget);
  measurement.estimated_ms = estimate.seconds * 1e3 / static_cast<double>(calls);
}

std::string explanation_of(const Algorithm& algorithm, const std::string& of_this_call) {
  return of_this_call.empty() ? std::string(peers::build_note(algorithm.name)) : of_this_call;
}

void count_memory(Measurement& measurement, const Algorithm& algorithm,
                  const std::optional<Allocation>& allocation) {
  if (!allocation || algorithm.own_allocator) return;
  measurement.own_bytes = static_cast<std::uint64_t>(std::max<std::int64_t>(allocation->kept, 0));
  measurement.peak_bytes = static_cast<std::uint64_t>(std::max<std::int64_t>(allocation->peak, 0));
}

std::string unfit(const Entry& entry, int dimension, const Extremes& extremes) {
  const Algorithm& algorithm = *entry.algorithm;
  if (!algorithm.has_dimension(dimension)) return fmt::format("does not support {}D", dimension);
  if (extremes.infinite && !algorithm.limits.infinite_boxes) return "does not take infinite boxes";
  if (extremes.largest > algorithm.limits.max_coordinate)
    return fmt::format("does not take coordinates beyond {:.3g}", algorithm.limits.max_coordinate);
  if (extremes.boxes > algorithm.limits.max_boxes)
    return fmt::format("does not take more than {} boxes", grouped(algorithm.limits.max_boxes));
  try {
    // A value, such as an axis, may be valid in one dimension only.
    dimension == 2 ? void(Finder<2>(algorithm, entry.spec)) : void(Finder<3>(algorithm, entry.spec));
  } catch (const InvalidSpec& unusable) {
    return unusable.what();
  }
  return {};
}

template <int D, typename Real>
void Extremes::take(std::type_identity_t<std::span<const Box<D, Real>>> some) {
  boxes = std::max(boxes, some.size());
  for (const Box<D, Real>& box : some) {
    if (!is_present(box)) continue;
    for (const auto& corner : {box.min, box.max}) {
      for (const Real coordinate : corner) {
        if (std::isinf(coordinate))
          infinite = true;
        else
          largest = std::max(largest, std::abs(static_cast<double>(coordinate)));
      }
    }
  }
}

template void Extremes::take<2, float>(std::span<const Box2>);
template void Extremes::take<3, float>(std::span<const Box3>);
template void Extremes::take<2, double>(std::span<const DoubleBox2>);
template void Extremes::take<3, double>(std::span<const DoubleBox3>);

}  // namespace broadside::lab
