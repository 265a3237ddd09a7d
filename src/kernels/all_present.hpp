// Tests whether all boxes are present.
#pragma once

#include <span>

#include "broadside/box.hpp"

namespace broadside::kernels {

/// Whether is_present() holds for each box. Takes a fraction of a nanosecond a box.
template <int D, typename Real>
bool all_present(std::span<const Box<D, Real>> boxes);

}  // namespace broadside::kernels
