// NumPy arrays as they are written, byte for byte, whether the stream can go back or not.
#include <array>
#include <bit>
#include <cstdint>
#include <sstream>
#include <streambuf>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "lab/formats/npy/npy_array_writer.hpp"

namespace broadside::lab {
namespace {

/// Takes bytes and cannot go back, like a pipe.
class PipeBuffer final : public std::streambuf {
 public:
  std::string bytes;

 protected:
  int_type overflow(int_type byte) override {
    bytes += traits_type::to_char_type(byte);
    return byte;
  }
};

std::string written_header(const std::string& descr, const std::string& shape) {
  std::string header("\x93NUMPY\x01\0\x76\0", 10);
  header += "{'descr': '" + descr + "', 'fortran_order': False, 'shape': (" + shape + "), }";
  header.resize(127, ' ');
  return header + '\n';
}

std::string bytes_of(const std::vector<std::uint32_t>& words) {
  return {reinterpret_cast<const char*>(words.data()), 4 * words.size()};
}

const std::string native = std::endian::native == std::endian::little ? "<" : ">";

using Words = std::vector<std::array<std::uint32_t, 2>>;

TEST(NpyArrayWriter, CountsItsRowsAndSaysThemInTheHeader) {
  std::ostringstream stream;
  stream << "before";
  NpyArrayWriter array(stream, "u4", 2);
  array.write(std::span<const std::array<std::uint32_t, 2>>(Words{{1, 2}}));
  array.write(std::span<const std::array<std::uint32_t, 2>>(Words{{3, 4}, {5, 4000000000}}));
  array.finish();
  stream << "after";
  EXPECT_EQ(stream.str(), "before" + written_header(native + "u4", "3, 2") +
                              bytes_of({1, 2, 3, 4, 5, 4000000000}) + "after");
}

TEST(NpyArrayWriter, WritesTheSameIntoAPipe) {
  PipeBuffer pipe;
  std::ostream stream(&pipe);
  NpyArrayWriter array(stream, "u4", 2);
  array.write(std::span<const std::array<std::uint32_t, 2>>(Words{{1, 2}}));
  array.finish();
  EXPECT_TRUE(stream);
  EXPECT_EQ(pipe.bytes, written_header(native + "u4", "1, 2") + bytes_of({1, 2}));
}

TEST(NpyArrayWriter, WritesAnArrayWithoutRows) {
  std::ostringstream floats;
  NpyArrayWriter(floats, "f4", 4).finish();
  EXPECT_EQ(floats.str(), written_header(native + "f4", "0, 4"));
}

}  // namespace
}  // namespace broadside::lab
