// Pair files: CSV, or a NumPy array of n x 2 numbers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/pair.hpp"

#include "lab/formats/npy/npy_array_writer.hpp"

namespace broadside::lab {

enum class PairFormat : std::uint8_t { csv, npy };

/// The format called `name`, csv or npy. If `name` is empty, the format of the path's extension; CSV if the
/// path has none and is_written_directly(). Throws FileError.
PairFormat pair_format_of(const std::filesystem::path& path, std::string_view name = {});

/// The users' ids of the boxes on a pair's left and right side, by box number; null: writes the numbers
/// themselves.
struct PairIds {
  const std::vector<std::string>* left = nullptr;
  const std::vector<std::string>* right = nullptr;
};

/// Writes pairs to a stream as they come and keeps none in memory. Exception: the NumPy format on a stream
/// that cannot seek back to the array's header, such as a pipe.
class PairFile {
 public:
  /// Begins the file. The stream must outlive this object; the caller checks it for errors. With
  /// `is_between`, pairs are of a left and a right set, and the columns are named so. CSV alone takes ids,
  /// which must outlive this object. For rows other than pairs, `header` names the columns, and `columns` is
  /// their number.
  PairFile(std::ostream& stream, PairFormat format, bool is_between, PairIds ids = {},
           bool has_large_numbers = false, std::string_view header = {}, std::size_t columns = 2);

  void write(std::span<const Pair> pairs);

  /// Writes pairs of numbers beyond 32 bits. Files with `has_large_numbers` accept only these; other files do
  /// not accept them.
  void write(std::span<const std::array<std::uint64_t, 2>> pairs);

  /// Writes rows of three columns: the frame's number, and a pair in it.
  void write(std::size_t frame, std::span<const Pair> pairs);

  /// Call after the last pair.
  void finish();

 private:
  void write_text();

  std::ostream& stream_;
  PairIds ids_;
  std::string text_;  // CSV not yet written
  std::optional<NpyArrayWriter> array_;
};

}  // namespace broadside::lab
