// Which measurements of a case are how fast.
#pragma once

#include <string>

#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// The algorithm's name, whatever its options are.
std::string structure_of(const Measurement& measurement);

/// Whether it has a time.
bool is_timed(const Measurement& measurement);

/// The median of its rounds in milliseconds, or the estimate where it was skipped; infinite where nothing is
/// known.
double time_of(const Measurement& measurement);

/// The fastest measurement of the case; null where none was timed.
const Measurement* fastest_of(const CaseResult& result);

/// The fastest one of a kind; null where none was timed.
const Measurement* fastest_of_kind(const CaseResult& result, AlgorithmKind kind);

/// The fastest one of our own: other than auto, which takes one of the others; auto where it is the only one.
/// Null where none was timed.
const Measurement* best_own_of(const CaseResult& result);

/// The fastest auto, of whatever options; null where none was timed.
const Measurement* auto_of(const CaseResult& result);

/// "uniform, 2D, 1,000 boxes".
std::string name_of(const Case& measured);

/// "uniform, 2D, 1,000 boxes, 10 % moving", where boxes move.
std::string whole_name_of(const Case& measured);

}  // namespace broadside::lab
