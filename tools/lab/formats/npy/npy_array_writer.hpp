// Writes NumPy arrays (.npy, format 1.0; numpy.lib.format) of any number of rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <span>
#include <string>
#include <string_view>

namespace broadside::lab {

/// Writes an array of shape (rows, columns) in C order, row by row; the number of rows need not be known in
/// advance:
///
///   NpyArrayWriter array(stream, "u4", 2);
///   for (...) array.write(pairs);
///   array.finish();
///
/// Memory: none; the whole array if the stream cannot seek, as with a pipe or standard output, because the
/// header comes first and holds the number of rows. The caller checks the stream for errors. Use from one
/// thread at a time.
class NpyArrayWriter {
 public:
  /// Begins an array of "u4", "u8", "f4" or "f8" at the stream's position; the stream must outlive the
  /// writer.
  NpyArrayWriter(std::ostream& stream, std::string_view type, std::size_t columns);

  /// Writes rows, each the numbers of its columns as they are in memory.
  template <typename Row>
  void write(std::span<const Row> rows) {
    rows_ += rows.size();
    write_bytes({reinterpret_cast<const char*>(rows.data()), rows.size_bytes()});
  }

  /// Call once, after the last row; without it, no valid array is written.
  void finish();

 private:
  void write_bytes(std::string_view bytes);
  bool can_go_back() const { return begin_ != std::ostream::pos_type(-1); }

  std::ostream& stream_;
  std::string type_;
  std::size_t columns_;
  std::uint64_t rows_ = 0;
  std::ostream::pos_type begin_;  // position of the header; -1 if the stream cannot seek
  std::string kept_;              // the rows, if the stream cannot seek
};

}  // namespace broadside::lab
