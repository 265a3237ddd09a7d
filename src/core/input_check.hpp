// Refuses boxes that no algorithm may see, before anything has changed.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "broadside/box.hpp"
#include "broadside/error.hpp"
#include "broadside/tracker.hpp"

namespace broadside::core {

/// Whether a box is neither present nor absent.
template <int D, typename Real>
constexpr bool is_invalid(const Box<D, Real>& box) noexcept {
  return !is_present(box) && !is_absent(box);
}

/// Such as "min (0, 0) and max (1, 2.5)", with as many digits as tell any two numbers apart.
template <int D, typename Real>
std::string text_of(const Box<D, Real>& box);

/// The message of an exception for a box that is refused: `name`, its values, and what is expected, of which
/// the absent box is one only if it `may_be_absent`.
template <int D, typename Real>
std::string fault_of(const Box<D, Real>& box, const std::string& name, bool may_be_absent);

/// Throws InvalidInput, naming `index` and the box's values, unless `box` is present or absent. `which` goes
/// before "box", as in "left box 3".
template <int D, typename Real>
void check_box(const Box<D, Real>& box, std::size_t index, const char* which = "");

/// Checks the boxes from place `from` on as check_box does, in their order, and returns how many of them are
/// absent. One pass. Where invalid ones are quarantined they are counted with the absent ones.
template <int D, typename Real>
std::size_t check_boxes(std::span<const Box<D, Real>> boxes, std::size_t from = 0,
                        BadInput bad_input = BadInput::reject, const char* which = "");

/// Throws InvalidFrame if there are more boxes than ids.
void check_count(std::size_t count);

/// Throws if anything is wrong with a frame after one of `known` boxes: InvalidFrame, or InvalidInput for a
/// box. One beyond those known is new and counts as listed, and every box does where it `checks_all`. The
/// first wrong one is named, whatever the order of the list.
template <int D, typename Real>
void check_frame(const Frame<D, Real>& frame, std::size_t known, bool checks_all,
                 BadInput bad_input = BadInput::reject);

}  // namespace broadside::core
