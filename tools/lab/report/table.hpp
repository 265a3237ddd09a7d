// A comparison as text: tables, one line per case, and a summary.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "lab/measure/compare.hpp"
#include "lab/measure/measurement.hpp"
#include "lab/report/fold.hpp"

namespace broadside::lab {

/// The interval's ends to two significant digits: "17 to 19". "level" if it contains 1 and stays within a
/// factor of 1.5 of it; "-" if there is no interval.
std::string interval_text(const std::optional<Interval>& interval);

/// A ratio and its interval: "18 (17 to 19)", "1.0 (level)", "5,100".
std::string ratio_text(double ratio, const std::optional<Interval>& interval);

/// The weakest evidence for the results: "by definition"; empty if none was verified.
std::string evidence_of(const CaseResult& result);

/// evidence_of(), or how many FAILED; "nothing verified" if everything was skipped.
std::string verdict_of(const CaseResult& result);

/// The column headings for case_line().
std::string case_line_heading(std::size_t width = any_width);

/// One case: the best of our own algorithms, auto's ratio to it, the fastest peer, how many times as fast our
/// best is, and how the pairs were verified. "-" stands for an algorithm that is not in the comparison. Ends
/// with a newline. Columns that do not fit in `width` follow on
/// further lines, at the same places in each case.
std::string case_line(const CaseResult& result, std::size_t width = any_width);

/// One case: a heading, then a line for each algorithm, the fastest first and algorithms without a time last.
/// If the lower bound (floor.hpp) was timed, its line ends the table, and each time is also given as a
/// multiple of it. Plain text, folded to `width`.
std::string table_of(const CaseResult& result, std::size_t width = any_width);

/// A summary of all cases: each algorithm's ratio to the fastest as a geometric mean, how many measurements
/// there were and whether all were verified, each failure with its first divergence, and the cases that could
/// not be compared. Folded to `width`.
std::string summary_of(const Comparison& comparison, std::size_t width = any_width);

}  // namespace broadside::lab
