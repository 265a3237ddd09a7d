// Specs that give an algorithm's tunables the values that are hardest on it.
#pragma once

#include <vector>

#include "broadside/algorithm.hpp"

#include "law_case.hpp"

namespace broadside::laws {

/// One spec for each tunable and value: the ends of its range, each choice, and numbers of every magnitude
/// between. Values that the algorithm refuses in this dimension are left out.
std::vector<Spec> strained_specs(const LawCase& law_case);

}  // namespace broadside::laws
