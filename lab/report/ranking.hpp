// Who is how fast in a case.
#pragma once

#include <optional>
#include <string>

#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// Whether it has a time.
bool is_timed(const Measurement& measurement);

/// The median in milliseconds, or what it is thought to be; infinite where nothing is known.
double time_of(const Measurement& measurement);

/// The best median of the case; 0 where nothing was timed.
double fastest_of(const CaseResult& result);

/// The fastest measurement of a kind; null where none was timed.
const Measurement* fastest_of_kind(const CaseResult& result, AlgorithmKind kind);

/// How many times as fast as the fastest peer our fastest algorithm is; empty where either is missing.
std::optional<double> lead_of(const CaseResult& result);

/// "1.52", and less digits from a hundred on.
std::string ratio_text(double ratio);

/// "uniform, 2D, 1,000 boxes".
std::string name_of(const Case& of);

}  // namespace broadside::lab
