// The types of NumPy's numbers, and how each is read from its bytes.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

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

}  // namespace broadside::lab::readers
