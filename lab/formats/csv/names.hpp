// Names that people give to a table's columns, and what each says of an axis.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace broadside::lab::readers {

/// What a column says of an axis. `position` leaves open of what; the numbered ones are minimum and maximum,
/// counted from 0 or from 1.
enum class Role : std::uint8_t {
  min,
  max,
  centre,
  size,
  half_size,
  position,
  geographic,  ///< a position too, but other columns may have one in other units
  zeroth,
  first,
  second,
  third
};
constexpr std::size_t roles = 11;

struct Meaning {
  Role role;
  int axis;
};

/// The meaning of a name, in any spelling; nothing if it has none.
std::optional<Meaning> meaning_of(std::string_view name);

}  // namespace broadside::lab::readers
