// Whether boxes have so many pairs that a measurement, which keeps them to be checked, would fill the
// machine.
#pragma once

#include "lab/verify/verify.hpp"

namespace broadside::lab {

/// Throws std::runtime_error where boxes have more than some 250,000,000 pairs (2 GB): about how many there
/// are shows in a sample.
template <int D, typename Real = float>
void check_pair_count(BoxSpan<D, Real> boxes);

}  // namespace broadside::lab
