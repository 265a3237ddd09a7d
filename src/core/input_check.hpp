// Rejects invalid boxes before anything has changed.
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

/// The box as text, such as "min (0, 0) and max (1, 2.5)", with enough digits to tell any two numbers apart.
template <int D, typename Real>
std::string text_of(const Box<D, Real>& box);

/// The message of an exception for a rejected box: `name`, its values, and what is expected. Mentions the
/// absent box only if `may_be_absent`.
template <int D, typename Real>
std::string fault_of(const Box<D, Real>& box, const std::string& name, bool may_be_absent);

/// Throws InvalidInput, naming `index` and the box's values, unless `box` is present or absent. `which` goes
/// before "box", as in "left box 3".
template <int D, typename Real>
void check_box(const Box<D, Real>& box, std::size_t index, const char* which = "");

/// Checks the boxes from index `from` on as check_box() does, in order and in one pass. Returns how many of
/// them are absent. Quarantined invalid boxes count as absent.
template <int D, typename Real>
std::size_t check_boxes(std::span<const Box<D, Real>> boxes, std::size_t from = 0,
                        BadInput bad_input = BadInput::reject, const char* which = "");

/// Throws InvalidFrame if there are more boxes than ids.
void check_count(std::size_t count);

/// Whether a frame that follows one of `known` boxes has as many, and lists each as changed in ascending
/// order: the usual list where all boxes move.
template <int D, typename Real>
bool is_whole(const Frame<D, Real>& frame, std::size_t known);

/// Checks a frame that follows one of `known` boxes. Throws InvalidFrame, or InvalidInput for a box. Checks
/// the listed boxes and the new ones from index `known` on, or every box if `checks_all`. The exception names
/// the first invalid box, whatever the order of the list. `lists_all`: is_whole() holds.
template <int D, typename Real>
void check_frame(const Frame<D, Real>& frame, std::size_t known, bool checks_all,
                 BadInput bad_input = BadInput::reject, bool lists_all = false);

}  // namespace broadside::core
