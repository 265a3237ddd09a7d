// The library's algorithms, and how one is looked up and made.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "broadside/algorithm.hpp"

namespace broadside::algorithm {

Algorithm automatic();  // of auto/
Algorithm brute_force();
Algorithm grid();
Algorithm sweep_and_prune();
Algorithm quadtree();
Algorithm bvh();

/// The algorithms that BROADSIDE_ALGORITHMS lists, in its order: CMake writes this function.
std::vector<Algorithm> linked_algorithms();

/// Whether it lists the algorithm. Unlike algorithms(), it may be asked while the list is made.
bool is_linked(std::string_view name) noexcept;

/// The algorithm of that name. Throws InvalidSpec, naming the algorithms there are, if there is none.
const Algorithm& require_algorithm(std::string_view name);

/// The values in `spec`, whose name is not looked at, read in the default floating-point environment. Throws
/// InvalidSpec if one is wrong.
Settings settings_of(const Algorithm& algorithm, const Spec& spec);

/// The number of threads that the settings ask for; 1 for an algorithm without the tunable `threads`.
std::size_t threads_of(const Algorithm& algorithm, const Settings& settings);

/// A searcher by the algorithm. Throws InvalidSpec if it does not do D dimensions.
template <int D>
std::unique_ptr<Searcher<D>> searcher(const Algorithm& algorithm, const Settings& settings);

}  // namespace broadside::algorithm
