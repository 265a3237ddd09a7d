// Results as JSON.
#pragma once

#include <span>
#include <string>

#include "lab/measure/compare.hpp"

namespace broadside::lab {

/// One object by the schema "broadside.results/2": today's date, this machine and build, the command, whether
/// the comparison was stopped before its end, how much of a processor the run had, and a flat list of
/// measurements with every sample; null where something is not known. docs/benchmarking.md and docs/schemas/
/// say what each field is. Hashes are hexadecimal texts, since a JSON number does not hold 64 bits.
std::string json_of(const Comparison& comparison, std::span<const std::string> command);

}  // namespace broadside::lab
