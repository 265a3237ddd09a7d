// The header of a PLY file: which elements it holds, and which numbers each of them is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace broadside::lab {

/// How the numbers behind a PLY header are written.
enum class PlyEncoding : std::uint8_t { text, little_endian, big_endian };

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct PlyProperty {
  std::string_view name;
  PlyType type = PlyType::float32;
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  // of a list's length, which stands before it
};

struct PlyElement {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::text;
  std::vector<PlyElement> elements;
  std::size_t size = 0;  ///< bytes, with the line end behind "end_header"
};

/// Reads the header at the beginning of a file; the names in it point into `bytes`. Throws FileError naming
/// the line, also if more elements are claimed than the bytes behind the header can hold.
PlyHeader read_ply_header(std::string_view bytes, const std::string& file);

/// The bytes of a number in binary.
constexpr std::size_t bytes_of(PlyType type) noexcept {
  constexpr std::array<std::uint8_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

}  // namespace broadside::lab
