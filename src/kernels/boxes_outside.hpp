// Selects the boxes that are not within their enlarged boxes.
#pragma once

#include <cstddef>
#include <span>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::kernels {

/// Writes the ids, ascending, of the boxes that are not within the box of the same index in `enlarged`. An
/// absent box is within every box. Returns their number. `outside` must have room for all.
template <int D, typename Real>
std::size_t select_outside(std::span<const Box<D, Real>> boxes, std::span<const Box<D, Real>> enlarged,
                           BoxId* outside);

}  // namespace broadside::kernels
