// Shared by the functions that JavaScript calls: the memory that both sides read and write, exceptions as
// numbers, and the dimension of the boxes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/error.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"

#include "bindings/status_of_exception.hpp"
#include "core/dimensions.hpp"
#include "module/export.hpp"

namespace broadside::wasm {

/// What a call returns to JavaScript: addresses and counts; or, if the call failed, the place of the invalid
/// box, and the address and the length of the message.
inline std::array<std::uint32_t, 8> reply;

/// The coordinates of a query, as JavaScript writes them: a box, or points and directions, one after another.
inline std::array<float, 16> question;

/// Writes the exception in flight to `reply`, and returns its status.
broadside_status status_of_exception() noexcept;

/// Runs `body`, and turns an exception into a status.
template <typename Body>
broadside_status guarded(const Body& body) noexcept {
  try {
    body();
    return BROADSIDE_OK;
  } catch (...) {
    return status_of_exception();
  }
}

/// Writes to `reply` where the answer's array of this number is, and how many elements it has.
template <typename T>
void answer(std::span<const T> values, std::size_t number = 0) noexcept {
  reply[2 * number] = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(values.data()));
  reply[2 * number + 1] = static_cast<std::uint32_t>(values.size());
}

/// Boxes as JavaScript wrote them: the minima and then the maxima of each.
template <int D>
std::span<const Box<D>> boxes_at(const float* first, std::size_t count) noexcept {
  static_assert(sizeof(Box<D>) == 2 * D * sizeof(float));
  return {reinterpret_cast<const Box<D>*>(first), count};
}

/// Filters as JavaScript wrote them, six words each; none if the address is null.
inline std::span<const Filter> filters_at(const Filter* first, std::size_t count) noexcept {
  static_assert(sizeof(Filter) == 24 && offsetof(Filter, group) == 16 && offsetof(Filter, is_static) == 20);
  return {first, first == nullptr ? 0 : count};
}

/// The dimension of this module's boxes: each module has one.
inline constexpr int dimension = core::has_dimension<2> ? 2 : 3;
static_assert(core::has_dimension<2> != core::has_dimension<3>,
              "BROADSIDE_DIMENSIONS lists one for a module");

/// Makes an object that JavaScript holds by its address, and writes the address to `reply`.
template <typename Kept, typename... Arguments>
broadside_status make_kept(const Arguments&... arguments) noexcept {
  return guarded([&] {
    reply[0] = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(new Kept(arguments...)));
  });
}

}  // namespace broadside::wasm
