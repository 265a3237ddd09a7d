// Writes NumPy arrays: a header of fixed size, then the numbers as they are in memory.
#include "lab/formats/npy/npy_array_writer.hpp"

#include <bit>

#include <fmt/format.h>

namespace broadside::lab {
namespace {

// NumPy aligns the numbers to 64 bytes; the longest header does not fit into 64.
constexpr std::size_t header_bytes = 128;

std::string header_of(std::string_view type, std::uint64_t rows, std::size_t columns) {
  // In this machine's byte order, which the header states.
  const std::string text =
      fmt::format("{{'descr': '{}{}', 'fortran_order': False, 'shape': ({}, {}), }}",
                  std::endian::native == std::endian::little ? '<' : '>', type, rows, columns);
  std::string bytes("\x93NUMPY\x01\0\x76\0", 10);
  bytes += text;
  bytes.resize(header_bytes - 1, ' ');
  return bytes + '\n';
}

}  // namespace

NpyArrayWriter::NpyArrayWriter(std::ostream& stream, std::string_view type, std::size_t columns)
    : stream_(stream), type_(type), columns_(columns), begin_(stream.tellp()) {
  if (can_go_back()) write_bytes(std::string(header_bytes, '\0'));
}

void NpyArrayWriter::finish() {
  const std::string header = header_of(type_, rows_, columns_);
  if (!can_go_back()) {
    stream_ << header << kept_;
    std::string().swap(kept_);
    return;
  }
  const std::ostream::pos_type end = stream_.tellp();
  stream_.seekp(begin_) << header;
  stream_.seekp(end);
}

void NpyArrayWriter::write_bytes(std::string_view bytes) {
  if (can_go_back())
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  else
    kept_ += bytes;
}

}  // namespace broadside::lab
