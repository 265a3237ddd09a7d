// Refuses boxes that no algorithm may see, before anything has changed.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "broadside/box.hpp"
#include "broadside/error.hpp"

namespace broadside::core {

/// Whether a box is neither present nor absent.
template <int D, typename Real>
constexpr bool is_invalid(const Box<D, Real>& box) noexcept {
  return !is_present(box) && !is_absent(box);
}

/// The message of an exception for a box that is refused: `name`, its values, and what is expected, of which
/// the absent box is one only if it `may_be_absent`.
template <int D, typename Real>
std::string fault_of(const Box<D, Real>& box, const std::string& name, bool may_be_absent);

/// Throws InvalidInput, naming `index` and the box's values, unless `box` is present or absent.
template <int D, typename Real>
void check_box(const Box<D, Real>& box, std::size_t index);

/// Checks the boxes from place `from` on as check_box does, in their order, and returns how many of them are
/// absent. One pass. Where invalid ones are quarantined they are counted with the absent ones.
template <int D, typename Real>
std::size_t check_boxes(std::span<const Box<D, Real>> boxes, std::size_t from = 0,
                        BadInput bad_input = BadInput::reject);

/// Throws InvalidFrame if there are more boxes than ids.
void check_count(std::size_t count);

}  // namespace broadside::core
