// Where the boxes of a NumPy array are in its bytes.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lab/formats/columns.hpp"
#include "lab/formats/frames.hpp"
#include "lab/formats/npy/header.hpp"

namespace broadside::lab::readers {

/// The type of a value in an array.
struct NpyType {
  std::size_t bytes = 0;
  bool is_held_by_float = false;  ///< float and half precision

  /// Reads a number as a double; false if a double does not hold it exactly, as integers beyond 2^53. Null
  /// for what is no number here, such as text.
  bool (*load)(const char* bytes, double& value) = nullptr;

  /// The digits of an integer.
  std::string (*digits)(const char* bytes) = nullptr;
};

/// The type that NumPy calls `name`, with its byte order, as "<f8"; nothing if its bytes are not known.
std::optional<NpyType> npy_type_of(std::string_view name);

/// A number in each row.
struct NpyColumn {
  std::size_t offset = 0;  ///< in bytes, from where the row begins
  NpyType type{};
};

/// The numbers that make a box of a row.
struct NpyLayout {
  int dimension = 2;
  Precision precision = Precision::float64;  ///< float if floats hold all numbers, and none is to be computed
  std::size_t rows = 0;
  std::size_t row_step = 0;  ///< bytes from where one row begins to the next
  std::array<BoundsForm, 3> forms{};
  std::array<NpyColumn, 3> first{};  ///< on each axis, the first and second value of its form
  std::array<NpyColumn, 3> second{};
  std::vector<std::string> unread{};  ///< the names of the fields that nothing is read from
};

/// The layout of an array of numbers, or of a structured array whose fields have the names that a table's
/// columns have. `bytes` is how many follow the header. Throws FileError, also if these are not as many as
/// the header claims; `name` is what errors call the file.
NpyLayout npy_layout(const NpyHeader& header, std::size_t bytes, const std::string& name);

}  // namespace broadside::lab::readers
