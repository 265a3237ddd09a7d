// Refuses boxes that no algorithm may see, before anything has changed.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "broadside/box.hpp"

namespace broadside::core {

/// Throws InvalidInput with the box's values, which `name` goes before.
template <int D, typename Real>
[[noreturn]] void refuse_box(const Box<D, Real>& box, std::size_t index, const std::string& name);

/// Throws InvalidInput, naming `index` and the box's values, unless `box` is present or absent.
template <int D, typename Real>
void check_box(const Box<D, Real>& box, std::size_t index);

/// Checks the boxes from place `from` on as check_box does, in their order, and returns how many of them are
/// absent. One pass.
template <int D, typename Real>
std::size_t check_boxes(std::span<const Box<D, Real>> boxes, std::size_t from = 0);

/// Throws InvalidInput if there are more boxes than ids.
void check_count(std::size_t count);

}  // namespace broadside::core
