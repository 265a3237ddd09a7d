// A comparison as text: tables, a line a case, and a summary.
#pragma once

#include <optional>
#include <string>

#include "lab/measure/compare.hpp"
#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// The interval's ends to two significant digits: "17 to 19"; "level" where it holds 1 and nothing further
/// from 1 than a factor of 1.5; "-" where there is none.
std::string interval_text(const std::optional<Interval>& interval);

/// A ratio and its interval: "18 (17 to 19)", "1.0 (level)", "5,100".
std::string ratio_text(double ratio, const std::optional<Interval>& interval);

/// How the results were verified, as Evidence has it, at the least: "by definition"; empty where none was.
std::string evidence_of(const CaseResult& result);

/// evidence_of(), or how many FAILED; "nothing verified" where everything was skipped.
std::string verdict_of(const CaseResult& result);

/// The names of the columns of case_line().
std::string case_line_heading();

/// One case: the best of our own, auto's ratio to it, the fastest peer, how many times as fast our best is,
/// and how the pairs were verified. "-" stands for what was not in the comparison. Ends with a line's end.
std::string case_line(const CaseResult& result);

/// One case: a line that says what it is, and a line for each algorithm, the fastest first, algorithms
/// without a time last. Where the floor was timed, its line ends the table, and each time is given in floors
/// as well. Plain text.
std::string table_of(const CaseResult& result);

/// What all cases come to: each algorithm's ratio to the fastest as a geometric mean, how many measurements
/// there were and whether all were verified, each failure with what diverged first, and what could not be
/// compared.
std::string summary_of(const Comparison& comparison);

}  // namespace broadside::lab
