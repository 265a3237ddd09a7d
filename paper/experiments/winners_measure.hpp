// What is measured for our own claim: which algorithm is the fastest where, and what instruction sets and
// threads add.
#pragma once

#include <string>
#include <vector>

#include "paper/experiments/laboratory.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {

/// Ours that search by one structure each; a column of the table "fields" each, beside "auto".
const std::vector<std::string>& single_algorithms();

/// A row for each field of six maps: the time of each of ours, the fastest one, and the fastest peer.
Table measure_fields(const Laboratory& laboratory);

/// The time of each of ours on each instruction set there is here (quickly: on the best and the last).
Table measure_instruction_sets(const Laboratory& laboratory);

/// The time of each of ours that can use threads, with 1, 2 and as many as there are.
Table measure_threads(const Laboratory& laboratory);

}  // namespace broadside::lab
