// Ranks the measurements of a case by time.
#pragma once

#include <string>

#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// The algorithm's name, without its options.
std::string structure_of(const Measurement& measurement);

/// Whether the measurement has a time.
bool is_timed(const Measurement& measurement);

/// The median of its rounds in milliseconds, or the estimate if it was skipped; infinite if neither is known.
double time_of(const Measurement& measurement);

/// The fastest measurement of the case; null if none was timed.
const Measurement* fastest_of(const CaseResult& result);

/// The fastest measurement of a kind; null if none was timed.
const Measurement* fastest_of_kind(const CaseResult& result, AlgorithmKind kind);

/// Broadside's fastest algorithm: other than auto, which uses one of the others, unless auto is the only one.
/// Null if none was timed.
const Measurement* best_own_of(const CaseResult& result);

/// The fastest auto, with any options; null if none was timed.
const Measurement* auto_of(const CaseResult& result);

/// "uniform, 2D, 1,000 boxes".
std::string name_of(const Case& measured);

/// "uniform, 2D, 1,000 boxes, 10 % moving", if boxes move.
std::string whole_name_of(const Case& measured);

}  // namespace broadside::lab
