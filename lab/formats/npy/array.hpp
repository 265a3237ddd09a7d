// Writes NumPy arrays (.npy, format 1.0; numpy.lib.format): rows of numbers, however many come.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <span>

#include "lab/formats/late_header.hpp"

namespace broadside::lab {

/// Writes an array of shape (rows, columns) in C order, row after row; the number of rows is counted and need
/// not be known before. Pairs, say:
///
///   NpyArrayWriter<std::uint32_t> array(stream, 2);
///   for (...) array.write(std::array{index(pair.first), index(pair.second)});
///   array.finish();
///
/// Memory: a small buffer; the whole array where the stream cannot go back, as in a pipe or standard output,
/// because its header comes first and says how many rows there are. The caller checks the
/// stream. One thread at a time. For Value = std::uint32_t, std::uint64_t, float and double.
template <typename Value>
class NpyArrayWriter {
 public:
  /// Begins an array where the stream stands; the stream must outlive the writer.
  NpyArrayWriter(std::ostream& stream, std::size_t columns);

  /// Takes whole rows, one after the other: a multiple of `columns` values.
  void write(std::span<const Value> values);

  /// Called once, after the last row; without it there is no array.
  void finish();

 private:
  void flush();

  LateHeader file_;
  std::size_t columns_;
  std::uint64_t values_ = 0;
  std::string buffer_;
};

}  // namespace broadside::lab
