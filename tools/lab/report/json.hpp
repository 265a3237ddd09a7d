// Results as JSON.
#pragma once

#include <span>
#include <string>

#include "lab/measure/compare.hpp"

namespace broadside::lab {

/// An object by the schema "broadside.results/2": today's date, this machine and build, the command, whether
/// the comparison was stopped early, the share of a processor that the run had, and a flat list of
/// measurements with every sample; null for unknown values. docs/benchmarking.md and docs/schemas/ describe
/// each field. Hashes are hexadecimal texts, because a JSON number cannot hold 64 bits.
std::string json_of(const Comparison& comparison, std::span<const std::string> command);

}  // namespace broadside::lab
