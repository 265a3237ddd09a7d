// Specs that set an algorithm's tunables to their most difficult values.
#pragma once

#include <vector>

#include "broadside/algorithm.hpp"

#include "law_case.hpp"

namespace broadside::laws {

/// One spec for each tunable and value: the ends of its range, each choice, and numbers of every magnitude in
/// between. Values that the algorithm refuses in this dimension are left out.
std::vector<Spec> strained_specs(const LawCase& law_case);

}  // namespace broadside::laws
