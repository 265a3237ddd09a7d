// Resolves the columns of a table by their names. The only table of column names.
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

/// The role of a column on an axis. `position` leaves open which point of the box it is; the numbered roles
/// are minimum and maximum, counted from 0 or from 1.
enum class Role : std::uint8_t {
  min,
  max,
  centre,
  size,
  half_size,
  position,
  geographic,  ///< also a position, but other columns may have positions in other units
  bottom,      ///< of y; whether it is the minimum depends on the direction in which y grows
  top,
  begin,  ///< of an interval on x
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

/// The meaning of a name, in any spelling; empty if it has none.
std::optional<Meaning> meaning_of(std::string_view name);

/// The two values that give the bounds on an axis.
enum class BoundsForm : std::uint8_t {
  min_max,
  min_size,
  centre_size,
  centre_half_size,
  centre_radius,  ///< the second one is BoxColumns::radius, the same for all axes
  point,          ///< only the first one
  flat,           ///< none: 0, on the y axis of intervals
  bottom_top      ///< minimum and maximum, or the reverse: settle_top() decides by the data
};

/// The bounds that two values give in a form, computed in double.
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
    case BoundsForm::flat:
      return {0, 0};
  }
  return {first, second};
}

/// Whether bounds in this form are computed rather than read.
constexpr bool computes_bounds(BoundsForm form) noexcept {
  return form != BoundsForm::min_max && form != BoundsForm::bottom_top && form != BoundsForm::point &&
         form != BoundsForm::flat;
}

/// The columns of a table.
struct BoxColumns {
  /// Places of values in a row. On axis a, the two values of its form are at first + a and second + a.
  static constexpr int ignored = -1;
  static constexpr int frame = 0;
  static constexpr int box = 1;
  static constexpr int first = 2;
  static constexpr int second = 5;
  static constexpr int radius = 8;
  static constexpr std::size_t places_of_a_row = 9;
  // Texts, not values.
  static constexpr int id = 9;         ///< shown to the user
  static constexpr int track = 10;     ///< identifies a box across frames
  static constexpr int geometry = 11;  ///< well-known text, or the bounds in one field

  std::vector<std::string> names{};  ///< names of the columns, from left to right
  std::vector<int> places{};         ///< the place of each column's value in a row, or `ignored`
  int dimension = 2;
  bool has_frames = false;
  /// Each frame lists the present boxes by an id. Without a column of ids, boxes are numbered anew in each
  /// frame.
  bool has_tracks = false;
  bool has_geometry =
      false;  ///< a text instead of columns of bounds; its dimension is known once one has been read
  std::array<BoundsForm, 3> forms{};
  /// The order of bounds in one field: min_max ("xyxy"), min_size ("xywh") or centre_size ("cxcywh").
  BoundsForm geometry_form = BoundsForm::min_max;

  /// Whether any bounds are computed rather than read.
  bool is_computed() const noexcept;

  /// The bounds on an axis, from the values of a row.
  std::pair<double, double> bounds(std::span<const double, places_of_a_row> values,
                                   std::size_t axis) const noexcept {
    const bool has_radius = forms[axis] == BoundsForm::centre_radius;
    return bounds_of(forms[axis], values[static_cast<std::size_t>(first) + axis],
                     values[has_radius ? std::size_t{radius} : static_cast<std::size_t>(second) + axis]);
  }

  /// The names of the columns that are not ignored, separated by commas.
  std::string wanted() const;
};

/// Finds the columns with known names, in any order; docs/formats.md lists the names. CSV, NumPy, Parquet,
/// data frames and Arrow share this table. Returns the fault in the columns, or an empty text. `are_chosen`
/// says that the user named the columns: then x,y with w,h is a corner. In a file, x,y may also be a centre,
/// and is refused.
std::string resolve(std::span<const std::string_view> names, BoxColumns& columns, bool are_chosen = false);

/// Replaces `bottom` and `top` by minimum and maximum. `top_is_min` says that a row's top is less than its
/// bottom: y grows downwards, as on a screen.
void settle_top(BoxColumns& columns, bool top_is_min);

/// A name without differences in spelling: capitals, blanks, `_`, `-` and `.`.
std::string plain(std::string_view name);

/// Whether this is the name of a known column, in any spelling.
bool is_column_name(std::string_view name);

/// Whether a column of this name gives bounds, alone or with others.
bool gives_bounds(std::string_view name);

/// Whether this is the name of a column of geometries as text, or of bounds in one field.
bool is_geometry_name(std::string_view name);

/// Resolves columns of numbers without names: 4 or 6, first all minima, then all maxima. Returns the fault,
/// if any.
std::string positional(std::size_t count, BoxColumns& columns);

/// Alternative meanings of columns, as lists for --columns: for the columns of a table, for rows of `count`
/// numbers without names, and for names with which x,y may be a corner or a centre. Bounds that are named may
/// be exchanged, but are no sizes.
std::vector<std::string> other_meanings(const BoxColumns& columns, bool are_named);
std::vector<std::string> unnamed_meanings(std::size_t count);
std::vector<std::string> corner_or_centre(std::span<const std::string_view> names);

}  // namespace broadside::lab::readers
