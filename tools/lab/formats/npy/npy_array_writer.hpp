// Writes NumPy arrays (.npy, format 1.0; numpy.lib.format): rows of numbers, however many come.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <span>
#include <string>
#include <string_view>

namespace broadside::lab {

/// Writes an array of shape (rows, columns) in C order, row after row; the number of rows is counted and need
/// not be known before:
///
///   NpyArrayWriter array(stream, "u4", 2);
///   for (...) array.write(pairs);
///   array.finish();
///
/// Memory: none; the whole array where the stream cannot go back, as in a pipe or standard output, because
/// its header comes first and says how many rows there are. The caller checks the stream. One thread at a
/// time.
class NpyArrayWriter {
 public:
  /// Begins an array of "u4", "u8", "f4" or "f8" where the stream stands; the stream must outlive the writer.
  NpyArrayWriter(std::ostream& stream, std::string_view type, std::size_t columns);

  /// Takes rows, each the numbers of its columns as they are in memory.
  template <typename Row>
  void write(std::span<const Row> rows) {
    rows_ += rows.size();
    write_bytes({reinterpret_cast<const char*>(rows.data()), rows.size_bytes()});
  }

  /// Called once, after the last row; without it there is no array.
  void finish();

 private:
  void write_bytes(std::string_view bytes);
  bool can_go_back() const { return begin_ != std::ostream::pos_type(-1); }

  std::ostream& stream_;
  std::string type_;
  std::size_t columns_;
  std::uint64_t rows_ = 0;
  std::ostream::pos_type begin_;  // where the header goes; -1 where the stream cannot go back
  std::string kept_;              // the rows, where they must wait
};

}  // namespace broadside::lab
