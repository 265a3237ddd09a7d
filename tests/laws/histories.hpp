// Histories of boxes that come, move, jump and go, for the law of trackers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "broadside/algorithm.hpp"

#include "lab/scenes/scene.hpp"

namespace broadside::laws {

/// A history and what is hard about it.
template <int D>
struct NamedHistory {
  std::string name;
  lab::History<D> history;
};

/// All hard histories that are within the algorithm's declared limits.
template <int D>
std::vector<NamedHistory<D>> hard_histories(const Algorithm& algorithm);

}  // namespace broadside::laws
