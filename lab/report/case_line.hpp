// A comparison as a line a case.
#pragma once

#include <string>

#include "lab/measure/compare.hpp"

namespace broadside::lab {

/// The names of the columns of case_line().
std::string case_line_heading();

/// One case: the best of our own, auto's ratio to it, the fastest peer, how many times as fast our best is,
/// and how the pairs were verified. "-" stands for what was not in the comparison. Ends with a line's end.
std::string case_line(const CaseResult& result);

}  // namespace broadside::lab
