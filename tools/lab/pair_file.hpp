// Pairs as files: CSV, or a NumPy array of n x 2 numbers.
#pragma once

#include <array>
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

/// The format of this name, csv or npy, or, where `name` is empty, the one that a path's extension names; CSV
/// for what is_written_directly() and has none. Throws FileError.
PairFormat pair_format_of(const std::filesystem::path& path, std::string_view name = {});

/// The users' ids of the boxes of a pair's left and right side, by the boxes' numbers; null: the numbers
/// themselves are written.
struct PairIds {
  const std::vector<std::string>* left = nullptr;
  const std::vector<std::string>* right = nullptr;
};

/// Writes pairs to a stream, as they come, and keeps none; but for NumPy's format where the stream cannot be
/// moved back to the array's header, as in a pipe.
class PairFile {
 public:
  /// Begins the file. The stream outlives this object; the caller checks it. `is_between`
  /// says that pairs are of a left and a right set, which the columns are then called. Ids, which outlive
  /// this object, are for CSV alone.
  PairFile(std::ostream& stream, PairFormat format, bool is_between, PairIds ids = {},
           bool has_large_numbers = false);

  void write(std::span<const Pair> pairs);

  /// Pairs of numbers beyond 32 bits: all that a file with `has_large_numbers` takes, and no other.
  void write(std::span<const std::array<std::uint64_t, 2>> pairs);

  /// After the last pair.
  void finish();

 private:
  void write_text();

  std::ostream& stream_;
  PairIds ids_;
  std::string text_;  // CSV that is not yet written
  std::optional<NpyArrayWriter> array_;
};

}  // namespace broadside::lab
