// Layouts of NumPy arrays.
#include "lab/formats/npy/layout.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/format.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab::readers {
namespace {

/// A float of half precision (IEEE 754's binary16).
struct Half {
  std::uint16_t bits;
};

double value_of(Half half) {
  const int exponent = half.bits >> 10 & 31;
  const int digits = half.bits & 1023;
  const double sign = (half.bits & 0x8000) != 0 ? -1 : 1;
  if (exponent == 31)
    return digits != 0 ? std::numeric_limits<double>::quiet_NaN()
                       : sign * std::numeric_limits<double>::infinity();
  return sign * (exponent == 0 ? std::ldexp(digits, -24) : std::ldexp(1024 + digits, exponent - 25));
}

template <typename Number>
double value_of(Number number) {
  return static_cast<double>(number);
}

template <typename Number, bool IsSwapped>
Number number_at(const char* bytes) {
  std::array<char, sizeof(Number)> copy;
  std::memcpy(copy.data(), bytes, sizeof(Number));
  if constexpr (IsSwapped) std::reverse(copy.begin(), copy.end());
  return std::bit_cast<Number>(copy);
}

template <typename Number, bool IsSwapped>
bool load(const char* bytes, double& value) {
  const auto number = number_at<Number, IsSwapped>(bytes);
  value = value_of(number);
  if constexpr (std::is_integral_v<Number> && sizeof(Number) == 8) {
    constexpr Number most = Number{1} << 53;
    if constexpr (std::is_signed_v<Number>) return number <= most && number >= -most;
    return number <= most;
  }
  return true;
}

template <typename Number, bool IsSwapped>
std::string digits(const char* bytes) {
  if constexpr (std::is_integral_v<Number>) return fmt::to_string(number_at<Number, IsSwapped>(bytes));
  return {};
}

template <typename Number>
NpyType type_of(bool is_swapped) {
  return {.bytes = sizeof(Number),
          .is_held_by_float = std::is_same_v<Number, float> || std::is_same_v<Number, Half>,
          .load = is_swapped ? load<Number, true> : load<Number, false>,
          .digits = is_swapped ? digits<Number, true> : digits<Number, false>};
}

constexpr std::string_view known_types =
    "floats or integers: f2, f4, f8, i1 to i8 or u1 to u8, with '<' or '>' before it";

/// Throws FileError unless the rows that a header claims are there, no more and no less.
void check_size(std::uint64_t rows, std::size_t columns, std::size_t row_bytes, std::size_t bytes,
                const std::string& name) {
  // Compared as numbers of rows: in bytes, the claim may be more than 64 bits can say.
  if (row_bytes > 0 && bytes % row_bytes == 0 && bytes / row_bytes == rows) return;
  throw FileError(
      fmt::format("{}: has {} bytes behind its header and claims {} rows of {}; expected {} bytes a row",
                  name, bytes, rows, columns, row_bytes));
}

NpyLayout layout_of_numbers(const NpyHeader& header, std::size_t bytes, const std::string& name) {
  const std::vector<std::uint64_t>& shape = header.shape;
  const bool is_row = shape.size() == 2 && (shape[1] == 4 || shape[1] == 6);
  const bool is_corners = shape.size() == 3 && shape[1] == 2 && (shape[2] == 2 || shape[2] == 3);
  if (!is_row && !is_corners)
    throw FileError(fmt::format(
        "{}: shape ({}); expected (n, 4) or (n, 2, 2), minima and then maxima, or (n, 6) or (n, 2, 3) in 3D",
        name, fmt::join(shape, ", ")));
  const std::optional<NpyType> type = npy_type_of(header.type);
  if (!type || type->load == nullptr)
    throw FileError(
        fmt::format("{}: numbers of type {}; expected {}", name, shown(header.type, 20), known_types));
  const auto dimension = static_cast<std::size_t>(is_row ? shape[1] / 2 : shape[2]);
  check_size(shape[0], 2 * dimension, 2 * dimension * type->bytes, bytes, name);
  NpyLayout layout{.dimension = static_cast<int>(dimension),
                   .precision = type->is_held_by_float ? Precision::float32 : Precision::float64,
                   .rows = static_cast<std::size_t>(shape[0])};
  const std::size_t number = type->bytes;
  layout.row_step = header.is_column_major ? number : 2 * dimension * number;
  for (std::size_t axis = 0; axis < dimension; ++axis) {
    // By columns, the last index is the slowest: of (n, 2, D) a corner's coordinates are 2 n numbers apart.
    const std::size_t first = header.is_column_major && is_corners ? 2 * axis : axis;
    const std::size_t second = header.is_column_major && is_corners ? 2 * axis + 1 : dimension + axis;
    const std::size_t step = header.is_column_major ? layout.rows * number : number;
    layout.first[axis] = {first * step, *type};
    layout.second[axis] = {second * step, *type};
  }
  return layout;
}

/// The values of a structured array's row by name, where a field 'min' of two values gives min_x and min_y.
struct NamedColumns {
  std::vector<std::string> names;
  std::vector<NpyColumn> columns;
  std::vector<std::string> unread;  // fields of other shapes
  std::size_t row_bytes = 0;
};

NamedColumns named_columns(const NpyHeader& header, const std::string& name) {
  NamedColumns named;
  for (const NpyField& field : header.fields) {
    const std::optional<NpyType> type = npy_type_of(field.type);
    if (!type)
      throw FileError(fmt::format("{}: field {} is of type {}; expected {}", name, shown(field.name, 40),
                                  shown(field.type, 20), known_types));
    std::size_t count = 1;
    for (const std::uint64_t size : field.shape) {
      constexpr std::size_t most_bytes = std::size_t{1} << 32;
      if (size > most_bytes || count * size * type->bytes > most_bytes)
        throw FileError(fmt::format("{}: field {} has the shape ({}); expected at most {} bytes", name,
                                    shown(field.name, 40), fmt::join(field.shape, ", "), most_bytes));
      count *= static_cast<std::size_t>(size);
    }
    const auto add = [&](std::string column, std::size_t offset) {
      named.names.push_back(std::move(column));
      named.columns.push_back({offset, *type});
    };
    if (field.shape.empty()) {
      add(field.name, named.row_bytes);
    } else if (field.shape.size() == 1 && (count == 2 || count == 3)) {
      for (std::size_t axis = 0; axis < count; ++axis)
        add(fmt::format("{}_{}", field.name, "xyz"[axis]), named.row_bytes + axis * type->bytes);
    } else {
      named.unread.push_back(field.name);
    }
    named.row_bytes += count * type->bytes;
  }
  return named;
}

NpyLayout layout_of_fields(const NpyHeader& header, std::size_t bytes, const std::string& name) {
  const NamedColumns named = named_columns(header, name);
  const auto refuse = [&](std::string_view found, std::string_view expected) {
    throw FileError(fmt::format("{}: fields {}: {}; expected {}", name,
                                plainly(fmt::to_string(fmt::join(named.names, ", "))), found, expected));
  };
  if (header.shape.size() != 1)
    refuse(fmt::format("in an array of shape ({})", fmt::join(header.shape, ", ")), "shape (n,)");
  BoxColumns columns;
  const std::string problem =
      resolve(std::vector<std::string_view>(named.names.begin(), named.names.end()), columns);
  if (columns.has_frames || columns.has_tracks)
    refuse("several frames", "one; as CSV or as a trace, boxes can move");
  if (columns.has_geometry) refuse("a geometry as text", "bounds in numbers");
  if (!problem.empty()) refuse(problem, "names such as min_x, min_y, max_x and max_y");
  check_size(header.shape[0], named.names.size(), named.row_bytes, bytes, name);
  NpyLayout layout{.dimension = columns.dimension,
                   .precision = columns.is_computed() ? Precision::float64 : Precision::float32,
                   .rows = static_cast<std::size_t>(header.shape[0]),
                   .row_step = named.row_bytes,
                   .forms = columns.forms,
                   .unread = named.unread};
  for (std::size_t i = 0; i < named.columns.size(); ++i) {
    const int place = columns.places[i];
    if (place == BoxColumns::ignored || place == BoxColumns::id) {
      layout.unread.push_back(named.names[i]);
      continue;
    }
    const NpyColumn& column = named.columns[i];
    if (column.type.load == nullptr)
      refuse(fmt::format("{} is no number", shown(named.names[i], 40)), known_types);
    if (!column.type.is_held_by_float) layout.precision = Precision::float64;
    if (place == BoxColumns::radius) {
      layout.second.fill(column);
    } else if (place < BoxColumns::second) {
      layout.first[static_cast<std::size_t>(place - BoxColumns::first)] = column;
    } else {
      layout.second[static_cast<std::size_t>(place - BoxColumns::second)] = column;
    }
  }
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(columns.dimension); ++axis) {
    if (columns.forms[axis] == BoundsForm::point) layout.second[axis] = layout.first[axis];
  }
  return layout;
}

}  // namespace

std::optional<NpyType> npy_type_of(std::string_view name) {
  const char order = name.empty() ? '\0' : name.front();
  if (name.size() < 3 || std::string_view("<>=|").find(order) == std::string_view::npos) return std::nullopt;
  name.remove_prefix(1);
  const bool is_swapped = order == (std::endian::native == std::endian::little ? '>' : '<');
  // NumPy gives no order to a single byte, and only to that.
  if (order != '|') {
    if (name == "f2") return type_of<Half>(is_swapped);
    if (name == "f4") return type_of<float>(is_swapped);
    if (name == "f8") return type_of<double>(is_swapped);
    if (name == "i2") return type_of<std::int16_t>(is_swapped);
    if (name == "i4") return type_of<std::int32_t>(is_swapped);
    if (name == "i8") return type_of<std::int64_t>(is_swapped);
    if (name == "u2") return type_of<std::uint16_t>(is_swapped);
    if (name == "u4") return type_of<std::uint32_t>(is_swapped);
    if (name == "u8") return type_of<std::uint64_t>(is_swapped);
  }
  if (name == "i1") return type_of<std::int8_t>(is_swapped);
  if (name == "u1") return type_of<std::uint8_t>(is_swapped);
  // No numbers here, but of a known size: truth, complex numbers, times, bytes, text (of 4 bytes a
  // character).
  const char kind = name.front();
  if (std::string_view("bcfmMSUV").find(kind) == std::string_view::npos) return std::nullopt;
  std::uint32_t size = 0;
  const char* const end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(name.data() + 1, end, size);
  if (error != std::errc() || (rest != end && *rest != '[')) return std::nullopt;
  return NpyType{.bytes = std::size_t{size} * (kind == 'U' ? 4 : 1)};
}

NpyLayout npy_layout(const NpyHeader& header, std::size_t bytes, const std::string& name) {
  return header.is_structured ? layout_of_fields(header, bytes, name)
                              : layout_of_numbers(header, bytes, name);
}

}  // namespace broadside::lab::readers
