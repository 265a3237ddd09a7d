// The inputs of a case.
#pragma once

#include <span>
#include <type_traits>

#include "broadside/history.hpp"

namespace broadside::lab {

/// Inputs for a function that is told their dimension and precision.
template <int D, typename Real>
using Histories = std::type_identity_t<std::span<const History<D, Real>>>;

}  // namespace broadside::lab
