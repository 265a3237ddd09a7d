// Histories of boxes that are added, move, jump and are removed, for the equivalence test of trackers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "broadside/algorithm.hpp"

#include "lab/scenes/scene.hpp"

namespace broadside::laws {

/// A history, and why it is difficult.
template <int D>
struct NamedHistory {
  std::string name;
  lab::History<D> history;
};

/// All difficult histories within the algorithm's declared limits.
template <int D>
std::vector<NamedHistory<D>> hard_histories(const Algorithm& algorithm);

}  // namespace broadside::laws
