// NumPy arrays of boxes: every kind that is read, and what is refused.
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files.hpp"
#include "lab/readers/format.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr bool is_little = std::endian::native == std::endian::little;

/// A header of a version whose first number is `version`.
std::string header(const std::string& dictionary, char version = 1) {
  std::string bytes = "\x93NUMPY";
  bytes += version;
  bytes += '\0';
  std::string text = dictionary + ' ';
  text += '\n';
  for (int i = 0; i < (version == 1 ? 2 : 4); ++i) bytes += static_cast<char>(text.size() >> 8 * i & 0xff);
  return bytes + text;
}

std::string header_of(const std::string& type, const std::string& shape, bool is_column_major = false) {
  return header("{'descr': '" + type + "', 'fortran_order': " + (is_column_major ? "True" : "False") +
                ", 'shape': (" + shape + "), }");
}

template <typename Number>
std::string numbers(const std::vector<Number>& list, bool is_little_endian = true) {
  std::string bytes;
  for (const Number number : list) {
    std::string more(sizeof(Number), '\0');
    std::memcpy(more.data(), &number, sizeof(Number));
    if (is_little != is_little_endian) more = {more.rbegin(), more.rend()};
    bytes += more;
  }
  return bytes;
}

class Npy : public Files {
 protected:
  template <int D, typename Real>
  std::vector<Box<D, Real>> boxes_of(const std::string& bytes) const {
    const BoxFile file = open_file(put("boxes.npy", bytes));
    return std::get<std::unique_ptr<FrameReader<D, Real>>>(file.frames)->first();
  }

  std::string refusal_of(const std::string& bytes) const { return refusal(put("bad.npy", bytes)); }
};

const std::vector<DoubleBox2> expected = {{{1, 2}, {5, 8}}, {{3, 4}, {7, 9}}};

TEST_F(Npy, IsReadInTheTypeItHas) {
  const std::vector<Box2> floats = {{{0.1F, 2}, {5, 8}}};
  EXPECT_EQ((boxes_of<2, float>(header_of("<f4", "1, 4") + numbers<float>({0.1F, 2, 5, 8}))), floats);
  EXPECT_EQ((boxes_of<2, float>(header_of(">f4", "1, 4") + numbers<float>({0.1F, 2, 5, 8}, false))), floats);
  EXPECT_EQ((boxes_of<2, float>(header_of("=f4", "1, 4") + numbers<float>({0.1F, 2, 5, 8}, is_little))),
            floats);
  const std::vector<DoubleBox3> solid = {{{0.1, 2, 3}, {4, 5, 6}}};
  EXPECT_EQ((boxes_of<3, double>(header_of("<f8", "1, 6") + numbers<double>({0.1, 2, 3, 4, 5, 6}))), solid);
  EXPECT_EQ((boxes_of<3, double>(header_of(">f8", "1,6") + numbers<double>({0.1, 2, 3, 4, 5, 6}, false))),
            solid);
  EXPECT_TRUE((boxes_of<2, float>(header_of("<f4", "0, 4")).empty()));
}

template <typename Number>
std::string type_name() {
  return (std::is_signed_v<Number> ? "i" : "u") + std::to_string(sizeof(Number));
}

TEST_F(Npy, OfIntegersIsReadAsDoubles) {
  const auto check = [&](auto number) {
    using Number = decltype(number);
    const std::vector<Number> values = {1, 2, 5, 8, 3, 4, 7, 9};
    const std::string order = sizeof(Number) == 1 ? "|" : "<";
    EXPECT_EQ((boxes_of<2, double>(header_of(order + type_name<Number>(), "2, 4") + numbers(values))),
              expected);
    EXPECT_EQ((boxes_of<2, double>(header_of(">" + type_name<Number>(), "2, 4") + numbers(values, false))),
              expected);
  };
  check(std::int8_t{});
  check(std::int16_t{});
  check(std::int32_t{});
  check(std::int64_t{});
  check(std::uint8_t{});
  check(std::uint16_t{});
  check(std::uint32_t{});
  check(std::uint64_t{});

  constexpr std::int64_t most = std::int64_t{1} << 53;
  EXPECT_EQ((boxes_of<2, double>(header_of("<i8", "1, 4") + numbers<std::int64_t>({-most, 0, most, 1}))),
            (std::vector<DoubleBox2>{{{-9007199254740992, 0}, {9007199254740992, 1}}}));
  EXPECT_THAT(refusal_of(header_of("<i8", "2, 4") + numbers<std::int64_t>({0, 0, 1, 1, 0, 0, 1, most + 1})),
              AllOf(HasSubstr("bad.npy: row 1 holds 9007199254740993"), HasSubstr("2^53")));
  EXPECT_THAT(refusal_of(header_of("<i8", "1, 4") + numbers<std::int64_t>({-most - 1, 0, 1, 1})),
              HasSubstr("row 0 holds -9007199254740993"));
  EXPECT_THAT(refusal_of(header_of("<u8", "1, 4") + numbers<std::uint64_t>({0, 0, 1, UINT64_MAX})),
              HasSubstr("row 0 holds 18446744073709551615"));
}

TEST_F(Npy, IsReadByRowsOrByColumns) {
  EXPECT_EQ((boxes_of<2, double>(header_of("<f8", "2, 4") + numbers<double>({1, 2, 5, 8, 3, 4, 7, 9}))),
            expected);
  EXPECT_EQ((boxes_of<2, double>(header_of("<f8", "2, 4", true) + numbers<double>({1, 3, 2, 4, 5, 7, 8, 9}))),
            expected);
}

TEST_F(Npy, IsReadInEveryVersionAndWithItsKeysInAnyOrder) {
  const std::string rest = numbers<double>({1, 2, 5, 8, 3, 4, 7, 9});
  const std::string dictionary = "{\"shape\":(2,4),\"fortran_order\":False,\"descr\":\"<f8\"}";
  for (const char version : {1, 2, 3})
    EXPECT_EQ((boxes_of<2, double>(header(dictionary, version) + rest)), expected);
}

TEST_F(Npy, GivesBackWhatWasWritten) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const History<3> floats{{{{-infinity, 0.1F, 3}, {4, 5, infinity}}, absent_box<3>()}, {}};
  write_scene(floats, path("a.npy"));
  EXPECT_EQ((boxes_of<3, float>(text_of("a.npy"))), floats.boxes);
  const History<2, double> doubles{{{{0.1, -1e300}, {4, 5e-324}}}, {}};
  write_scene(doubles, path("b.npy"));
  EXPECT_EQ((boxes_of<2, double>(text_of("b.npy"))), doubles.boxes);
}

TEST_F(Npy, HoldsOneFrame) {
  const History<2> history{{{{0, 0}, {1, 1}}}, {{1, {}, {}}}};
  try {
    write_scene(history, path("a.npy"));
    FAIL() << "wrote two frames";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("a.npy: more than one frame"), HasSubstr("expected one")));
  }
  EXPECT_EQ(count_files(), 0u);
}

TEST_F(Npy, IsRecognisedByItsMagic) {
  EXPECT_EQ(open_file(put("boxes.dat", header_of("<f4", "0, 4"))).format->name, "npy");
}

TEST_F(Npy, RefusesAHeaderThatIsNotRight) {
  const std::string good = header_of("<f8", "0, 4");
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_THAT(refusal_of(good.substr(0, size)), HasSubstr("expected")) << size << " bytes";
  EXPECT_THAT(refusal_of("\x93NUMPX" + good.substr(6)),
              HasSubstr("bad.npy: byte 0: 93 4e 55 4d 50 58; expected 93"));
  EXPECT_THAT(refusal_of(good.substr(0, 6) + "\x04" + good.substr(7)),
              HasSubstr("byte 6: version 4.0; expected 1.0"));
  EXPECT_THAT(refusal_of(good.substr(0, 9) + "\xff" + good.substr(10)),
              HasSubstr("expected a NumPy header of 65"));

  const auto refusal_of_dictionary = [&](const std::string& text) { return refusal_of(header(text)); };
  EXPECT_THAT(refusal_of_dictionary("{'descr': '<f8', 'fortran_order': False}"), HasSubstr("'shape'"));
  EXPECT_THAT(refusal_of_dictionary("{'descr': '<f8', 'descr': '<f8'}"), HasSubstr("each once"));
  EXPECT_THAT(refusal_of_dictionary("{'colour': 'red'}"), HasSubstr("key 'colour'"));
  EXPECT_THAT(refusal_of_dictionary("{'descr': [('x', '<f8')], 'fortran_order': False, 'shape': (0, 4)}"),
              AllOf(HasSubstr("byte 20: '[("), HasSubstr("expected a type of numbers")));
  EXPECT_THAT(refusal_of_dictionary("{'descr': '<f8', 'fortran_order': 0, 'shape': (0, 4)}"),
              HasSubstr("True or False"));
  EXPECT_THAT(refusal_of_dictionary("{'descr': '<f8', 'fortran_order': False, 'shape': (-1, 4)}"),
              HasSubstr("a whole number"));
  EXPECT_THAT(refusal_of_dictionary("{'descr': '<f8', 'fortran_order': False, 'shape': (0, 4)} x"),
              HasSubstr("expected the end of the header"));
  for (const std::string type : {"<f2", "<c8", "|b1", "f8", "|f8", "<f9", "", "<U4", "|O"})
    EXPECT_THAT(refusal_of(header_of(type, "0, 4")), HasSubstr("numbers of type '" + type + "'"));
  for (const std::string shape : {"", "4,", "0, 5", "0, 4, 1"})
    EXPECT_THAT(refusal_of(header_of("<f8", shape)), HasSubstr("expected (n, 4)")) << shape;
}

TEST_F(Npy, RefusesNumbersThatAreMissingTooManyOrNoBox) {
  const std::string rows = numbers<double>({1, 2, 5, 8, 3, 4, 7, 9});
  EXPECT_THAT(refusal_of(header_of("<f8", "2, 4") + rows.substr(1)),
              AllOf(HasSubstr("bad.npy: has 63 bytes behind its header and claims 2 rows of 4"),
                    HasSubstr("32 bytes a row")));
  EXPECT_THAT(refusal_of(header_of("<f8", "2, 4") + rows + "x"), HasSubstr("has 65 bytes"));
  for (const std::string count : {"2147483648", "576460752303423489", "18446744073709551615"})
    EXPECT_THAT(refusal_of(header_of("<f8", count + ", 4") + rows), HasSubstr("claims " + count + " rows"));
  EXPECT_THAT(refusal_of(header_of("<f8", "18446744073709551616, 4") + rows), HasSubstr("a whole number"));

  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal_of(header_of("<f8", "2, 4") + numbers<double>({1, 2, 5, 8, 3, 4, nan, 9})),
              AllOf(HasSubstr("bad.npy: row 1 has min (3, 4) and max (nan, 9)"), HasSubstr("min <= max")));
  EXPECT_THAT(refusal_of(header_of("<f8", "1, 4") + numbers<double>({1, 2, 0, 8})),
              HasSubstr("row 0 has min (1, 2) and max (0, 8)"));
}

}  // namespace
}  // namespace broadside::lab
