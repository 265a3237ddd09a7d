// Where the boxes of a NumPy array are in its bytes.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "lab/formats/csv/columns.hpp"
#include "lab/formats/frames.hpp"
#include "lab/formats/npy/header.hpp"
#include "lab/formats/npy/type.hpp"

namespace broadside::lab::readers {

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
