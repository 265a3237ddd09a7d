// NumPy arrays as they are written, byte for byte, whether the stream can go back or not.
#include <array>
#include <bit>
#include <cstdint>
#include <sstream>
#include <streambuf>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "lab/formats/npy/array.hpp"

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

TEST(NpyArrayWriter, CountsItsRowsAndSaysThemInTheHeader) {
  std::ostringstream stream;
  stream << "before";
  NpyArrayWriter<std::uint32_t> array(stream, 2);
  array.write(std::array<std::uint32_t, 2>{1, 2});
  array.write(std::array<std::uint32_t, 4>{3, 4, 5, 4000000000});
  array.finish();
  stream << "after";
  EXPECT_EQ(stream.str(), "before" + written_header(native + "u4", "3, 2") +
                              bytes_of({1, 2, 3, 4, 5, 4000000000}) + "after");
}

TEST(NpyArrayWriter, WritesTheSameIntoAPipe) {
  PipeBuffer pipe;
  std::ostream stream(&pipe);
  NpyArrayWriter<std::uint32_t> array(stream, 2);
  array.write(std::array<std::uint32_t, 2>{1, 2});
  array.finish();
  EXPECT_TRUE(stream);
  EXPECT_EQ(pipe.bytes, written_header(native + "u4", "1, 2") + bytes_of({1, 2}));
}

TEST(NpyArrayWriter, WritesMoreThanItsBufferHoldsInOrder) {
  std::ostringstream stream;
  NpyArrayWriter<std::uint32_t> array(stream, 2);
  std::vector<std::uint32_t> all;
  for (std::uint32_t size = 2; size < 60'000; size *= 3) {
    std::vector<std::uint32_t> values;
    for (std::uint32_t i = 0; i < size; ++i) values.push_back(static_cast<std::uint32_t>(all.size()) + i);
    array.write(values);
    all.insert(all.end(), values.begin(), values.end());
  }
  array.finish();
  EXPECT_EQ(stream.str(),
            written_header(native + "u4", std::to_string(all.size() / 2) + ", 2") + bytes_of(all));
}

TEST(NpyArrayWriter, WritesAnArrayWithoutRowsAndOthersOfFloatsAndDoubles) {
  std::ostringstream floats;
  NpyArrayWriter<float>(floats, 4).finish();
  EXPECT_EQ(floats.str(), written_header(native + "f4", "0, 4"));
  std::ostringstream doubles;
  NpyArrayWriter<double> array(doubles, 6);
  array.write(std::array<double, 6>{1, 2, 3, 4, 5, 6});
  array.finish();
  EXPECT_EQ(doubles.str().substr(0, 128), written_header(native + "f8", "1, 6"));
  EXPECT_EQ(doubles.str().size(), 128u + 48);
}

}  // namespace
}  // namespace broadside::lab
