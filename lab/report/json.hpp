// A comparison as JSON, by the schema "broadside.results/1".
#pragma once

#include <span>
#include <string>

#include "lab/measure/compare.hpp"

namespace broadside::lab {

/// One object: schema, machine, build, command, whether the comparison was stopped before its end, and a flat
/// list of measurements, every field in each of them, null where it is not known. Hashes are hexadecimal
/// texts, since a JSON number does not hold 64 bits. `floor_ms` is the median of the case's floor, the same
/// in each of its measurements. `command` is the program's arguments, the program itself first.
std::string json_of(const Comparison& comparison, std::span<const std::string> command);

}  // namespace broadside::lab
