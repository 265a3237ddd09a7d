// Output of the worst-case hunt, printed and written.
#pragma once

#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "bench/worst/hunt.hpp"

namespace broadside::bench {

/// A table for each algorithm with its `max_lines` worst inputs over uniform boxes and, for `auto`, also over
/// the best.
std::string table(std::span<const InputResult> results, const Hunt& hunt, std::size_t max_lines);

/// A line for each algorithm above its bounds on the input; empty if there is none.
std::string above_text(const InputResult& result, const Bounds& bounds);

/// How many inputs were measured, left out or wrong, and how many exceed each algorithm's bounds.
std::string summary(std::span<const InputResult> results, const Hunt& hunt);

nlohmann::json to_json(std::span<const InputResult> results, const Hunt& hunt);

/// How many inputs exceed the bounds of `auto`.
std::size_t above_bounds(std::span<const InputResult> results, const Bounds& bounds);

/// Whether two algorithms found different pairs on some input, or one failed.
bool has_fault(std::span<const InputResult> results);

}  // namespace broadside::bench
