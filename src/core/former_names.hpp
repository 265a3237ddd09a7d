// Names of earlier versions, so that old specs and results are understood, or rejected with the reason.
#pragma once

#include <string_view>

#include "broadside/spec.hpp"

namespace broadside::core {

/// The current name of an algorithm; `name` itself if it is not a former name.
std::string_view current_algorithm(std::string_view name) noexcept;

/// The current name of a value of an algorithm's tunable, if only its name changed; else `value` itself.
std::string_view current_value(std::string_view algorithm, std::string_view tunable,
                               std::string_view value) noexcept;

/// Translates a spec of an earlier version: uses current names, and drops removed tunables and values, which
/// never affected the pairs.
Spec current_spec(Spec spec);

/// The canonical form of a spec, the same for all specs that make the same algorithm with the same values:
/// current names, tunables in the algorithm's order except those with default values, numbers in their
/// shortest form. `spec` must be one that made an algorithm.
Spec canonical_spec(const Spec& spec);

/// The reason why a tunable of the library's algorithm no longer has this value, as the end of an error
/// message; empty if it never had it.
std::string_view former_value(std::string_view algorithm, std::string_view tunable, std::string_view value);

/// The reason why a library's algorithm no longer has this tunable, likewise.
std::string_view former_tunable(std::string_view algorithm, std::string_view tunable);

}  // namespace broadside::core
