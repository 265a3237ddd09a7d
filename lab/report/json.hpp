// A comparison as JSON, by the schema "broadside.results/2".
#pragma once

#include <span>
#include <string>

#include "lab/measure/compare.hpp"

namespace broadside::lab {

/// One object: schema, date, machine, build, command, whether the comparison was stopped before its end, how
/// much of a processor the run had, and a flat list of measurements, every field in each of them, null where
/// it is not known. docs/benchmarking.md and docs/schemas/ say what each field is. Hashes are hexadecimal
/// texts, since a JSON number does not hold 64 bits. `command` is the program's arguments, the program itself
/// first.
std::string json_of(const Comparison& comparison, std::span<const std::string> command);

}  // namespace broadside::lab
