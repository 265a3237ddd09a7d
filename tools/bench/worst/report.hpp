// What the worst-case hunt prints and writes.
#pragma once

#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "bench/worst/hunt.hpp"

namespace broadside::bench {

/// A table for each algorithm, its `most` worst inputs over uniform boxes and, of auto, over the best as
/// well.
std::string table(std::span<const InputResult> results, const Hunt& hunt, std::size_t most);

/// A line for each algorithm that is above its bounds on the input; empty if there is none.
std::string above_text(const InputResult& result, const Bounds& bounds);

/// How many inputs were measured, left out or wrong, and how many are above each algorithm's bounds.
std::string summary(std::span<const InputResult> results, const Hunt& hunt);

nlohmann::json to_json(std::span<const InputResult> results, const Hunt& hunt);

/// How many inputs are above auto's bounds.
std::size_t above_bounds(std::span<const InputResult> results, const Bounds& bounds);

/// Whether two algorithms found different pairs on some input, or one failed.
bool has_fault(std::span<const InputResult> results);

}  // namespace broadside::bench
