// A comparison as tables that a person likes to read.
#pragma once

#include <string>

#include "lab/measure/compare.hpp"

namespace broadside::lab {

/// One case: a line that says what it is, and a line for each algorithm, the fastest first, those without a
/// time last. Where the floor was timed, its line ends the table, and each time is given in floors as well.
/// Plain text.
std::string table_of(const CaseResult& result);

/// What all cases come to: each algorithm's ratio to the fastest as a geometric mean, how many measurements
/// there were and whether all were verified, each failure with what diverged first, and what could not be
/// compared.
std::string summary_of(const Comparison& comparison);

}  // namespace broadside::lab
