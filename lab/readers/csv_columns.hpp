// What the columns of a table mean, by the names that people give them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace broadside::lab::readers {

/// Of what two columns the bounds on an axis are made.
enum class BoundsForm : std::uint8_t { min_max, min_size, centre_size, centre_half_size };

/// The bounds that two values of a form are, computed in double.
inline std::pair<double, double> bounds_of(BoundsForm form, double first, double second) noexcept {
  switch (form) {
    case BoundsForm::min_max:
      return {first, second};
    case BoundsForm::min_size:
      return {first, first + second};
    case BoundsForm::centre_size:
      return {first - second / 2, first + second / 2};
    case BoundsForm::centre_half_size:
      return {first - second, first + second};
  }
  return {first, second};
}

/// The columns of a table.
struct CsvColumns {
  /// Places of values in a row; on axis a, the first and second value of its form are at first + a and
  /// second + a.
  static constexpr int ignored = -1;
  static constexpr int frame = 0;
  static constexpr int box = 1;
  static constexpr int first = 2;
  static constexpr int second = 5;
  static constexpr std::size_t places_of_a_row = 8;

  std::vector<std::string> names{};  ///< of each column, from left to right
  std::vector<int> places{};         ///< of each column's value in a row, or `ignored`
  int dimension = 2;
  bool has_frames = false;
  std::array<BoundsForm, 3> forms{};

  /// Whether bounds have to be computed.
  bool is_computed() const noexcept;

  /// The names of the columns that are not ignored, with commas between.
  std::string wanted() const;
};

/// Finds the columns that are known by their names, in whatever order; docs/formats.md has the list. Returns
/// what is wrong with them; nothing if they are fine.
std::string resolve(std::span<const std::string_view> names, CsvColumns& columns);

/// Whether a name, or one of its other spellings, is that of a known column.
bool is_column_name(std::string_view name);

/// What the columns of numbers without names are: 4 or 6, minima and then maxima. Returns what is wrong.
std::string positional(std::size_t count, CsvColumns& columns);

}  // namespace broadside::lab::readers
