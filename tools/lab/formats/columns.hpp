// The meaning of a table's columns by their names: the one table of names.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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
  bottom,      ///< of y; whether it is the minimum depends on the direction in which y grows
  top,
  begin,  ///< of an interval, which is on x
  end,
  zeroth,
  first,
  second,
  third
};
constexpr std::size_t roles = 15;

struct Meaning {
  Role role;
  int axis;
};

/// The meaning of a name, in any spelling; nothing if it has none.
std::optional<Meaning> meaning_of(std::string_view name);

/// Of what two columns the bounds on an axis are made.
enum class BoundsForm : std::uint8_t {
  min_max,
  min_size,
  centre_size,
  centre_half_size,
  centre_radius,  ///< the second is BoxColumns::radius, for all axes
  point,          ///< the first alone
  bottom_top      ///< minimum and maximum, or the reverse: the data decide, see settle_top()
};

/// The bounds that two values of a form are, computed in double.
inline std::pair<double, double> bounds_of(BoundsForm form, double first, double second) noexcept {
  switch (form) {
    case BoundsForm::min_max:
    case BoundsForm::bottom_top:
      return {first, second};
    case BoundsForm::min_size:
      return {first, first + second};
    case BoundsForm::centre_size:
      return {first - second / 2, first + second / 2};
    case BoundsForm::centre_half_size:
    case BoundsForm::centre_radius:
      return {first - second, first + second};
    case BoundsForm::point:
      return {first, first};
  }
  return {first, second};
}

/// Whether bounds of a form have to be computed.
constexpr bool computes_bounds(BoundsForm form) noexcept {
  return form != BoundsForm::min_max && form != BoundsForm::bottom_top && form != BoundsForm::point;
}

/// The columns of a table.
struct BoxColumns {
  /// Places of values in a row; on axis a, the first and second value of its form are at first + a and
  /// second + a.
  static constexpr int ignored = -1;
  static constexpr int frame = 0;
  static constexpr int box = 1;
  static constexpr int first = 2;
  static constexpr int second = 5;
  static constexpr int radius = 8;
  static constexpr std::size_t places_of_a_row = 9;
  // Texts, which are no values.
  static constexpr int id = 9;         ///< to be shown to the user
  static constexpr int track = 10;     ///< that tells which box of a frame is which of the next
  static constexpr int geometry = 11;  ///< well-known text, or the bounds in one field

  std::vector<std::string> names{};  ///< of each column, from left to right
  std::vector<int> places{};         ///< of each column's value in a row, or `ignored`
  int dimension = 2;
  bool has_frames = false;
  /// Each frame lists the boxes that are present, by an id. Without a column of ids, the boxes of each frame
  /// are numbered anew.
  bool has_tracks = false;
  bool has_geometry =
      false;  ///< a text instead of columns of bounds; its dimension is known once one is read
  std::array<BoundsForm, 3> forms{};
  /// For bounds in one field: min_max ("xyxy"), min_size ("xywh") or centre_size ("cxcywh").
  BoundsForm geometry_form = BoundsForm::min_max;

  /// Whether bounds have to be computed.
  bool is_computed() const noexcept;

  /// The bounds on an axis that the values of a row make.
  std::pair<double, double> bounds(std::span<const double, places_of_a_row> values,
                                   std::size_t axis) const noexcept {
    const bool has_radius = forms[axis] == BoundsForm::centre_radius;
    return bounds_of(forms[axis], values[static_cast<std::size_t>(first) + axis],
                     values[has_radius ? std::size_t{radius} : static_cast<std::size_t>(second) + axis]);
  }

  /// The names of the columns that are not ignored, with commas between.
  std::string wanted() const;
};

/// Finds the columns with known names, in any order; docs/formats.md lists the names. CSV, NumPy, Parquet,
/// data frames and Arrow share this table. Returns the problem with the columns, or an empty text.
/// `are_chosen`: the user named the columns, so x,y with w,h is a corner. In a file, x,y may be a centre, and
/// is refused.
std::string resolve(std::span<const std::string_view> names, BoxColumns& columns, bool are_chosen = false);

/// Turns `bottom` and `top` into minimum and maximum. `top_is_min` says that a row's top is less than its
/// bottom: y grows downwards, as on a screen.
void settle_top(BoxColumns& columns, bool top_is_min);

/// A name without what people spell differently: capitals, blanks, `_`, `-` and `.`.
std::string plain(std::string_view name);

/// Whether a name, or one of its other spellings, is that of a known column.
bool is_column_name(std::string_view name);

/// Whether a name is that of a column of geometries as text, or of bounds in one field.
bool is_geometry_name(std::string_view name);

/// Columns of numbers without names: 4 or 6, minima and then maxima. Returns the fault, if any.
std::string positional(std::size_t count, BoxColumns& columns);

/// Other meanings of columns, as lists for --columns: for the columns of a table, for rows of `count` numbers
/// without names, and for names in which x,y may be a corner or a centre.
std::vector<std::string> other_meanings(const BoxColumns& columns);
std::vector<std::string> unnamed_meanings(std::size_t count);
std::vector<std::string> corner_or_centre(std::span<const std::string_view> names);

}  // namespace broadside::lab::readers
