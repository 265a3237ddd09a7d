// Writes NumPy arrays: a header of fixed size, and the numbers as they lie in memory.
#include "lab/formats/npy/array.hpp"

#include <bit>
#include <string>
#include <type_traits>

#include <fmt/format.h>

namespace broadside::lab {
namespace {

// NumPy aligns the numbers to 64 bytes; the longest header needs more than that.
constexpr std::size_t header_bytes = 128;
constexpr std::size_t buffer_bytes = std::size_t{1} << 16;

template <typename Value>
std::string header(std::uint64_t rows, std::size_t columns) {
  // In this machine's order, which the header names, so that nothing has to be turned around.
  const std::string text = fmt::format("{{'descr': '{}{}{}', 'fortran_order': False, 'shape': ({}, {}), }}",
                                       std::endian::native == std::endian::little ? '<' : '>',
                                       std::is_integral_v<Value> ? 'u' : 'f', sizeof(Value), rows, columns);
  constexpr std::size_t text_bytes = header_bytes - 10;
  std::string bytes = "\x93NUMPY\x01";
  bytes += '\0';
  bytes += static_cast<char>(text_bytes & 0xff);
  bytes += static_cast<char>(text_bytes >> 8);
  bytes += text;
  bytes.resize(header_bytes - 1, ' ');
  bytes += '\n';
  return bytes;
}

}  // namespace

template <typename Value>
NpyArrayWriter<Value>::NpyArrayWriter(std::ostream& stream, std::size_t columns)
    : file_(stream, header_bytes), columns_(columns) {
  buffer_.reserve(buffer_bytes);
}

template <typename Value>
void NpyArrayWriter<Value>::write(std::span<const Value> values) {
  values_ += values.size();
  const std::string_view bytes(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  if (buffer_.size() + bytes.size() > buffer_bytes) flush();
  if (bytes.size() > buffer_bytes)
    file_.write(bytes);
  else
    buffer_ += bytes;
}

template <typename Value>
void NpyArrayWriter<Value>::finish() {
  flush();
  file_.finish(header<Value>(values_ / columns_, columns_));
}

template <typename Value>
void NpyArrayWriter<Value>::flush() {
  file_.write(buffer_);
  buffer_.clear();
}

template class NpyArrayWriter<std::uint32_t>;
template class NpyArrayWriter<std::uint64_t>;
template class NpyArrayWriter<float>;
template class NpyArrayWriter<double>;

}  // namespace broadside::lab
