// Results as JSON.
#pragma once

#include <span>
#include <string>

#include "lab/report/results.hpp"

namespace broadside::lab {

/// Whether JSON holds every sample, or null in their place.
enum class Samples { keep, leave_out };

/// One object by the schema "broadside.results/2": date, machine, build, command, whether the comparison was
/// stopped before its end, how much of a processor the run had, and a flat list of measurements, null where
/// something is not known; then the same for each other machine. docs/benchmarking.md and docs/schemas/ say
/// what each field is. Hashes are hexadecimal texts, since a JSON number does not hold 64 bits. There is at
/// least one machine.
std::string json_of(std::span<const Results> machines, Samples samples = Samples::keep);
inline std::string json_of(const Results& results, Samples samples = Samples::keep) {
  return json_of(std::span(&results, 1), samples);
}

}  // namespace broadside::lab
