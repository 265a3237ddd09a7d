// Boxes within enlarged ones: which of them can stay, and the others enlarged anew.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "broadside/box.hpp"

#include "core/margins.hpp"

namespace broadside::kernels {

/// Looks for the first box that is not present or for which the box in the same place of `kept` cannot stay:
/// see Margins::keeps(). Looks at the first `count` boxes; the spans may be longer. Returns how many come
/// before that box, or fewer: the boxes from there on are yet to be tested one by one.
template <int D, typename Real>
std::size_t count_kept(std::span<const Box<D, Real>> kept, std::span<const Box<D, Real>> boxes,
                       std::size_t count, const core::Margins<D, Real>& margins);

/// Enlarges the boxes for which `kept` cannot stay, as Margins::enlarged() does without a velocity, and
/// writes their places to `left`, which has room for all. Returns how many there are. All boxes must be
/// present.
template <int D, typename Real>
std::size_t enlarge_left(std::span<Box<D, Real>> kept, std::span<const Box<D, Real>> boxes,
                         const core::Margins<D, Real>& margins, std::uint32_t* left);

}  // namespace broadside::kernels
