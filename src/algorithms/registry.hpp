// The library's algorithms: looks one up and makes its searcher.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "broadside/algorithm.hpp"

namespace broadside::algorithm {

Algorithm automatic();  // "auto"
Algorithm brute_force();
Algorithm grid();
Algorithm sweep_and_prune();
Algorithm quadtree();
Algorithm bvh();

/// The algorithms in BROADSIDE_ALGORITHMS, in that order. CMake generates this function.
std::vector<Algorithm> linked_algorithms();

/// Whether BROADSIDE_ALGORITHMS lists it. Unlike algorithms(), may be called while the list is being made.
bool is_linked(std::string_view name) noexcept;

/// The algorithm of that name. If there is none, throws InvalidSpec, which lists the known names.
const Algorithm& require_algorithm(std::string_view name);

/// Reads the values in `spec`, in the default floating-point environment. Ignores the name in `spec`. Throws
/// InvalidSpec if a value is invalid.
Settings settings_of(const Algorithm& algorithm, const Spec& spec);

/// The number of threads that the settings ask for; 1 for an algorithm without the tunable `threads`.
std::size_t threads_of(const Algorithm& algorithm, const Settings& settings);

/// Makes the algorithm's searcher. Throws InvalidSpec if the algorithm does not support D dimensions.
template <int D>
std::unique_ptr<Searcher<D>> searcher(const Algorithm& algorithm, const Settings& settings);

}  // namespace broadside::algorithm
