// Which structures and libraries of a case agree.
#pragma once

#include <span>

#include "lab/measure/measurement.hpp"
#include "lab/measure/reference.hpp"

namespace broadside::lab {

/// Fills in how many structures and libraries gave the same pairs (by number and hash) as each measurement of
/// a case that was verified. An algorithm is one structure, whatever its spec; auto, which takes one of the
/// others, is none. Broadside's own, the paper's listings and `references` are of one library; each other
/// library is told by its version, up to the number.
void count_agreement(std::span<Measurement> measurements, std::span<const Reference> references);

}  // namespace broadside::lab
