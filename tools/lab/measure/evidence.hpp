// Counts how many structures and libraries of a case agree.
#pragma once

#include <span>

#include "lab/measure/measurement.hpp"
#include "lab/measure/reference.hpp"

namespace broadside::lab {

/// For each verified measurement of a case, fills in how many structures and libraries gave the same pairs
/// (compared by number and hash). An algorithm is one structure, whatever its spec; auto does not count,
/// because it uses one of the others. Broadside's algorithms, the paper's listings and `references` count as
/// one library. Other libraries are identified by their version text up to the number.
void count_agreement(std::span<Measurement> measurements, std::span<const Reference> references);

}  // namespace broadside::lab
