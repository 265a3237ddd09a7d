// What the header of a NumPy array says (numpy.lib.format, versions 1.0 to 3.0).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace broadside::lab::readers {

/// The first bytes of a NumPy array.
constexpr std::string_view npy_magic = "\x93NUMPY";

/// A field of a structured array.
struct NpyField {
  std::string name;
  std::string type;
  std::vector<std::uint64_t> shape{};  ///< of the values that it has in each row; empty: it has one
};

struct NpyHeader {
  std::string type;  ///< of the numbers, with the byte order: "<f8"; empty where the array is structured
  bool is_structured = false;
  std::vector<NpyField>
      fields;  ///< of a structured array, in the order in which their bytes follow each other
  bool is_column_major = false;
  std::vector<std::uint64_t> shape;
  std::size_t bytes = 0;  ///< how many bytes it has; the numbers follow
};

/// Reads the header with which `bytes` begin; `name` is what errors call the file. Throws FileError. Memory:
/// no more than the header has bytes.
NpyHeader read_npy_header(std::string_view bytes, const std::string& name);

}  // namespace broadside::lab::readers
